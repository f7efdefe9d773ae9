// SPDX-License-Identifier: Apache-2.0
// A data-set folder played as a camera, an IMU and a gait link. The clock decides the pace: with ManualClock frames
// come as fast as they are used, with MonotonicClock as they were recorded. All images are in memory before the first
// frame, so that playing allocates nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/gait_link.h"
#include "hal/imu.h"
#include "platform/host/dataset.h"
#include "platform/host/image_file.h"

namespace touchline {

struct ReplayOptions {
  int loops = 1;  // how often the frames are played; from the end to the start is a kidnap
  std::size_t max_bytes = std::size_t{1} << 30U;  // of decoded images; a larger set is refused by name
};

class Replay {
 public:
  /// Reads the folder. Throws host::HostError: the set is broken, its images differ in size, have no times, or are too
  /// many.
  Replay(const std::filesystem::path& folder, Clock& clock, const ReplayOptions& options = {});

  [[nodiscard]] Camera& camera() { return camera_; }
  [[nodiscard]] Imu& imu() { return imu_; }
  [[nodiscard]] GaitLink& gait() { return gait_; }
  [[nodiscard]] const host::DataSet& dataset() const { return set_; }
  /// The frame last lent, with its truth if the set has one; the first before any.
  [[nodiscard]] const host::DataFrame& current() const { return frame(current_); }

 private:
  class ReplayCamera final : public Camera {
   public:
    explicit ReplayCamera(Replay& owner) : owner_(owner) {}

   private:
    Status do_open() override;
    void do_close() override { health_.open = false; }
    Result<CameraFrame> do_acquire(MonotonicNs deadline) override;
    Status do_release(const CameraFrame& frame) override;
    DeviceHealth do_health() const override { return health_; }

    Replay& owner_;
    DeviceHealth health_;
    std::uint64_t next_ = 0;
    int lent_ = 0;
  };
  class ReplayImu final : public Imu {
   public:
    explicit ReplayImu(Replay& owner) : owner_(owner) {}

   private:
    Status do_open() override;
    void do_close() override { health_.open = false; }
    Result<ImuSample> do_read() override;
    DeviceHealth do_health() const override { return health_; }

    Replay& owner_;
    DeviceHealth health_;
    std::uint64_t next_ = 0;
    bool has_yaw_ = false;
    float yaw_ = 0.0F;  // unwrapped
  };
  class ReplayGait final : public GaitLink {
   public:
    explicit ReplayGait(Replay& owner) : owner_(owner) {}

   private:
    Status do_open() override;
    void do_close() override { health_.open = false; }
    Result<GaitSample> do_read() override;
    DeviceHealth do_health() const override { return health_; }

    Replay& owner_;
    DeviceHealth health_;
    std::uint64_t next_ = 0;
    Pose2 odometry_;  // summed since the start
  };

  [[nodiscard]] std::uint64_t total() const { return static_cast<std::uint64_t>(options_.loops) * set_.frames.size(); }
  [[nodiscard]] const host::DataFrame& frame(std::uint64_t number) const {
    return set_.frames[static_cast<std::size_t>(number % set_.frames.size())];
  }
  [[nodiscard]] MonotonicNs time_of(std::uint64_t number) const;

  host::DataSet set_;
  std::vector<host::RgbImage> images_;
  Clock& clock_;
  ReplayOptions options_;
  MonotonicNs start_;
  MonotonicNs round_ = 0;  // from the first frame of a loop to that of the next
  std::uint64_t current_ = 0;
  ReplayCamera camera_{*this};
  ReplayImu imu_{*this};
  ReplayGait gait_{*this};
};

}  // namespace touchline
