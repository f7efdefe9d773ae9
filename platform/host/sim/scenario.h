// SPDX-License-Identifier: Apache-2.0
// The simulator's acceptance scenes: single pictures from seeded poses, and seeded walks.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "platform/host/sim/renderer.h"
#include "platform/host/sim/scene.h"
#include "platform/host/sim/sensors.h"
#include "platform/host/sim/world.h"

namespace touchline::sim {

struct SimCameraModel {
  LensParameters lens;
  int width = 0;
  int height = 0;
};
/// "fisheye-185": 752 x 480, equidistant, 232.9 px, seen to 92.5 degrees. "fisheye-140": 640 x 480, equisolid, 70
/// degrees at the left and right edge. "fisheye-140-kb": the same field of view, Kannala-Brandt. "fisheye-185-qvga":
/// 320 x 240, the first lens on a small sensor, as on microcontrollers. Nothing for another name.
std::optional<SimCameraModel> camera_model(std::string_view name);

/// What the sensors say between frames, at their own rate.
struct SimReading {
  double time_s = 0.0;
  Pose2 odometry;    // summed since the start
  float yaw = 0.0F;  // as the IMU reads it: goal yaw included, continuous, radians
  CameraPose mount;  // as measured
  Activity activity = Activity::walking;
};

/// One frame with all a robot would be told, and the truth.
struct SimFrame {
  int index = 0;
  double time_s = 0.0;
  FrameView image;   // RGB24; valid until the next frame is drawn
  CameraPose mount;  // as measured
  Pose2 odometry;    // since the frame before, as the gait believes it
  bool has_yaw = false;
  float yaw = 0.0F;            // IMU yaw minus goal yaw, radians, continuous
  bool moved_by_hand = false;  // fallen or lifted, as the gait reports it
  Pose2 truth;
  CameraPose true_camera;
  bool kidnapped = false;  // truth only; nothing announces it
};

/// Single pictures, each from nothing: poses uniform inside the lines, any heading, pitch uniform between the limits.
struct PoseScenarioOptions {
  FieldDimensions field;
  SimCameraModel camera;
  std::uint64_t seed = 1;
  float min_pitch = radians(20.0F), max_pitch = radians(42.0F);
  float max_roll = radians(3.0F);
  float min_height = 0.55F, max_height = 0.62F;
  float tilt_noise = radians(0.5F);  // 1 sigma, measured pitch and roll
  bool yaw = false;                  // has an IMU; then with 2 degrees of noise
  int frames_per_scene = 8;          // pictures before hall, carpet and light change
};

class PoseScenario {
 public:
  /// The camera's lens must be valid; it is checked by ready().
  explicit PoseScenario(const PoseScenarioOptions& options);
  [[nodiscard]] bool ready() const { return ready_; }
  /// Picture number `index` >= 0; any order gives the same pictures.
  const SimFrame& frame(int index);
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Lens& lens() const { return lens_; }

 private:
  PoseScenarioOptions options_;
  Lens lens_;
  bool ready_ = false;
  Scene scene_;
  int scene_number_ = -1;
  SimRenderer renderer_;
  std::vector<std::uint8_t> pixels_;
  SimFrame frame_;
};

/// One walk through one scene.
struct WalkScenarioOptions {
  SceneOptions scene;
  WalkOptions walk;
  GaitErrors gait;
  ImuErrors imu;
  ImageEffects effects;
  SimCameraModel camera;
  std::uint64_t seed = 1;
  float frames_per_second = 12.0F;
  bool yaw = true;
  int readings_per_frame = 4;  // of gait and IMU
  double kidnap_at_s = -1.0;   // unannounced; < 0: none
  double fall_at_s = -1.0;     // lies 3 s, then gets up; < 0: none
  double lift_at_s = -1.0;     // carried 3 s and put down elsewhere, with the flag; < 0: none
};
/// The acceptance walk of a preset: random scene, biased gait, drifting yaw, measured tilt; all from the seed.
WalkScenarioOptions acceptance_walk(const FieldDimensions& field, const SimCameraModel& camera, std::uint64_t seed);

class WalkScenario {
 public:
  explicit WalkScenario(const WalkScenarioOptions& options);
  [[nodiscard]] bool ready() const { return ready_; }
  /// Goes on to the next frame; the first is at time 0. `draw` false skips the picture, not the motion.
  const SimFrame& next(bool draw = true);
  /// Readings since the frame before, the last one at the time of the frame.
  [[nodiscard]] std::span<const SimReading> readings() const { return readings_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Lens& lens() const { return lens_; }
  [[nodiscard]] const SimWorld& world() const { return world_; }
  /// For a demonstration that chooses by itself when to kidnap, fall or lift.
  [[nodiscard]] SimWorld& world() { return world_; }
  [[nodiscard]] const WalkScenarioOptions& options() const { return options_; }

 private:
  void events(float dt);
  void move(float dt, double time_s);

  WalkScenarioOptions options_;
  Lens lens_;
  bool ready_ = false;
  Scene scene_;
  SimWorld world_;
  SimGait gait_;
  SimImu imu_;
  SimRenderer renderer_;
  std::vector<std::uint8_t> pixels_;
  std::vector<SimReading> readings_;
  Pose2 odometry_;  // summed
  SimFrame frame_;
};

}  // namespace touchline::sim
