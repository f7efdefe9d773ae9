// SPDX-License-Identifier: Apache-2.0
// A fake of libv4l2, linked in its place: devices with a script of frames, any call made to fail, every handle counted.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

namespace touchline::fake {

struct V4l2Frame {
  std::uint32_t sequence = 0;
  std::int64_t time_ns = 0;
  std::uint32_t flags = 0x2000;  // V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC
  std::uint32_t bytes_used = 0;  // 0: a whole frame
  std::uint8_t fill = 0;
};

class V4l2 {
 public:
  std::map<std::string, std::string> devices{{"/dev/video0", "Fake Camera"}};  // path to card name
  std::uint32_t capabilities = 0x04000001;                                     // streaming, video capture
  std::uint32_t offered_width = 0;                                             // 0: whatever is asked
  std::uint32_t offered_format = 0;                                            // likewise
  bool emulated = false;                                                       // the format is made by the library
  std::uint32_t granted_buffers = 0;                                           // 0: as many as asked
  std::map<unsigned long, int> failing;                                        // request to errno, until erased
  int fail_open = 0;                                                           // errno
  bool fail_mmap = false;
  bool spurious_ready = false;  // poll() says ready and there is no frame

  std::map<std::uint32_t, std::int32_t> controls;  // that were set
  int open_handles = 0;
  int mapped = 0;
  int streams_started = 0;
  int queued = 0;  // buffers in the driver

  void push(const V4l2Frame& frame);
  void unplug();
  void plug_in() { present = true; }

  bool present = true;
  std::deque<V4l2Frame> frames;
  int descriptor = -1;
  int peer = -1;
  std::uint32_t image_bytes = 0;
  std::vector<std::vector<std::uint8_t>> memory;
  std::vector<std::uint32_t> driver_buffers;
};

/// The one fake; reset_v4l2() gives a test a new one.
V4l2& v4l2();
void reset_v4l2();

}  // namespace touchline::fake
