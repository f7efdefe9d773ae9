// SPDX-License-Identifier: Apache-2.0
// Mocks of the devices that are read sample by sample: the IMU and the gait link. One of each kind for both, since
// their contracts differ in the sample alone.
#pragma once

#include "hal/gait_link.h"
#include "hal/imu.h"
#include "hal/mock/call_log.h"
#include "hal/mock/script.h"

namespace touchline {

/// Plays a script and keeps the contract: one that is not open is disconnected.
template <typename Device, typename Sample>
class ScriptedReader final : public Device {
 public:
  Script<Sample> samples{Status::not_ready};
  OpenScript opens;

 private:
  Status do_open() override {
    if (health_.open) return Status::ok;
    const Status status = opens.next();
    health_.open = status == Status::ok;
    if (health_.open) ++health_.opened;
    return note(status);
  }
  void do_close() override { health_.open = false; }
  Result<Sample> do_read() override {
    if (!health_.open) return note(Status::disconnected);
    const Result<Sample> sample = samples.next();
    if (sample.ok()) {
      ++health_.received;
      health_.last_datum = sample.value().time;
      return sample;
    }
    if (sample.status() == Status::disconnected) do_close();
    return sample.status() == Status::not_ready ? sample : note(sample.status());
  }
  DeviceHealth do_health() const override { return health_; }
  Status note(Status status) {
    if (status != Status::ok) health_.last_error = status;
    return status;
  }

  DeviceHealth health_;
};

/// Passes every call on and writes it down.
template <typename Device, typename Sample>
class RecordingReader final : public Device {
 public:
  explicit RecordingReader(Device& inner) : inner_(inner) {}
  CallLog log;

 private:
  Status do_open() override {
    const Status status = inner_.open();
    log.add("open", status);
    return status;
  }
  void do_close() override {
    inner_.close();
    log.add("close");
  }
  Result<Sample> do_read() override {
    const Result<Sample> sample = inner_.read();
    log.add("read", sample.status());
    return sample;
  }
  DeviceHealth do_health() const override { return inner_.health(); }

  Device& inner_;
};

using ScriptedImu = ScriptedReader<Imu, ImuSample>;
using RecordingImu = RecordingReader<Imu, ImuSample>;
using ScriptedGaitLink = ScriptedReader<GaitLink, GaitSample>;
using RecordingGaitLink = RecordingReader<GaitLink, GaitSample>;

}  // namespace touchline
