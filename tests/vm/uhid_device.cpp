// SPDX-License-Identifier: Apache-2.0
#include "tests/vm/uhid_device.h"

#include <fcntl.h>
#include <linux/uhid.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <span>

#include "hal/crc32.h"
#include "platform/core/angle.h"

namespace touchline::vm {
namespace {

constexpr std::uint16_t bus_usb = 3;

void put(int file, const uhid_event& event) { (void)!::write(file, &event, sizeof event); }

}  // namespace

UhidDevice::UhidDevice(std::string name, std::uint16_t vendor, std::uint16_t product, Bytes descriptor)
    : name_(std::move(name)), vendor_(vendor), product_(product), descriptor_(std::move(descriptor)) {}

bool UhidDevice::plug_in() {
  file_ = ::open("/dev/uhid", O_RDWR | O_CLOEXEC);
  if (file_ < 0) return false;
  uhid_event event{};
  event.type = UHID_CREATE2;
  uhid_create2_req& request = event.u.create2;
  name_.copy(reinterpret_cast<char*>(request.name), sizeof request.name - 1);
  request.bus = bus_usb;
  request.vendor = vendor_;
  request.product = product_;
  request.rd_size = static_cast<std::uint16_t>(descriptor_.size());
  std::copy(descriptor_.begin(), descriptor_.end(), request.rd_data);
  stop_ = false;
  open_ = false;
  thread_ = std::thread([this] { serve(); });
  return ::write(file_, &event, sizeof event) > 0;
}

void UhidDevice::unplug() {
  if (file_ < 0) return;
  uhid_event event{};
  event.type = UHID_DESTROY;
  put(file_, event);
  stop_ = true;
  thread_.join();
  ::close(file_);
  file_ = -1;
}

void UhidDevice::send(const Bytes& report) {
  if (file_ < 0 || !open_) return;
  uhid_event event{};
  event.type = UHID_INPUT2;
  event.u.input2.size = static_cast<std::uint16_t>(report.size());
  std::copy(report.begin(), report.end(), event.u.input2.data);
  put(file_, event);
}

void UhidDevice::serve() {
  while (!stop_) {
    pollfd ready{file_, POLLIN, 0};
    if (::poll(&ready, 1, 50) <= 0) continue;
    uhid_event event{};
    if (::read(file_, &event, sizeof event) <= 0) continue;
    uhid_event answer{};
    switch (event.type) {
      case UHID_OPEN: open_ = true; break;
      case UHID_CLOSE: open_ = false; break;
      case UHID_GET_REPORT: {
        const Bytes bytes = on_get(event.u.get_report.rnum);
        answer.type = UHID_GET_REPORT_REPLY;
        answer.u.get_report_reply.id = event.u.get_report.id;
        answer.u.get_report_reply.err = bytes.empty() ? EIO : 0;
        answer.u.get_report_reply.size = static_cast<std::uint16_t>(bytes.size());
        std::copy(bytes.begin(), bytes.end(), answer.u.get_report_reply.data);
        put(file_, answer);
        break;
      }
      case UHID_SET_REPORT: {
        const auto& set = event.u.set_report;
        on_set(Bytes(set.data, set.data + set.size));
        answer.type = UHID_SET_REPORT_REPLY;
        answer.u.set_report_reply.id = set.id;
        put(file_, answer);
        break;
      }
      default: break;
    }
  }
}

UhidImu::UhidImu()
    : device_("touchline test IMU", 0x1209, 0x0001,
              {0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x85, 0x01, 0x15, 0x00, 0x26,
               0xFF, 0x00, 0x75, 0x08, 0x95, 0x0F, 0x09, 0x01, 0x81, 0x02, 0xC0}) {}

void UhidImu::send(float yaw, bool garbled) {
  UhidDevice::Bytes report(16, 0);
  const auto raw = static_cast<std::uint16_t>(static_cast<int>(wrap_angle(yaw) * 1e4F));
  report[0] = 1;
  report[1] = sequence_++;
  report[2] = static_cast<std::uint8_t>(raw & 0xFFU);
  report[3] = static_cast<std::uint8_t>(raw >> 8);
  report[10] = 1;
  const std::uint32_t crc = crc32(std::span(report).first(12));
  for (std::size_t i = 0; i < 4; ++i) report[12 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  if (garbled) report[12] ^= 0xFF;
  device_.send(report);
}

// Reports as the kernel's driver asks for them: 02 direction and kind of the lines, 03 levels, 04 levels to set with
// mask, 05 version, 06 SMBus settings, 20 lock byte; one input report for transfers, which are not played.
UhidGpio::UhidGpio()
    : device_(
          "touchline test CP2112", 0x10C4, 0xEA90,
          {0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08, 0x85, 0x02, 0x95, 0x04,
           0x09, 0x01, 0xB1, 0x02, 0x85, 0x03, 0x95, 0x01, 0x09, 0x01, 0xB1, 0x02, 0x85, 0x04, 0x95, 0x02, 0x09, 0x01,
           0xB1, 0x02, 0x85, 0x05, 0x95, 0x02, 0x09, 0x01, 0xB1, 0x02, 0x85, 0x06, 0x95, 0x0D, 0x09, 0x01, 0xB1, 0x02,
           0x85, 0x20, 0x95, 0x01, 0x09, 0x01, 0xB1, 0x02, 0x85, 0x10, 0x95, 0x3F, 0x09, 0x01, 0x81, 0x02, 0xC0}) {
  device_.on_get = [this](std::uint8_t report) -> UhidDevice::Bytes {
    switch (report) {
      case 0x02: return {0x02, static_cast<std::uint8_t>(outputs_.load()), 0, 0, 0};
      case 0x03: return {0x03, static_cast<std::uint8_t>(levels_.load())};
      case 0x05: return {0x05, 0x0C, 0x02};
      case 0x06: return {0x06, 0, 1, 0x86, 0xA0, 2, 0, 0, 0, 0, 0, 0, 0, 0};
      case 0x20: return {0x20, 0};
      default: return {};
    }
  };
  device_.on_set = [this](const UhidDevice::Bytes& bytes) {
    if (bytes.size() >= 2 && bytes[0] == 0x02) outputs_ = bytes[1];
    if (bytes.size() < 3 || bytes[0] != 0x04) return;
    const unsigned mask = bytes[2];
    levels_ = (levels_ & ~mask) | (bytes[1] & mask);
  };
}

void UhidGpio::set_line(unsigned number, bool high) {
  if (high) {
    levels_ |= 1U << number;
  } else {
    levels_ &= ~(1U << number);
  }
}

}  // namespace touchline::vm
