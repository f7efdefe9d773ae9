// SPDX-License-Identifier: Apache-2.0
// A gait link on which one byte in 50 is wrong, for a minute of a simulated walk: not one false frame is used, and the
// pose stays within 0.3 m of the truth.
#include <doctest/doctest.h>

#include <map>
#include <memory>

#include "hal/gait_stream.h"
#include "platform/core/rng.h"
#include "platform/host/sim/sim_devices.h"
#include "platform/robot/robot_loop.h"
#include "tests/hal/gait_header.h"
#include "vision/pipeline_storage.h"

namespace touchline::test {
namespace {

/// Sends what an inner link says through the firmware's encoder, a bad line, and our decoder.
class BadLine final : public GaitLink {
 public:
  BadLine(GaitLink& inner, Clock& clock) : inner_(inner), clock_(clock) {}
  int false_samples = 0;
  int used = 0;

 private:
  Status do_open() override { return inner_.open(); }
  void do_close() override { inner_.close(); }
  Result<GaitSample> do_read() override {
    for (auto sent = inner_.read(); sent.ok(); sent = inner_.read()) {
      const Result<GaitSample> got = transmit(sent.value());
      if (got.ok()) return got;
    }
    return Status::not_ready;
  }
  DeviceHealth do_health() const override {
    DeviceHealth health = stream_.counts();
    health.open = inner_.health().open;
    return health;
  }

  Result<GaitSample> transmit(const GaitSample& sample) {
    truth_[sample.sequence] = sample.odometry;
    touchline_gait gait{};
    gait.flags = TOUCHLINE_GAIT_WALKING | TOUCHLINE_GAIT_HAS_CAMERA;
    gait.boot_id = sample.boot_id;
    gait.sequence = sample.sequence;
    gait.time_us = static_cast<std::uint32_t>(sample.time / 1000);
    gait.x_m = sample.odometry.x;
    gait.y_m = sample.odometry.y;
    gait.theta_rad = sample.odometry.theta;
    gait.camera_height_m = sample.camera_height;
    gait.camera_pitch_rad = sample.camera_pitch;
    gait.camera_roll_rad = sample.camera_roll;
    std::uint8_t frame[TOUCHLINE_GAIT_FRAME_BYTES];
    encode_gait_in_c(&gait, frame);
    Result<GaitSample> result = Status::not_ready;
    for (std::uint8_t byte : frame) {
      if (rng_.below(50) == 0) byte = static_cast<std::uint8_t>(byte ^ (1 + rng_.below(255)));
      const Result<GaitSample> got = stream_.push(byte, clock_.now());
      if (got.ok()) result = got;
    }
    if (result.ok()) judge(result.value());
    return result;
  }
  void judge(const GaitSample& got) {
    ++used;
    const auto sent = truth_.find(got.sequence);
    const bool right = sent != truth_.end() && math::abs(sent->second.x - got.odometry.x) < 1e-3F &&
                       math::abs(sent->second.y - got.odometry.y) < 1e-3F;
    false_samples += right ? 0 : 1;
  }

  GaitLink& inner_;
  Clock& clock_;
  GaitStream stream_;
  Rng rng_{17};
  std::map<std::uint32_t, Pose2> truth_;
};

TEST_CASE("a corrupt link for a minute: no false frame is used, and the pose stays near") {
  sim::SimCameraModel camera = *sim::camera_model("fisheye-140");
  camera.width /= 2;  // half the picture each way: the walk is long
  camera.height /= 2;
  camera.lens.focal_px *= 0.5F;
  camera.lens.cx *= 0.5F;
  camera.lens.cy *= 0.5F;
  const FieldDimensions field = *field_preset("acyut-5x3");
  sim::WalkScenarioOptions options = sim::acceptance_walk(field, camera, 3);
  options.frames_per_second = 5.0F;
  options.readings_per_frame = 10;
  sim::SimRobot robot(options, 60.0);
  REQUIRE(robot.ready());
  BadLine line(robot.gait(), robot.clock());

  RobotConfig config;
  config.field = field;
  config.lens = camera.lens;
  config.vision.frame_width = camera.width;
  config.vision.frame_height = camera.height;
  config.vision.line_width_m = field.line_width;
  config.vision.circle_radius_m = field.circle_radius;
  config.vision.post_diameter_m = field.post_diameter;
  config.goal_yaw_known = true;
  config.goal_yaw = options.imu.goal_yaw;
  const auto storage = std::make_unique<PipelineStorage<>>();
  const auto localizer = std::make_unique<Localizer>();
  RobotLoop loop({&robot.camera(), &robot.imu(), &line, nullptr, &robot.clock()}, storage->memory(), *localizer);
  REQUIRE(loop.configure(config) == Status::ok);

  RobotReport report;
  int frames = 0;
  int far = 0;
  float worst = 0.0F;
  for (Status status = Status::ok; status != Status::end_of_data;) {
    status = loop.turn(report);
    if (status != Status::ok || !report.from_frame || robot.truth().time_s < 5.0) continue;
    ++frames;
    const Pose2& truth = robot.truth().truth;
    const Pose2& pose = report.estimate.pose;
    const float error = report.estimate.valid ? math::hypot(pose.x - truth.x, pose.y - truth.y) : 99.0F;
    worst = math::max(worst, error);
    far += error > 0.3F ? 1 : 0;
  }
  INFO("worst ", worst, " m, ", far, " of ", frames, " frames beyond 0.3 m, ", line.used, " gait frames used");
  CHECK(line.false_samples == 0);
  CHECK(line.used > 800);  // (49/50)^44 = 41 % of 3,000
  CHECK(line.used < 1700);
  CHECK(frames > 250);
  CHECK(far == 0);
}

}  // namespace
}  // namespace touchline::test
