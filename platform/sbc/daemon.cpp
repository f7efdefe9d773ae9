// SPDX-License-Identifier: Apache-2.0
#include "platform/sbc/daemon.h"

#include <cerrno>
#include <cstring>
#include <set>

#include "hal/linux/gpio_panel.h"
#include "hal/linux/hid_imu.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/serial_gait_link.h"
#include "hal/linux/v4l2_camera.h"
#include "hal/mock/manual_clock.h"
#include "hal/replay/replay.h"
#include "platform/host/host_error.h"
#include "vision/pipeline_storage.h"

namespace touchline::sbc {

struct DeviceSet::Parts {
  MonotonicClock clock;
  ManualClock replay_clock;  // a recording is played as fast as it is used
  std::unique_ptr<Replay> replay;
  std::unique_ptr<V4l2Camera> camera;
  std::unique_ptr<HidImu> imu;
  std::unique_ptr<SerialGaitLink> gait;
  std::unique_ptr<GpioPanel> panel;
};

DeviceSet::DeviceSet(const RobotFile& file) : parts_(std::make_unique<Parts>()) {
  Parts& parts = *parts_;
  if (file.camera_backend == CameraBackend::replay) {
    ReplayOptions options;
    options.loops = file.replay_loops;
    parts.replay = std::make_unique<Replay>(file.replay_folder, parts.replay_clock, options);
  } else {
    parts.camera = std::make_unique<V4l2Camera>(file.camera, parts.clock);
  }
  Clock& clock = *devices().clock;
  if (file.imu_backend == ImuBackend::hidapi) parts.imu = std::make_unique<HidImu>(file.imu, clock);
  if (file.gait_backend == GaitBackend::serial) parts.gait = std::make_unique<SerialGaitLink>(file.gait, clock);
  if (file.panel_backend == PanelBackend::gpiod) parts.panel = std::make_unique<GpioPanel>(file.panel, file.button);
  use_replay_imu_ = file.imu_backend == ImuBackend::replay;
  use_replay_gait_ = file.gait_backend == GaitBackend::replay;
}
DeviceSet::~DeviceSet() = default;

RobotDevices DeviceSet::devices() const {
  Parts& parts = *parts_;
  RobotDevices devices;
  devices.clock = &parts.clock;
  devices.camera = parts.camera.get();
  devices.imu = parts.imu.get();
  devices.gait = parts.gait.get();
  devices.panel = parts.panel.get();
  if (parts.replay == nullptr) return devices;
  devices.clock = &parts.replay_clock;
  devices.camera = &parts.replay->camera();
  if (use_replay_imu_) devices.imu = &parts.replay->imu();
  if (use_replay_gait_) devices.gait = &parts.replay->gait();
  return devices;
}

const char* DeviceSet::detail(Fault fault) const {
  const Parts& parts = *parts_;
  switch (fault) {
    case Fault::camera_missing:
    case Fault::camera_size:
    case Fault::camera_stalled: return parts.camera != nullptr ? parts.camera->problem() : "";
    case Fault::imu_missing: return parts.imu != nullptr ? parts.imu->problem() : "";
    case Fault::gait_silent: return parts.gait != nullptr ? parts.gait->silence() : "";
    case Fault::gait_missing: return parts.gait != nullptr ? parts.gait->problem() : "";
    case Fault::panel_missing: return parts.panel != nullptr ? parts.panel->problem() : "";
    default: return "";
  }
}

Daemon::Daemon(const std::filesystem::path& path, int out, int log)
    : path_(path),
      file_(read_robot_file(path)),
      devices_(file_),
      storage_(std::make_unique<PipelineStorage<>>()),
      localizer_(std::make_unique<Localizer>()),
      loop_(std::make_unique<RobotLoop>(devices_.devices(), storage_->memory(), *localizer_)),
      publisher_(file_.output.standard_output ? out : -1, file_.output.udp),
      log_(log),
      goal_yaw_file_(file_.panel_backend == PanelBackend::none ? "" : file_.goal_yaw_file, file_.imu_keeps_zero) {
  load_goal_yaw();
  const char* what = nullptr;
  if (loop_->configure(file_.robot, &what) != Status::ok) {
    throw host::HostError(path.string() +
                          ": is refused: " + (what != nullptr ? what : "its values do not fit together"));
  }
}
Daemon::~Daemon() = default;

void Daemon::load_goal_yaw() {
  const std::string unreachable = goal_yaw_file_.folder_problem();
  if (!unreachable.empty()) log_.say("[panel] state_file: ", unreachable, "");
  const GoalYawFile::Loaded loaded = goal_yaw_file_.load();
  if (!loaded.problem.empty()) log_.say("the goal's yaw: ", loaded.problem, "");
  if (!loaded.found) return;
  file_.robot.goal_yaw_known = true;
  file_.robot.goal_yaw = loaded.yaw;
  goal_yaw_is_kept_ = true;
  kept_goal_yaw_ = loaded.yaw;
  log_.say("the goal's yaw is that of ", goal_yaw_file_.path(), "");
}

/// After a press, and when the device has got a new zero.
void Daemon::keep_goal_yaw() {
  if (!goal_yaw_file_.used() || (loop_->goal_yaw_presses() == 0 && !goal_yaw_is_kept_)) return;
  const float yaw = loop_->goal_yaw_reading();
  if (goal_yaw_is_kept_ && math::abs(angle_difference(yaw, kept_goal_yaw_)) < 1e-4F) return;
  // A disk that is full, or an IMU that never finds its zero, is not asked every turn; a press is obeyed at once.
  if (loop_->goal_yaw_presses() == kept_presses_ && now() < next_save_) return;
  kept_presses_ = loop_->goal_yaw_presses();
  next_save_ = now() + 10 * one_second;
  if (goal_yaw_file_.save(yaw)) {
    goal_yaw_is_kept_ = true;
    goal_yaw_told_ = false;
    kept_goal_yaw_ = yaw;
    log_.say("the goal's yaw is kept in ", goal_yaw_file_.path(), "");
  } else if (!goal_yaw_told_) {
    goal_yaw_told_ = true;
    log_.say("the goal's yaw cannot be kept in ", goal_yaw_file_.path(), std::strerror(errno));
  }
}

bool Daemon::turn() {
  const Status status = loop_->turn(report_);
  if (status == Status::end_of_data) return false;
  keep_goal_yaw();
  if (status != Status::ok) return true;
  ++published_;
  if (!publisher_.publish(line_.format(report_))) loop_->note_output_failure();
  log_.update(report_.faults, now(),
              [this](Fault fault) { return fault == Fault::output ? publisher_.problem() : devices_.detail(fault); });
  return true;
}

namespace {

/// Changed parts of the file that are read at the start alone, in words; empty when there are none.
std::string left_for_restart(const RobotFile& running, const RobotFile& now) {
  std::set<std::string> changed;
  for (const auto* one : {&running, &now}) {
    const auto& other = one == &running ? now.fixed_parts : running.fixed_parts;
    for (const auto& [name, text] : one->fixed_parts) {
      const auto found = other.find(name);
      if (found == other.end() || found->second != text) changed.insert(name);
    }
  }
  std::string words;
  for (const auto& name : changed) words.append(words.empty() ? "" : ", ").append(name);
  return words.empty() ? words : words + " changed too, which takes a restart";
}

}  // namespace

void Daemon::reload() {
  const char* what = nullptr;
  try {
    const RobotFile file = read_robot_file(path_);
    RobotConfig config = file_.robot;  // devices stay as they are
    config.vision = file.robot.vision;
    config.vision.frame_width = file_.robot.vision.frame_width;
    config.vision.frame_height = file_.robot.vision.frame_height;
    config.localizer = file.robot.localizer;
    if (loop_->configure(config, &what) == Status::ok) {
      file_.robot = config;
      log_.say("thresholds read again from ", path_.string(), left_for_restart(file_, file));
    } else {
      log_.say("thresholds stay: ", path_.string(), what != nullptr ? what : "refused");
    }
  } catch (const host::HostError& error) {
    log_.say("thresholds stay: ", error.what(), "");
  }
}

}  // namespace touchline::sbc
