// SPDX-License-Identifier: Apache-2.0
#include "platform/host/sim/scenario.h"

#include "platform/host/sim/vec.h"

namespace touchline::sim {
namespace {

/// One seed out of two, so that neighbours share nothing (the finaliser of SplitMix64, Steele et al. 2014).
std::uint64_t blend(std::uint64_t seed, std::uint64_t number) {
  std::uint64_t z = seed * 0x9E3779B97F4A7C15ULL + number + 1U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31U);
}

ImageEffects random_effects(Light light, Rng& rng) {
  ImageEffects e;
  e.blur_px = rng.uniform(0.5F, 0.9F);
  e.noise = light == Light::dim_warm ? rng.uniform(4.0F, 7.0F) : rng.uniform(2.0F, 4.0F);
  e.vignetting = rng.uniform(0.2F, 0.5F);
  return e;
}

/// From a point to the nearest goal post: no robot stands in one.
float post_distance(const FieldDimensions& field, const FieldPoint& at) {
  const float x = field.length * 0.5F - math::abs(at.x);
  return length(x, field.goal_width * 0.5F - math::abs(at.y));
}

FrameView view_of(const std::vector<std::uint8_t>& pixels, const SimCameraModel& camera) {
  return {PixelFormat::rgb24, pixels.data(), camera.width, camera.height, camera.width * 3};
}

}  // namespace

std::optional<SimCameraModel> camera_model(std::string_view name) {
  SimCameraModel m;
  if (name == "fisheye-185") {
    m.width = 752;
    m.height = 480;
    m.lens.focal_px = 232.9F;
    m.lens.max_theta = radians(92.5F);
  } else if (name == "fisheye-185-qvga") {
    m.width = 320;
    m.height = 240;
    m.lens.focal_px = 99.1F;
    m.lens.max_theta = radians(92.5F);
  } else if (name == "fisheye-140") {
    m.width = 640;
    m.height = 480;
    m.lens.model = LensModel::equisolid;
    m.lens.max_theta = radians(70.0F);
    m.lens.focal_px = 320.0F / (2.0F * math::sin(radians(35.0F)));
  } else if (name == "fisheye-140-kb") {
    m.width = 640;
    m.height = 480;
    m.lens.model = LensModel::kannala_brandt;
    m.lens.max_theta = radians(70.0F);
    m.lens.focal_px = 272.0F;
    m.lens.k = {-0.02F, -0.003F, 0.0F, 0.0F};
  } else {
    return std::nullopt;
  }
  m.lens.cx = static_cast<float>(m.width) * 0.5F;
  m.lens.cy = static_cast<float>(m.height) * 0.5F;
  return m;
}

PoseScenario::PoseScenario(const PoseScenarioOptions& options) : options_(options) {
  ready_ = Lens::create(options.camera.lens, lens_) == Status::ok;
  if (ready_) renderer_.set_lens(lens_, options.camera.width, options.camera.height);
}

const SimFrame& PoseScenario::frame(int index) {
  const int number = index / options_.frames_per_scene;
  if (number != scene_number_) {
    scene_.build(random_scene(options_.field, blend(options_.seed, static_cast<std::uint64_t>(number) + 1000000U)));
    scene_number_ = number;
  }
  Rng rng(blend(options_.seed, static_cast<std::uint64_t>(index)), 10);
  const auto somewhere = [&](float inset) {
    const float x = options_.field.length * 0.5F - inset;
    const float px = rng.uniform(-x, x);
    const float y = options_.field.width * 0.5F - inset;
    return FieldPoint{px, rng.uniform(-y, y)};
  };
  FieldPoint at = somewhere(0.0F);
  for (int tries = 0; tries < 16 && post_distance(options_.field, at) < 0.2F; ++tries) at = somewhere(0.0F);
  SimFrame f;
  f.index = index;
  f.truth = {at.x, at.y, rng.uniform(-math::pi, math::pi)};
  f.true_camera.height = rng.uniform(options_.min_height, options_.max_height);
  f.true_camera.pitch = rng.uniform(options_.min_pitch, options_.max_pitch);
  f.true_camera.roll = rng.uniform(-options_.max_roll, options_.max_roll);
  f.mount = f.true_camera;
  f.mount.pitch += options_.tilt_noise * rng.gaussian();
  f.mount.roll += options_.tilt_noise * rng.gaussian();
  f.has_yaw = options_.yaw;
  const float yaw_error = radians(2.0F) * rng.gaussian();
  if (options_.yaw) f.yaw = f.truth.theta + yaw_error;
  std::vector<Pose2> robots;
  for (int i = 0; i < scene_.options().robots; ++i) {
    FieldPoint p = somewhere(0.2F);
    // Not inside the robot itself: pushed out along the way between both.
    const float away = math::max(length(p.x - at.x, p.y - at.y), 1e-3F);
    if (away < 0.45F) p = {at.x + (p.x - at.x) * 0.45F / away, at.y + (p.y - at.y) * 0.45F / away};
    robots.push_back({p.x, p.y, rng.uniform(-math::pi, math::pi)});
  }
  // Drawn one after the other: the order of a call's arguments is the compiler's choice.
  const float phase = rng.uniform(0.0F, math::two_pi);
  const FieldPoint ball = somewhere(0.1F);
  scene_.set_moving(robots, phase, ball);
  scene_.set_own_pose(f.truth, rng.uniform(0.0F, math::two_pi));
  const ImageEffects effects = random_effects(scene_.options().light, rng);
  renderer_.render(scene_, f.truth, f.true_camera, effects, rng.next_u32(), pixels_);
  f.image = view_of(pixels_, options_.camera);
  frame_ = f;
  return frame_;
}

