// SPDX-License-Identifier: Apache-2.0
// One turn of the robot's loop, and the work on a frame. Faults, light and buttons are in robot_health.cpp.
#include "platform/robot/robot_loop.h"

#include "platform/core/elementary.h"
#include "platform/robot/picture_check.h"

namespace touchline {
namespace {

constexpr float max_unknown_xy = 3.0F;  // metres: beyond this it does not matter how far

}  // namespace

Status RobotLoop::configure_parts(const RobotConfig& config, const char** what) {
  Lens lens;
  Status status = Lens::create(config.lens, lens, what);
  if (status != Status::ok) return status;
  Field field;
  status = Field::create(config.field, field, what);
  if (status != Status::ok) return status;
  status = pipeline_.configure(config.vision, lens, what);
  return status == Status::ok ? localizer_.configure(config.localizer, field, what) : status;
}

Status RobotLoop::configure(const RobotConfig& config, const char** what) {
  const Status status = configure_parts(config, what);
  if (status != Status::ok) {
    if (configured_) (void)configure_parts(config_, nullptr);  // the parts that had taken it over
    return status;
  }
  config_ = config;
  events_.set_hold(config.transient);
  if (configured_) return Status::ok;
  configured_ = true;
  sensors_.configure(config);
  goal_yaw_known_ = config.goal_yaw_known;
  goal_yaw_ = config.goal_yaw;
  return localizer_.reset(config.prior, config.seed);
}

Status RobotLoop::turn(RobotReport& report, StageObserver* observer) {
  if (!configured_) return Status::invalid_argument;
  const MonotonicNs now = devices_.clock->now();
  if (!turned_) last_used_ = now;  // a camera that is there gets the time to say so before a report does without
  watch_clock(now);
  sensors_.service(now, events_);
  service_panel(now);
  if (keep_camera_open(now)) {
    const Result<CameraFrame> frame = devices_.camera->acquire(now + config_.slice);
    if (frame.ok()) return work_on(frame.value(), report, observer);
    if (frame.status() == Status::end_of_data) return Status::end_of_data;
    if (frame.status() == Status::wrong_size) wrong_size_ = true;
  } else {
    devices_.clock->wait_until(now + config_.slice);
  }
  return report_idle(devices_.clock->now(), report);
}

Status RobotLoop::work_on(const CameraFrame& frame, RobotReport& report, StageObserver* observer) {
  const MonotonicNs arrival = devices_.clock->now();
  const MonotonicNs time = frame.time - config_.camera_delay;
  last_arrival_ = arrival;
  camera_stalled_ = false;
  sensors_.service(arrival, events_);  // what came while the frame was waited for
  const bool usable = is_usable(frame, time);
  const bool down = sensors_.fallen() || sensors_.lifted();
  if (down) lose_pose();
  Status status = usable && !down ? see(frame, time, observer) : Status::not_ready;
  if (devices_.camera->release(frame) != Status::ok) events_.note(Fault::camera_damaged, arrival);
  if (status == Status::ok) {
    report = {};
    status = localize(time, report, observer);
  }
  const MonotonicNs now = devices_.clock->now();
  if (status != Status::ok) return report_idle(now, report);
  last_used_ = now;
  ++frames_;
  report.frame_to_pose = now - time;
  report.processing = now - arrival;
  finish(report, now);
  return Status::ok;
}

bool RobotLoop::is_usable(const CameraFrame& frame, MonotonicNs time) {
  const MonotonicNs now = devices_.clock->now();
  if (frame.error) {
    events_.note(Fault::camera_damaged, now);
    return false;
  }
  // Time runs backwards when a camera is exchanged or its driver starts anew; a long way back is not believed for long.
  const bool old = has_frame_ && time <= last_frame_ && last_frame_ - time < config_.clock_leap;
  if (old || time > now + one_second) {
    events_.note(Fault::camera_stale, now);
    return false;
  }
  const VisionConfig& vision = pipeline_.config();
  wrong_size_ = frame.image.width != vision.frame_width || frame.image.height != vision.frame_height;
  black_ = !wrong_size_ && brightest_sample(frame.image) < config_.black_below;
  return !wrong_size_ && !black_ && !sensors_.attitude_missed(time);
}

Status RobotLoop::see(const CameraFrame& frame, MonotonicNs time, StageObserver* observer) {
  attitude_ = sensors_.attitude_at(time);
  const PathPoint here = sensors_.path_at(time);
  FrameInput input;
  input.image = frame.image;
  input.time_s = to_seconds(time);
  input.camera = {attitude_.x, attitude_.y, attitude_.height, attitude_.yaw, attitude_.pitch, attitude_.roll};
  if (has_localized_) input.odometry = motion_since(localized_path_, here).step;
  last_frame_ = time;
  has_frame_ = true;
  return pipeline_.process(input, vision_, observer);
}

Status RobotLoop::localize(MonotonicNs time, RobotReport& report, StageObserver* observer) {
  const PathPoint here = sensors_.path_at(time);
  LocalizerInput input;
  input.time_s = to_seconds(time);
  if (has_localized_) {
    const Motion motion = motion_since(localized_path_, here);
    input.odometry = motion.step;
    input.unknown_xy = motion.unknown_xy;
    input.unknown_theta = motion.unknown_theta;
  }
  float yaw = 0.0F;
  input.has_yaw = goal_yaw_known_ && sensors_.yaw_at(time, yaw);
  if (input.has_yaw) input.yaw = wrap_angle(yaw - goal_yaw_);
  input.moved_by_hand = moved_by_hand_;
  if (math::hypot(input.odometry.x, input.odometry.y) > max_step_m) {  // minutes without a frame: the path is void
    input.odometry = {};
    input.moved_by_hand = true;
  }
  const Status status = localizer_.update(input, vision_, estimate_, observer);
  if (status != Status::ok) return status;
  moved_by_hand_ = false;
  has_localized_ = true;
  localized_path_ = here;
  reckoned_path_ = here;
  reckoned_to_ = time;
  report.time = time;
  report.from_frame = true;
  report.yaw_used = input.has_yaw;
  report.odometry_used = here.known;
  report.junctions = static_cast<int>(vision_.features->junctions.size());
  report.posts = static_cast<int>(vision_.features->posts.size());
  report.line_points = static_cast<int>(vision_.features->line_points.size());
  report.dropped = vision_.counts.dropped();
  return Status::ok;
}

/// A path without odometry is a random walk: its error grows with the root of the time, however it is cut into steps.
Motion RobotLoop::motion_since(const PathPoint& anchor, const PathPoint& here) const {
  Motion motion;
  motion.step = compose(inverse(anchor.pose), here.pose);
  const auto seconds = static_cast<float>(here.unknown_s - anchor.unknown_s);
  if (seconds > 0.0F) {
    const float root = math::sqrt(seconds);
    motion.unknown_xy = math::min(config_.unknown_speed * root, max_unknown_xy);
    motion.unknown_theta = math::min(config_.unknown_turn * root, math::pi);
    if (anchor.has_yaw && here.has_yaw) {  // then at least the turn is known
      motion.step.theta = wrap_angle(here.yaw - anchor.yaw);
      motion.unknown_theta = 0.0F;
    }
  }
  return motion;
}

void RobotLoop::reckon_to(MonotonicNs time) {
  const PathPoint here = sensors_.path_at(time);
  const auto seconds = static_cast<float>(to_seconds(time - reckoned_to_));
  if (estimate_.valid && seconds > 0.0F) {
    reckon(estimate_, motion_since(reckoned_path_, here), config_.localizer.motion, seconds);
  }
  reckoned_path_ = here;
  reckoned_to_ = time;
}

/// not_ready: frames come, or the last report is not old enough.
Status RobotLoop::report_idle(MonotonicNs now, RobotReport& report) {
  if (now - last_used_ < config_.idle_after || now - last_report_ < config_.idle_report) return Status::not_ready;
  report = {};
  if (now > reckoned_to_) reckon_to(now);
  attitude_ = sensors_.attitude_at(now);
  report.time = now;
  report.odometry_used = sensors_.path_at(now).known;
  finish(report, now);
  return Status::ok;
}

void RobotLoop::finish(RobotReport& report, MonotonicNs now) {
  report.sequence = reports_++;
  report.estimate = estimate_;
  report.camera = attitude_;
  report.attitude_source = attitude_.source;
  report.frames = frames_;
  report.faults = faults(now);
  report.led = led(report.faults);
  if (devices_.panel != nullptr) devices_.panel->show(report.led);
  report.camera_health = devices_.camera->health();
  report.imu_health = sensors_.imu_health();
  report.gait_health = sensors_.gait_health();
  if (devices_.panel != nullptr) report.panel_health = devices_.panel->health();
  report.yaw_jumps = sensors_.yaw_jumps();
  report.odometry_jumps = sensors_.odometry_jumps();
  last_report_ = now;
}

}  // namespace touchline
