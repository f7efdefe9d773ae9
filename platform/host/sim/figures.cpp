// SPDX-License-Identifier: Apache-2.0
// Robots, people, chairs, boards and goals, put together from the three solids.
#include "platform/host/sim/solids.h"

namespace touchline::sim {
namespace {

/// Places parts given in a figure's own axes (x ahead, y left) on the field.
class Figure {
 public:
  Figure(const Pose2& pose, std::vector<Solid>& out) : pose_(pose), out_(out) {}

  void box(float x, float y, float z, float half_x, float half_y, float half_z, const Rgb& color) {
    out_.push_back(make_box(place(x, y, z), {half_x, half_y, half_z}, pose_.theta, Material{color, {}, {}, 1.0F, 0}));
  }
  void limb(const Vec3& a, const Vec3& b, float radius, const Rgb& color) {
    out_.push_back(make_capsule(place(a.x, a.y, a.z), place(b.x, b.y, b.z), radius, Material{color, {}, {}, 1.0F, 0}));
  }
  void ball(float x, float y, float z, float radius, const Rgb& color) {
    out_.push_back(make_sphere(place(x, y, z), radius, Material{color, {}, {}, 1.0F, 0}));
  }

 private:
  [[nodiscard]] Vec3 place(float x, float y, float z) const {
    const FieldPoint p = to_field(pose_, GroundPoint{x, y});
    return {p.x, p.y, z};
  }
  Pose2 pose_;
  std::vector<Solid>& out_;
};

Rgb clothes(std::uint32_t seed, int which) {
  static constexpr int colors[8][3] = {{150, 30, 35}, {30, 32, 45},    {30, 130, 60},   {200, 195, 185},
                                       {40, 45, 90},  {120, 110, 100}, {215, 205, 190}, {60, 60, 65}};
  const int i = floor_int(cell_random(which, 7, seed) * 8.0F);
  return rgb8(colors[i][0], colors[i][1], colors[i][2]);
}

}  // namespace

void append_robot(const Pose2& pose, float height, float phase, const Rgb& team, std::uint32_t seed,
                  std::vector<Solid>& out) {
  Figure f(pose, out);
  const float h = height;
  const Rgb dark = cell_random(1, 1, seed) < 0.7F ? rgb8(52, 52, 54) : rgb8(150, 150, 155);
  const float swing = 0.07F * h * math::sin(phase);
  for (int side = -1; side <= 1; side += 2) {
    const float y = static_cast<float>(side) * 0.09F * h;
    const float x = static_cast<float>(side) * swing;
    f.box(x + 0.03F * h, y, 0.02F * h, 0.13F * h, 0.07F * h, 0.02F * h, dark);
    f.limb({x, y, 0.06F * h}, {x * 0.6F + 0.05F * h, y, 0.24F * h}, 0.045F * h, dark);
    f.limb({x * 0.6F + 0.05F * h, y, 0.24F * h}, {0.0F, y, 0.44F * h}, 0.05F * h, side > 0 ? team : dark);
    const float arm_y = static_cast<float>(side) * 0.21F * h;
    f.limb({0.0F, arm_y, 0.76F * h}, {-x * 0.7F, arm_y, 0.58F * h}, 0.04F * h, team);
    f.limb({-x * 0.7F, arm_y, 0.58F * h}, {0.07F * h - x, arm_y, 0.45F * h}, 0.035F * h, dark);
  }
  f.box(0.0F, 0.0F, 0.64F * h, 0.08F * h, 0.14F * h, 0.18F * h, dark);
  f.box(0.085F * h, 0.0F, 0.68F * h, 0.01F * h, 0.08F * h, 0.08F * h, team);
  f.box(0.01F * h, 0.0F, 0.92F * h, 0.07F * h, 0.07F * h, 0.07F * h, rgb8(70, 70, 75));
}

void append_person(float x, float y, float facing, std::uint32_t seed, std::vector<Solid>& out) {
  Figure f({x, y, facing}, out);
  const Rgb trousers = clothes(seed, 1);
  const Rgb shirt = clothes(seed, 2);
  const Rgb skin = rgb8(200, 150, 120);
  for (int side = -1; side <= 1; side += 2) {
    const auto s = static_cast<float>(side);
    f.limb({0.0F, s * 0.10F, 0.1F}, {0.0F, s * 0.10F, 0.85F}, 0.085F, trousers);
    f.box(0.06F, s * 0.10F, 0.04F, 0.14F, 0.05F, 0.04F, rgb8(190, 190, 190));
    f.limb({0.0F, s * 0.26F, 1.40F}, {0.04F, s * 0.30F, 0.95F}, 0.055F, shirt);
    f.ball(0.04F, s * 0.30F, 0.88F, 0.06F, skin);
  }
  f.box(0.0F, 0.0F, 1.17F, 0.12F, 0.21F, 0.30F, shirt);
  f.ball(0.0F, 0.0F, 1.64F, 0.11F, skin);
}

void append_chair(float x, float y, float facing, std::uint32_t seed, std::vector<Solid>& out) {
  Figure f({x, y, facing}, out);
  const Rgb seat = clothes(seed, 3);
  f.box(0.0F, 0.0F, 0.45F, 0.21F, 0.21F, 0.02F, seat);
  f.box(-0.20F, 0.0F, 0.70F, 0.02F, 0.20F, 0.15F, seat);
  const Rgb metal = rgb8(60, 60, 62);
  for (int i = 0; i < 4; ++i) {
    const float px = (i & 1) != 0 ? 0.19F : -0.19F;
    const float py = (i & 2) != 0 ? 0.19F : -0.19F;
    f.limb({px, py, 0.0F}, {px, py, 0.44F}, 0.014F, metal);
  }
}

void append_board(float x, float y, float facing, float length, float height, const Material& material,
                  std::vector<Solid>& out) {
  const int pieces = 1 + static_cast<int>(length / 1.2F);
  const float piece = length / static_cast<float>(pieces);
  const Pose2 pose{x, y, facing};
  for (int i = 0; i < pieces; ++i) {
    const float along = (static_cast<float>(i) + 0.5F) * piece - length * 0.5F;
    const FieldPoint p = to_field(pose, GroundPoint{0.0F, along});
    out.push_back(make_box({p.x, p.y, height * 0.5F}, {0.02F, piece * 0.5F, height * 0.5F}, facing, material));
  }
}

void append_goal(float goal_x, float width, float height, float diameter, const Rgb& color, std::vector<Solid>& out) {
  const Material paint{color, {}, Pattern::plain, 1.0F, 0};
  const float r = diameter * 0.5F;
  constexpr int pieces = 4;
  for (int i = 0; i < pieces; ++i) {
    const float low = static_cast<float>(i) / pieces;
    const float high = static_cast<float>(i + 1) / pieces;
    for (int side = -1; side <= 1; side += 2) {
      const float y = static_cast<float>(side) * width * 0.5F;
      out.push_back(make_capsule({goal_x, y, low * height}, {goal_x, y, high * height}, r, paint));
    }
    out.push_back(
        make_capsule({goal_x, (low - 0.5F) * width, height}, {goal_x, (high - 0.5F) * width, height}, r, paint));
  }
}

}  // namespace touchline::sim
