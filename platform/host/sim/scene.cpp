// SPDX-License-Identifier: Apache-2.0
// What a hall holds: chosen by the seed, in the manner of halls seen in pictures of such fields.
#include "platform/host/sim/scene.h"

namespace touchline::sim {

SceneOptions random_scene(const FieldDimensions& field, std::uint64_t seed) {
  static constexpr int carpets[6][3] = {{59, 121, 73},  {69, 116, 64}, {48, 108, 79},
                                        {60, 128, 100}, {74, 112, 52}, {54, 70, 32}};
  Rng rng(seed, 3);
  SceneOptions o;
  o.field = field;
  o.seed = seed;
  o.light = static_cast<Light>(rng.below(3));
  const auto& c = carpets[rng.below(6)];
  o.ground.carpet = rgb8(c[0], c[1], c[2]);
  o.ground.paint = rgb8(208, 211, 203);
  o.ground.wood = rng.uniform() < 0.4F;
  o.ground.floor = o.ground.wood ? rgb8(150, 100, 58) : rgb8(150, 150, 146);
  o.ground.cross_marks = rng.uniform() < 0.5F;
  o.ground.wear = rng.uniform() < 0.5F ? 0.0F : rng.uniform(0.05F, 0.4F);
  o.ground.grain = rng.uniform(0.07F, 0.16F);
  o.ground.floor_line_inset = rng.uniform() < 0.7F ? rng.uniform(0.15F, 0.5F) : 0.0F;
  o.yellow_posts = rng.uniform() < 0.5F;
  o.orange_ball = rng.uniform() < 0.5F;
  o.robots = static_cast<int>(rng.below(4));
  o.robot_height = field.length > 10.0F ? rng.uniform(0.8F, 1.2F) : rng.uniform(0.45F, 0.7F);
  o.own_feet = rng.uniform() < 0.3F;
  o.exposure = rng.uniform(0.9F, 1.35F);
  return o;
}

void Scene::set_light() {
  const float e = options_.exposure;
  exposure_ = e;
  to_sun_ = {0.0F, 0.0F, 0.0F};
  RoomOptions room;
  room.wall = rgb8(198, 197, 192);
  room.ceiling = rgb8(190, 190, 188);
  room.height = options_.field.length > 10.0F ? 4.5F : 3.0F;
  room.window = {1.1F, 1.2F, 1.4F};
  room.windows_emit = true;
  switch (options_.light) {
    case Light::even:
      ambient_ = Rgb{0.50F, 0.50F, 0.50F} * e;
      direct_ = Rgb{0.56F, 0.56F, 0.56F} * e;
      indoor_ = Rgb{0.9F, 0.9F, 0.9F} * e;
      break;
    case Light::dim_warm:
      ambient_ = Rgb{0.46F, 0.40F, 0.28F} * e;
      direct_ = Rgb{0.54F, 0.46F, 0.31F} * e;
      indoor_ = Rgb{0.62F, 0.54F, 0.38F} * e;
      room.window = rgb8(30, 45, 90);
      room.windows_emit = false;
      break;
    case Light::low_sun: {
      ambient_ = Rgb{0.50F, 0.53F, 0.57F} * e;
      direct_ = Rgb{0.85F, 0.79F, 0.66F} * e;
      indoor_ = Rgb{0.75F, 0.76F, 0.78F} * e;
      room.window = {2.5F, 2.5F, 2.4F};
      Rng rng(options_.seed, 4);
      const float azimuth = rng.uniform(0.25F, 1.3F);  // between the two walls with windows
      const float elevation = rng.uniform(0.30F, 0.50F);
      to_sun_ = {math::cos(elevation) * math::cos(azimuth), math::cos(elevation) * math::sin(azimuth),
                 math::sin(elevation)};
      break;
    }
  }
  Rng rng(options_.seed, 5);
  float margin[Room::walls];
  for (float& m : margin) m = rng.uniform(0.9F, 2.6F);
  room_.build(ground_.half_length(), ground_.half_width(), margin, room, options_.seed);
  if (options_.clutter) add_clutter(rng, margin);
}

void Scene::add_clutter(Rng& rng, const float (&margin)[Room::walls]) {
  const float x = ground_.half_length();
  const float y = ground_.half_width();
  // A green board with white stripes, a grey one likewise, banners with letters: what the field's own lines are taken
  // for.
  const Material boards[4] = {{rgb8(25, 80, 50), rgb8(205, 205, 200), Pattern::stripes, 0.45F, 0},
                              {rgb8(120, 122, 124), rgb8(215, 215, 212), Pattern::stripes, 0.85F, 0},
                              {rgb8(205, 205, 200), rgb8(40, 50, 110), Pattern::text, 1.0F, rng.next_u32()},
                              {rgb8(165, 30, 32), rgb8(220, 220, 215), Pattern::text, 1.0F, rng.next_u32()}};
  for (const Material& material : boards) {
    const std::uint32_t wall = rng.below(4);
    const float gap = math::min(margin[wall] - 0.1F, rng.uniform(0.1F, 1.2F));
    const float length = rng.uniform(1.4F, 2.4F);
    const float height = material.pattern == Pattern::text ? 0.4F : rng.uniform(0.7F, 1.1F);
    const float turn = rng.uniform(-0.15F, 0.15F);
    const float along = rng.uniform(-0.75F, 0.75F);
    if (wall < 2) append_board(wall == 0 ? x + gap : -x - gap, along * y, turn, length, height, material, still_);
    if (wall >= 2)
      append_board(along * x, wall == 2 ? y + gap : -y - gap, math::half_pi + turn, length, height, material, still_);
  }
  for (int i = 0; i < 7; ++i) {
    const std::uint32_t wall = rng.below(4);
    const float gap = rng.uniform(0.3F, margin[wall] - 0.25F);
    const float along = rng.uniform(-1.0F, 1.0F);
    const float px = wall == 0 ? x + gap : wall == 1 ? -x - gap : along * x;
    const float py = wall == 2 ? y + gap : wall == 3 ? -y - gap : along * y;
    const float facing = rng.uniform(-3.1F, 3.1F);
    const std::uint32_t pick = rng.next_u32();
    if (i < 3) append_person(px, py, facing, pick, still_);
    if (i >= 3 && i < 6) append_chair(px, py, facing, pick, still_);
    if (i == 6)
      still_.push_back(make_box({px, py, 0.25F}, {0.2F, 0.25F, 0.25F}, facing, {rgb8(190, 30, 30), {}, {}, 1.0F, 0}));
  }
}

void Scene::build(const SceneOptions& options) {
  options_ = options;
  ground_.build(options.field, options.ground, options.seed);
  still_.clear();
  moving_.clear();
  feet_.clear();
  const Rgb post = options.yellow_posts ? rgb8(205, 165, 20) : rgb8(215, 215, 212);
  for (int side = -1; side <= 1; side += 2) {
    append_goal(static_cast<float>(side) * options.field.length * 0.5F, options.field.goal_width,
                options.field.goal_height, options.field.post_diameter, post, still_);
  }
  set_light();
  light_map_.build(ground_.half_length() + 1.5F, ground_.half_width() + 1.5F, to_sun_, room_, still_);
  solids_ = still_;
}

void Scene::set_moving(std::span<const Pose2> robots, float phase, const FieldPoint& ball) {
  static constexpr int teams[2][3] = {{30, 190, 200}, {210, 50, 180}};
  moving_.clear();
  std::uint32_t number = 0;
  for (const Pose2& pose : robots) {
    const auto& team = teams[number % 2U];
    append_robot(pose, options_.robot_height, phase + static_cast<float>(number) * 1.9F,
                 rgb8(team[0], team[1], team[2]), static_cast<std::uint32_t>(options_.seed) + number, moving_);
    number += 1;
  }
  if (options_.ball) {
    const Material leather{options_.orange_ball ? rgb8(220, 110, 30) : rgb8(215, 215, 212), {}, {}, 1.0F, 0};
    moving_.push_back(make_sphere({ball.x, ball.y, 0.07F}, 0.07F, leather));
  }
  light_map_.set_moving(moving_);
  solids_ = still_;
  solids_.insert(solids_.end(), moving_.begin(), moving_.end());
  solids_.insert(solids_.end(), feet_.begin(), feet_.end());
}

void Scene::set_own_pose(const Pose2& pose, float phase) {
  if (!options_.own_feet) return;
  feet_.clear();
  const Material dark{rgb8(45, 45, 48), {}, {}, 1.0F, 0};
  for (int side = -1; side <= 1; side += 2) {
    const auto s = static_cast<float>(side);
    const FieldPoint foot = to_field(pose, {0.04F + s * 0.03F * math::sin(phase), s * 0.06F});
    feet_.push_back(make_box({foot.x, foot.y, 0.025F}, {0.075F, 0.045F, 0.025F}, pose.theta, dark));
    const FieldPoint hand = to_field(pose, {0.10F, s * 0.17F});
    feet_.push_back(make_box({hand.x, hand.y, 0.26F}, {0.07F, 0.03F, 0.03F}, pose.theta + s * 0.4F, dark));
  }
  solids_ = still_;
  solids_.insert(solids_.end(), moving_.begin(), moving_.end());
  solids_.insert(solids_.end(), feet_.begin(), feet_.end());
}

Rgb Scene::lit_solid(const Rgb& albedo, const Vec3& normal) const {
  const Vec3 overhead{0.0F, 0.0F, 1.0F};
  const bool sun = dot(to_sun_, to_sun_) > 0.0F;
  const float facing = math::max(dot(normal, sun ? to_sun_ : overhead), 0.0F);
  const float sky = 0.75F + 0.25F * normal.z + 0.10F * normal.x;
  return albedo * (indoor_ * (0.75F * sky) + direct_ * (0.45F * facing));
}

bool Scene::occluded(const Vec3& from, const Vec3& to) const {
  const Vec3 way = to - from;
  const float distance = math::sqrt(dot(way, way));
  SolidHit hit;
  for (const Solid& solid : solids_) {
    if (intersect(solid, from, way * (1.0F / distance), distance - 0.03F, hit)) return true;
  }
  return false;
}

}  // namespace touchline::sim
