// SPDX-License-Identifier: Apache-2.0
#include "platform/robot/sensors.h"

namespace touchline {

Sensors::HeadState interpolate(const Sensors::HeadState& from, const Sensors::HeadState& to, float share) {
  const auto angle = [&](float a, float b) { return wrap_angle(a + angle_difference(b, a) * share); };
  Sensors::HeadState state = to;
  if (!from.has_camera || !from.has_head) return state;
  state.height = interpolate(from.height, to.height, share);
  state.pitch = angle(from.pitch, to.pitch);
  state.roll = angle(from.roll, to.roll);
  state.pan = angle(from.pan, to.pan);
  state.tilt = angle(from.tilt, to.tilt);
  return state;
}

void Sensors::configure(const RobotConfig& config) {
  config_ = config;
  odometry_ = OdometryHistory(config.motion_limits);
}

void Sensors::service(MonotonicNs now, EventFaults& events) {
  // The gait first: the turn while the IMU was away comes from its odometry.
  if (gait_ != nullptr) service_gait(now, events);
  if (imu_ != nullptr) service_imu(now, events);
}

void Sensors::service_imu(MonotonicNs now, EventFaults& events) {
  if (!imu_->health().open) {
    imu_fresh_ = false;
    if (!imu_retry_.due(now, config_.reopen) || imu_->open() != Status::ok) return;
    imu_heard_ = now;
    if (!yaw_.empty()) {
      const float theta = odometry_.empty() ? theta_at_yaw_ : odometry_.newest().theta;
      yaw_.reattach(angle_difference(theta, theta_at_yaw_));
    }
  }
  for (int i = 0; i < max_reads; ++i) {
    const Result<ImuSample> sample = imu_->read();
    if (!sample.ok()) break;
    take(sample.value(), now, events);
  }
  const std::uint32_t corrupt = imu_->health().corrupt;
  if (corrupt != imu_corrupt_) events.note(Fault::imu_garbage, now);
  imu_corrupt_ = corrupt;
  imu_silent_ = now - imu_heard_ > config_.imu_stale;
  imu_fresh_ = !yaw_.empty() && !imu_silent_;
}

void Sensors::take(const ImuSample& sample, MonotonicNs now, EventFaults& events) {
  const Status status = yaw_.push(sample);
  if (status == Status::invalid_argument) events.note(Fault::imu_garbage, now);
  if (status == Status::corrupt) events.note(Fault::imu_jump, now);
  if (status != Status::ok) return;
  imu_heard_ = now;
  if (!odometry_.empty()) theta_at_yaw_ = odometry_.newest().theta;
}

void Sensors::service_gait(MonotonicNs now, EventFaults& events) {
  const bool was_open = gait_->health().open;
  if (!was_open && (!gait_retry_.due(now, config_.reopen) || gait_->open() != Status::ok)) {
    gait_fresh_ = false;
    return;
  }
  if (!was_open) gait_heard_ = now;
  for (int i = 0; i < max_reads; ++i) {
    const Result<GaitSample> sample = gait_->read();
    if (!sample.ok()) break;
    take(sample.value(), now, events);
  }
  const DeviceHealth health = gait_->health();
  const std::uint32_t corrupt = health.corrupt + health.stale;
  if (corrupt != gait_corrupt_) events.note(Fault::gait_corrupt, now);
  gait_corrupt_ = corrupt;
  gait_silent_ = now - gait_heard_ > config_.gait_stale;
  gait_fresh_ = has_state_ && now - gait_used_ <= config_.gait_stale;
}

void Sensors::take(const GaitSample& sample, MonotonicNs now, EventFaults& events) {
  const bool first = odometry_.empty();
  const MonotonicNs before = first ? sample.time : odometry_.newest_time();
  const std::uint32_t jumps = odometry_.jumps();
  const bool restarted = has_state_ && sample.boot_id != state_.boot_id;
  const bool was_odd = path_broken_;
  const Status status = odometry_.push(sample);
  if (restarted) events.note(Fault::gait_restarted, now);
  if (odometry_.jumps() != jumps) events.note(Fault::gait_jump, now);
  path_broken_ = status == Status::corrupt;
  gait_heard_ = now;
  if (status != Status::ok) return;
  // What was walked before a restart, or hidden by a jump that stays, is in no sum.
  if (restarted || was_odd) unknown_s_ += to_seconds(sample.time - before);
  gait_used_ = now;
  has_state_ = true;
  state_ = sample;
  const HeadState head{sample.has_camera_attitude, sample.has_head, sample.camera_height, sample.camera_pitch,
                       sample.camera_roll,         sample.head_pan, sample.head_tilt};
  if (!head_.empty()) {
    const MonotonicNs interval = sample.time - head_.newest_time();
    head_period_ = head_period_ == 0 ? interval : head_period_ + (interval - head_period_) / 16;
  }
  if (head_.push(sample.time, head) != Status::ok) events.note(Fault::gait_corrupt, now);
}

bool Sensors::yaw_at(MonotonicNs time, float& yaw) const {
  const Result<TorsoAttitude> attitude = yaw_.at(time);
  if (!imu_fresh_ || !attitude.ok()) return false;
  yaw = attitude.value().yaw;
  return true;
}

PathPoint Sensors::path_at(MonotonicNs time) const {
  PathPoint point;
  point.has_yaw = yaw_at(time, point.yaw);
  point.unknown_s = unknown_s_;
  const Result<Pose2> pose = odometry_.at(time);
  if (pose.ok()) {
    point.pose = pose.value();
    point.known = true;
  } else if (odometry_.empty()) {
    point.unknown_s = to_seconds(time);
  } else {
    const MonotonicNs silent = time - odometry_.newest_time();  // < 0: a frame older than the whole history
    point.pose = odometry_.newest();
    if (silent > 0) point.unknown_s += to_seconds(silent);
  }
  return point;
}

bool Sensors::attitude_missed(MonotonicNs time) const {
  if (head_.empty() || !gait_fresh_ || !(head_.newest().has_camera || head_.newest().has_head)) return false;
  const MonotonicNs age = time - head_.newest_time();
  const MonotonicNs allowed = head_period_ * 5 / 2 > min_attitude_age ? head_period_ * 5 / 2 : min_attitude_age;
  return age > allowed && age <= config_.gait_stale;
}

CameraAttitude Sensors::attitude_at(MonotonicNs time) const {
  CameraAttitudeInput input;
  const Result<TorsoAttitude> torso = yaw_.at(time);
  if (imu_fresh_ && torso.ok() && torso.value().has_tilt) {
    input.has_torso_tilt = true;
    input.torso_roll = torso.value().roll;
    input.torso_pitch = torso.value().pitch;
  }
  const Result<HeadState> head = head_.at(time, config_.gait_stale);  // held a while: better than the attitude at rest
  if (head.ok()) {
    const HeadState& state = head.value();
    input.has_camera = state.has_camera;
    input.camera_height = state.height;
    input.camera_pitch = state.pitch;
    input.camera_roll = state.roll;
    input.has_head = state.has_head;
    input.head_pan = state.pan;
    input.head_tilt = state.tilt;
  }
  if (config_.fixed_head) {
    input.has_head = true;
    input.head_pan = 0.0F;
    input.head_tilt = 0.0F;
  }
  return camera_attitude(config_.mount, input);
}

void Sensors::add_faults(FaultSet& faults) const {
  if (imu_ != nullptr) {
    const bool open = imu_->health().open;
    faults.set(Fault::imu_missing, !open);
    faults.set(Fault::imu_stale, open && imu_silent_);
  }
  if (gait_ != nullptr) {
    const bool open = gait_->health().open;
    faults.set(Fault::gait_missing, !open);
    faults.set(Fault::gait_silent, open && gait_silent_);
  }
  faults.set(Fault::fallen, fallen());
  faults.set(Fault::lifted, lifted());
}

}  // namespace touchline
