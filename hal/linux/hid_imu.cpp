// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/hid_imu.h"

#include <hidapi/hidapi.h>

#include <charconv>
#include <cwchar>

namespace touchline {
namespace {

struct HidName {
  bool valid = false;
  unsigned short vendor = 0;
  unsigned short product = 0;
  std::string serial;  // empty: any
};

bool parse_hex(const std::string& text, unsigned short& value) {
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value, 16);
  return !text.empty() && result.ec == std::errc{} && result.ptr == end;
}

HidName parse_name(const std::string& device) {
  HidName name;
  const std::size_t first = device.find(':');
  if (first == std::string::npos) return name;
  const std::size_t second = device.find(':', first + 1);
  const std::size_t product_end = second == std::string::npos ? device.size() : second;
  name.valid = parse_hex(device.substr(0, first), name.vendor) &&
               parse_hex(device.substr(first + 1, product_end - first - 1), name.product);
  if (second != std::string::npos) name.serial = device.substr(second + 1);
  return name;
}

hid_device* open_by_name(const HidName& name) {
  if (name.serial.empty()) return hid_open(name.vendor, name.product, nullptr);
  const std::wstring serial(name.serial.begin(), name.serial.end());
  return hid_open(name.vendor, name.product, serial.c_str());
}

}  // namespace

const char* hid_device_error(const std::string& device) {
  if (device.starts_with('/')) return nullptr;
  return parse_name(device).valid ? nullptr
                                  : "write vendor:product[:serial] in hexadecimal, or a path like /dev/hidraw0";
}

Status HidImu::fail(Status status, const char* what) {
  problem_.set("%s %s", what, config_.device.c_str());
  health_.last_error = status;
  do_close();
  return status;
}

Status HidImu::do_open() {
  if (device_ != nullptr) return Status::ok;
  problem_.clear();
  if (const char* error = layout_error(config_.layout)) return fail(Status::invalid_argument, error);
  if (const char* error = hid_device_error(config_.device)) return fail(Status::invalid_argument, error);
  if (hid_init() != 0) return fail(Status::device_error, "hidapi does not start for");
  const bool by_path = config_.device.starts_with('/');
  device_ = by_path ? hid_open_path(config_.device.c_str()) : open_by_name(parse_name(config_.device));
  if (device_ == nullptr) return fail(Status::disconnected, "no such HID device (or no permission):");
  const HidReportLayout& layout = config_.layout;
  if (layout.start_report_size > 0 &&
      hid_send_feature_report(device_, layout.start_report.data(), layout.start_report_size) < 0) {
    return fail(Status::unsupported, "the start report is refused by");
  }
  if (hid_set_nonblocking(device_, 1) != 0) return fail(Status::device_error, "no reading without waiting on");
  health_.open = true;
  ++health_.opened;
  last_drain_ = clock_.now();
  return Status::ok;
}

void HidImu::do_close() {
  if (device_ != nullptr) hid_close(device_);
  device_ = nullptr;
  health_.open = false;
  has_sequence_ = false;
  waiting_count_ = 0;
  next_waiting_ = 0;
}

Result<ImuSample> HidImu::do_read() {
  if (device_ == nullptr) return Status::disconnected;
  if (next_waiting_ == waiting_count_) {
    const Status status = drain();
    if (status != Status::ok) return status;
  }
  if (next_waiting_ == waiting_count_) return Status::not_ready;
  return waiting_[next_waiting_++];
}

/// Reads all reports that wait in the kernel, then gives them their times.
Status HidImu::drain() {
  waiting_count_ = 0;
  next_waiting_ = 0;
  std::array<std::uint8_t, max_hid_report_bytes> bytes{};
  for (std::size_t i = 0; i < max_waiting; ++i) {
    const int size = hid_read(device_, bytes.data(), bytes.size());
    if (size < 0) return fail(Status::disconnected, "reading failed, it is gone:");
    if (size == 0) break;
    const auto report = decode_hid_report(config_.layout, std::span(bytes).first(static_cast<std::size_t>(size)));
    if (report.ok()) {
      take(report.value());
    } else if (report.status() == Status::corrupt) {
      ++health_.corrupt;
      health_.last_error = Status::corrupt;
    }
  }
  stamp_waiting(clock_.now());
  return Status::ok;
}

void HidImu::take(const HidReport& report) {
  if (config_.layout.has_sequence) {
    const auto ahead = static_cast<std::uint8_t>(report.sequence - last_sequence_);
    if (has_sequence_ && ahead == 0) {
      ++health_.stale;  // the same report once more
      return;
    }
    if (has_sequence_) health_.lost += ahead - 1U;
    has_sequence_ = true;
    last_sequence_ = report.sequence;
  }
  ImuSample& sample = waiting_[waiting_count_++];
  sample = report.sample;
  sample.yaw = unwrapper_.unwrap(sample.yaw);
  ++health_.received;
}

/// Reports carry no time. The newest has just come; those before it came one period apart, which is learned.
void HidImu::stamp_waiting(MonotonicNs now) {
  if (waiting_count_ == 0) return;
  const auto count = static_cast<MonotonicNs>(waiting_count_);
  const MonotonicNs seen = (now - last_drain_) / count;
  if (seen < one_second / 5) period_ = period_ == 0 ? seen : period_ + (seen - period_) / 16;
  last_drain_ = now;
  for (std::size_t i = 0; i < waiting_count_; ++i) {
    const MonotonicNs guess = now - static_cast<MonotonicNs>(waiting_count_ - 1 - i) * period_;
    last_time_ = guess > last_time_ ? guess : last_time_ + 1;
    waiting_[i].time = last_time_;
  }
  health_.last_datum = last_time_;
}

}  // namespace touchline
