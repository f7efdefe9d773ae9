// SPDX-License-Identifier: Apache-2.0
// The robot daemon: the devices that the file names, the robot's loop, and where the reports go. The composition root:
// here, and nowhere else, a backend is chosen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "platform/robot/robot_loop.h"
#include "platform/sbc/fault_log.h"
#include "platform/sbc/goal_yaw_file.h"
#include "platform/sbc/publisher.h"
#include "platform/sbc/report_line.h"
#include "platform/sbc/robot_file.h"
#include "vision/pipeline_storage.h"

namespace touchline::sbc {

/// Devices made from the file; those that are null the robot has not.
class DeviceSet {
 public:
  explicit DeviceSet(const RobotFile& file);
  ~DeviceSet();
  DeviceSet(const DeviceSet&) = delete;
  DeviceSet& operator=(const DeviceSet&) = delete;
  [[nodiscard]] RobotDevices devices() const;
  /// What the backend behind a fault said last; empty when it has nothing to say.
  [[nodiscard]] const char* detail(Fault fault) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
  bool use_replay_imu_ = false;
  bool use_replay_gait_ = false;
};

class Daemon {
 public:
  /// Takes all memory that it will ever need. `out` and `log` are file descriptors. Throws host::HostError.
  Daemon(const std::filesystem::path& path, int out, int log);
  ~Daemon();
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  /// One turn of the loop, published. False at the end of a recording.
  bool turn();
  /// Reads the file again and takes over what vision and localization may change while they run; the log says so, and
  /// says why not when the file is wrong.
  void reload();
  [[nodiscard]] const RobotReport& report() const { return report_; }
  [[nodiscard]] std::uint64_t published() const { return published_; }
  [[nodiscard]] const RobotFile& file() const { return file_; }
  [[nodiscard]] const Publisher& publisher() const { return publisher_; }
  [[nodiscard]] MonotonicNs now() const { return devices_.devices().clock->now(); }

 private:
  void load_goal_yaw();
  void keep_goal_yaw();

  std::filesystem::path path_;
  RobotFile file_;
  DeviceSet devices_;
  std::unique_ptr<PipelineStorage<>> storage_;
  std::unique_ptr<Localizer> localizer_;
  std::unique_ptr<RobotLoop> loop_;
  Publisher publisher_;
  ReportLine line_;
  FaultLog log_;
  RobotReport report_;
  std::uint64_t published_ = 0;

  GoalYawFile goal_yaw_file_;
  bool goal_yaw_is_kept_ = false;
  bool goal_yaw_told_ = false;  // that it cannot be kept
  float kept_goal_yaw_ = 0.0F;
  std::uint32_t kept_presses_ = 0;
  MonotonicNs next_save_ = 0;
};

}  // namespace touchline::sbc