WalkScenarioOptions acceptance_walk(const FieldDimensions& field, const SimCameraModel& camera, std::uint64_t seed) {
  Rng rng(blend(seed, 1), 11);
  WalkScenarioOptions o;
  o.seed = seed;
  o.camera = camera;
  o.scene = random_scene(field, blend(seed, 2));
  o.effects = random_effects(o.scene.light, rng);
  o.walk.field = field;
  o.walk.seed = blend(seed, 3);
  o.walk.robots = o.scene.robots;
  o.walk.camera.height = field.length > 10.0F ? rng.uniform(0.9F, 1.2F) : rng.uniform(0.5F, 0.7F);
  o.walk.camera.pitch = radians(rng.uniform(25.0F, 35.0F));
  o.walk.speed = rng.uniform(0.15F, 0.25F);
  o.gait.scale_x = rng.uniform(0.93F, 1.08F);
  o.gait.scale_y = rng.uniform(0.9F, 1.1F);
  o.gait.scale_theta = rng.uniform(0.93F, 1.08F);
  o.gait.drift = radians(rng.uniform(-0.3F, 0.3F));
  o.imu.drift = radians(rng.uniform(-0.1F, 0.1F));
  return o;
}

WalkScenario::WalkScenario(const WalkScenarioOptions& options)
    : options_(options),
      world_(options.walk),
      gait_(options.gait, blend(options.seed, 4)),
      imu_(options.imu, blend(options.seed, 5)) {
  ready_ = Lens::create(options.camera.lens, lens_) == Status::ok;
  if (!ready_) return;
  renderer_.set_lens(lens_, options.camera.width, options.camera.height);
  scene_.build(options.scene);
  frame_.index = -1;
}

void WalkScenario::events(float dt) {
  const double now = world_.state().time_s;
  const auto due = [&](double at) { return at >= 0.0 && now < at && now + static_cast<double>(dt) >= at; };
  if (due(options_.kidnap_at_s)) world_.kidnap_anywhere();
  if (due(options_.fall_at_s)) world_.fall(3.0F);
  if (due(options_.lift_at_s)) world_.lift(3.0F, mirrored(world_.state().pose));
}

void WalkScenario::move(float dt, double time_s) {
  if (frame_.index > 0) {
    events(dt);
    world_.step(dt);
    const Pose2 believed = gait_.step(world_.state(), dt);
    frame_.odometry = compose(frame_.odometry, believed);
    odometry_ = compose(odometry_, believed);
    frame_.kidnapped = frame_.kidnapped || world_.state().kidnapped;
  }
  imu_.step(world_.state(), dt);
  readings_.push_back({time_s, odometry_, imu_.yaw(), imu_.camera(), world_.state().activity});
}

const SimFrame& WalkScenario::next(bool draw) {
  frame_.index += 1;
  frame_.odometry = {};
  frame_.kidnapped = false;
  readings_.clear();
  const int steps = frame_.index > 0 ? options_.readings_per_frame : 1;
  const float dt = 1.0F / (options_.frames_per_second * static_cast<float>(options_.readings_per_frame));
  // Times are multiples of the rate, not sums of rounded steps.
  const auto rate = static_cast<double>(options_.frames_per_second);
  frame_.time_s = frame_.index / rate;
  for (int i = 0; i < steps; ++i) {
    move(dt, frame_.time_s - static_cast<double>(steps - 1 - i) / (rate * options_.readings_per_frame));
  }
  const WorldState& now = world_.state();
  frame_.mount = imu_.camera();
  frame_.has_yaw = options_.yaw;
  frame_.yaw = options_.yaw ? imu_.yaw() - options_.imu.goal_yaw : 0.0F;
  frame_.moved_by_hand = now.activity == Activity::fallen || now.activity == Activity::lifted;
  frame_.truth = now.pose;
  frame_.true_camera = now.camera;
  if (draw) {
    scene_.set_moving(world_.robots(), now.phase, world_.ball());
    scene_.set_own_pose(now.pose, now.phase);
    renderer_.render(scene_, now.pose, now.camera, options_.effects,
                     blend(options_.seed, 1000U + static_cast<std::uint64_t>(frame_.index)), pixels_);
    frame_.image = view_of(pixels_, options_.camera);
  }
  return frame_;
}

}  // namespace touchline::sim
