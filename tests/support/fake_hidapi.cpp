// SPDX-License-Identifier: Apache-2.0
#include "tests/support/fake_hidapi.h"

#include <hidapi/hidapi.h>

#include <algorithm>
#include <cstring>

struct hid_device_ {
  bool nonblocking = false;
};

namespace touchline::fake {
namespace {

Hidapi the_fake;
hid_device_ the_device;

}  // namespace

Hidapi& hidapi() { return the_fake; }
void reset_hidapi() {
  the_fake = Hidapi();
  the_device = {};
}

}  // namespace touchline::fake

using touchline::fake::hidapi;

namespace {

hid_device* open_if(bool matches) {
  if (!matches || !hidapi().present) return nullptr;
  ++hidapi().open_handles;
  touchline::fake::the_device.nonblocking = false;
  return &touchline::fake::the_device;
}

}  // namespace

extern "C" {

hid_device_info* hid_enumerate(unsigned short, unsigned short) {
  static wchar_t maker[] = L"Maker";
  static wchar_t product[] = L"IMU";
  static hid_device_info info{};
  auto& fake = hidapi();
  if (!fake.present) return nullptr;
  ++fake.open_lists;
  info.vendor_id = fake.vendor;
  info.product_id = fake.product;
  info.path = fake.path.data();
  info.serial_number = fake.serial.data();
  info.manufacturer_string = maker;
  info.product_string = product;
  info.next = nullptr;
  return &info;
}
void hid_free_enumeration(hid_device_info* list) {
  if (list != nullptr) --hidapi().open_lists;
}
int hid_init(void) { return hidapi().fail_init ? -1 : 0; }
hid_device* hid_open(unsigned short vendor, unsigned short product, const wchar_t* serial) {
  const auto& fake = hidapi();
  return open_if(vendor == fake.vendor && product == fake.product && (serial == nullptr || fake.serial == serial));
}
hid_device* hid_open_path(const char* path) { return open_if(hidapi().path == path); }
void hid_close(hid_device*) { --hidapi().open_handles; }
int hid_send_feature_report(hid_device*, const unsigned char* data, size_t length) {
  if (hidapi().fail_feature) return -1;
  hidapi().features.emplace_back(data, data + length);
  return static_cast<int>(length);
}
int hid_set_nonblocking(hid_device* device, int nonblock) {
  device->nonblocking = nonblock != 0;
  return hidapi().fail_nonblocking ? -1 : 0;
}
int hid_read(hid_device* device, unsigned char* data, size_t length) {
  auto& fake = hidapi();
  if (!fake.present || !device->nonblocking) return -1;  // the backend must never wait here
  if (fake.reports.empty()) return 0;
  const auto report = fake.reports.front();
  fake.reports.pop_front();
  const std::size_t size = std::min(length, report.size());
  std::memcpy(data, report.data(), size);
  return static_cast<int>(size);
}
}
