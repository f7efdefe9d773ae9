// SPDX-License-Identifier: Apache-2.0
#include "tests/robot/test_robot.h"

#include <cstdlib>

#include "platform/host/sim/scenario.h"

namespace touchline::test {
namespace {

constexpr MonotonicNs sample_period = 10 * one_millisecond;

Scene make_scene() {
  sim::PoseScenarioOptions options;
  options.field = *field_preset("acyut-5x3");
  options.camera = *sim::camera_model("fisheye-185");
  options.seed = 6;  // a scene that is told from all others without a yaw
  options.tilt_noise = 0.0F;
  sim::PoseScenario scenario(options);
  if (!scenario.ready()) std::abort();
  const sim::SimFrame& frame = scenario.frame(0);
  Scene scene;
  scene.width = frame.image.width;
  scene.height = frame.image.height;
  scene.rgb.assign(frame.image.data,
                   frame.image.data + static_cast<std::ptrdiff_t>(frame.image.stride_bytes) * scene.height);
  scene.truth = frame.truth;
  RobotConfig& config = scene.config;
  config.field = options.field;
  config.lens = options.camera.lens;
  config.vision.frame_width = scene.width;
  config.vision.frame_height = scene.height;
  tell_vision(options.field, config.vision);
  config.mount.height = frame.mount.height;
  config.mount.pitch = frame.mount.pitch;
  config.mount.roll = frame.mount.roll;
  config.goal_yaw_known = true;
  return scene;
}

Status answer_open(bool missing, DeviceHealth& health) {
  if (missing) return health.last_error = Status::disconnected;
  if (!health.open) ++health.opened;
  health.open = true;
  return Status::ok;
}

}  // namespace

const Scene& scene() {
  static const Scene the_scene = make_scene();
  return the_scene;
}

TestCamera::TestCamera(ManualClock& clock) : clock_(clock), black_(scene().rgb.size(), 3) {}

Status TestCamera::do_open() {
  if (mode == Mode::refused) return health_.last_error = Status::unsupported;
  next_ = clock_.now() + period;
  return answer_open(mode == Mode::missing, health_);
}
void TestCamera::do_close() {
  health_.open = false;
  lent = 0;
}
Result<CameraFrame> TestCamera::do_acquire(MonotonicNs deadline) {
  if (mode == Mode::missing) do_close();
  if (!health_.open) return Status::disconnected;
  if (mode == Mode::stalled || next_ > deadline) {
    clock_.advance_to(deadline);
    return Status::timeout;
  }
  clock_.advance_to(next_);
  while (next_ <= clock_.now()) next_ += period;
  ++lent;
  CameraFrame frame;
  frame.image = {PixelFormat::rgb24, scene().rgb.data(), scene().width, scene().height, scene().width * 3};
  if (mode == Mode::black) frame.image.data = black_.data();
  if (mode == Mode::wrong_size) frame.image.height /= 2;
  frame.error = mode == Mode::damaged;
  frame.time = clock_.now() - back_in_time;
  frame.sequence = sequence_++;
  return frame;
}
Status TestCamera::do_release(const CameraFrame&) {
  if (!health_.open) return Status::disconnected;
  if (lent == 0) return Status::invalid_argument;
  --lent;
  return Status::ok;
}

Status TestImu::do_open() {
  next_ = clock_.now();
  return answer_open(mode == Mode::missing, health_);
}
Result<ImuSample> TestImu::do_read() {
  if (mode == Mode::missing) health_.open = false;
  if (!health_.open) return Status::disconnected;
  if (next_ > clock_.now()) return Status::not_ready;
  ImuSample sample;
  sample.time = next_;
  next_ += sample_period;
  if (mode == Mode::silent) return Status::not_ready;
  if (mode == Mode::garbage) {
    ++health_.corrupt;
    return Status::not_ready;
  }
  sample.yaw = yaw;
  sample.has_tilt = tilt;
  ++health_.received;
  return sample;
}

Status TestGait::do_open() {
  next_ = clock_.now();
  return answer_open(mode == Mode::missing, health_);
}
Result<GaitSample> TestGait::do_read() {
  if (mode == Mode::missing) health_.open = false;
  if (!health_.open) return Status::disconnected;
  if (next_ > clock_.now()) return Status::not_ready;
  state.time = next_;
  state.odometry.x += ahead_speed * static_cast<float>(to_seconds(sample_period));
  ++state.sequence;
  next_ += sample_period;
  if (mode == Mode::corrupt) ++health_.corrupt;
  if (mode != Mode::good) return Status::not_ready;
  ++health_.received;
  return state;
}

TestRobot::TestRobot() : loop({&camera, &imu, &gait, &panel, &clock}, storage->memory(), *localizer) {
  imu.yaw = scene().truth.theta;
  panel.shown.reserve(1000);  // so that the mock does not count as the loop's allocation
  if (loop.configure(scene().config) != Status::ok) std::abort();
}

void TestRobot::run(MonotonicNs duration) {
  for (const MonotonicNs end = clock.now() + duration; clock.now() < end;) {
    reports += loop.turn(report) == Status::ok ? 1 : 0;
  }
}

float TestRobot::error() const {
  if (!report.estimate.valid) return 1e9F;
  const Pose2& pose = report.estimate.pose;
  return math::hypot(pose.x - scene().truth.x, pose.y - scene().truth.y);
}
float TestRobot::sigma() const {
  const PoseCovariance& p = report.estimate.covariance;
  return math::sqrt(p.xx + p.yy);
}

}  // namespace touchline::test
