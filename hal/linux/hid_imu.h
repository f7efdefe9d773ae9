// SPDX-License-Identifier: Apache-2.0
// An IMU on hidapi (hidraw): opens by vendor:product[:serial] or by path, reads reports by a layout of the config.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "hal/clock.h"
#include "hal/hid_report_codec.h"
#include "hal/imu.h"
#include "hal/linux/problem.h"

struct hid_device_;  // of <hidapi/hidapi.h>, which stays out of headers

namespace touchline {

struct HidImuConfig {
  std::string device;  // "1209:0001", "1209:0001:SERIAL", or "/dev/hidraw0"
  HidReportLayout layout = vendor_report_layout();
};

/// Null when `device` can be used, else what is wrong with it.
const char* hid_device_error(const std::string& device);

class HidImu final : public Imu {
 public:
  HidImu(const HidImuConfig& config, Clock& clock) : config_(config), clock_(clock) {}
  ~HidImu() override { do_close(); }
  HidImu(const HidImu&) = delete;
  HidImu& operator=(const HidImu&) = delete;

  [[nodiscard]] const char* problem() const { return problem_.text(); }

 private:
  /// The kernel keeps 64 reports for each reader.
  static constexpr std::size_t max_waiting = 64;

  Status do_open() override;
  void do_close() override;
  Result<ImuSample> do_read() override;
  DeviceHealth do_health() const override { return health_; }

  Status fail(Status status, const char* what);
  Status drain();
  void take(const HidReport& report);
  void stamp_waiting(MonotonicNs now);

  HidImuConfig config_;
  Clock& clock_;
  Problem problem_;
  DeviceHealth health_;
  hid_device_* device_ = nullptr;
  YawUnwrapper unwrapper_;
  bool has_sequence_ = false;
  std::uint8_t last_sequence_ = 0;

  std::array<ImuSample, max_waiting> waiting_{};
  std::size_t waiting_count_ = 0;
  std::size_t next_waiting_ = 0;
  MonotonicNs last_drain_ = 0;
  MonotonicNs last_time_ = 0;
  MonotonicNs period_ = 0;  // of the reports, as it looks from here; 0: not known yet
};

}  // namespace touchline
