// SPDX-License-Identifier: Apache-2.0
// A fake of hidapi, linked in its place: one device with a queue of reports, any call made to fail, every handle
// counted.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace touchline::fake {

struct Hidapi {
  bool present = true;
  unsigned short vendor = 0x1209;
  unsigned short product = 0x0001;
  std::wstring serial = L"A1";
  std::string path = "/dev/hidraw0";
  bool fail_init = false;
  bool fail_feature = false;
  bool fail_nonblocking = false;

  int open_handles = 0;
  int open_lists = 0;                               // of hid_enumerate
  std::vector<std::vector<std::uint8_t>> features;  // that were sent
  std::deque<std::vector<std::uint8_t>> reports;
};

Hidapi& hidapi();
void reset_hidapi();

}  // namespace touchline::fake
