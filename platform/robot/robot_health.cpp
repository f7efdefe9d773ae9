// SPDX-License-Identifier: Apache-2.0
// The robot's loop when things go wrong, and when somebody presses the button.
#include "platform/robot/robot_loop.h"

namespace touchline {

void RobotLoop::watch_clock(MonotonicNs now) {
  const MonotonicNs leap = now - last_turn_;
  if (turned_ && leap > config_.clock_leap) {
    events_.note(Fault::clock_jump, now);
    last_arrival_ += leap;  // the camera did not stall: nobody asked it
  }
  turned_ = true;
  last_turn_ = now;
}

void RobotLoop::service_panel(MonotonicNs now) {
  Panel* panel = devices_.panel;
  if (panel == nullptr) return;
  if (!panel->health().open && (!panel_retry_.due(now, config_.reopen) || panel->open() != Status::ok)) return;
  const Result<ButtonEvent> event = panel->poll(now);
  if (event.ok()) on_button(event.value().press, now);
}

void RobotLoop::on_button(ButtonPress press, MonotonicNs now) {
  if (press == ButtonPress::long_press) {
    lose_pose();
    moved_by_hand_ = false;  // the reset below says it all
    (void)localizer_.reset(Prior{}, config_.seed + ++resets_);
    return;
  }
  float yaw = 0.0F;
  if (!sensors_.yaw_at(now, yaw)) return;  // no yaw to store; the light shows the fault
  goal_yaw_known_ = true;
  goal_yaw_ = yaw;
  ++goal_yaw_presses_;
}

/// Opens a camera that is missing, and anew one that has stalled. True when it is open.
bool RobotLoop::keep_camera_open(MonotonicNs now) {
  Camera& camera = *devices_.camera;
  if (camera.health().open && now - last_arrival_ > config_.camera_stall) {
    camera_stalled_ = true;
    camera.close();
  }
  if (camera.health().open) return true;
  if (!camera_retry_.due(now, config_.reopen)) return false;
  camera_status_ = camera.open();
  last_arrival_ = devices_.clock->now();
  return camera_status_ == Status::ok;
}

/// The robot was carried, or is to start from nothing: old pictures and old poses say nothing.
void RobotLoop::lose_pose() {
  if (!moved_by_hand_) pipeline_.reset();
  moved_by_hand_ = true;
  estimate_ = {};
}

FaultSet RobotLoop::faults(MonotonicNs now) const {
  FaultSet set;
  const bool open = devices_.camera->health().open;
  const bool refused = camera_status_ == Status::unsupported || camera_status_ == Status::wrong_size;
  set.set(Fault::camera_missing, !open && !refused);
  set.set(Fault::camera_size, wrong_size_ || (!open && refused));
  set.set(Fault::camera_stalled, camera_stalled_);
  set.set(Fault::camera_black, open && black_);
  if (devices_.panel != nullptr) set.set(Fault::panel_missing, !devices_.panel->health().open);
  sensors_.add_faults(set);
  events_.add_to(set, now);
  return set;
}

LedPattern RobotLoop::led(const FaultSet& set) const {
  for (const Fault fault : {Fault::camera_missing, Fault::camera_size, Fault::camera_stalled, Fault::camera_black}) {
    if (set.has(fault)) return LedPattern::no_camera;
  }
  for (const Fault fault :
       {Fault::imu_missing, Fault::imu_stale, Fault::gait_missing, Fault::gait_silent, Fault::output}) {
    if (set.has(fault)) return LedPattern::fault;
  }
  if (sensors_.gait_lost()) return LedPattern::fault;
  const bool sure = estimate_.valid && estimate_.confidence > config_.localizer.confident;
  return sure ? LedPattern::sure : LedPattern::searching;
}

}  // namespace touchline
