// SPDX-License-Identifier: Apache-2.0
// Every table of localization's kernels gives the scalar code's floats, bit for bit, and those are what the definitions
// say: distances looked up one by one, landmarks tried one by one, the exact nearest line of each sample.
#include "loc/kernels.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <vector>

#include "loc/full_likelihood.h"
#include "loc/robust.h"
#include "platform/core/rng.h"
#include "platform/processor/fastest_kernels.h"
#include "tests/support/synthetic_view.h"
#include "tests/support/test_field.h"

using namespace touchline;

namespace {

bool same_bits(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }

std::vector<LocKernels> vector_tables() {
  std::vector<LocKernels> tables;
  for (int i = 0; i < kernel_tables; ++i) {
    if (loc_kernel_table(i).name != nullptr) tables.push_back(loc_kernel_table(i));
  }
  return tables;
}

struct Fixture {
  Field field;
  std::unique_ptr<DistanceField> map = std::make_unique<DistanceField>();
  test::SyntheticView view;
  CameraPose camera{0.05F, 0.0F, 0.58F, 0.2F, radians(30.0F), radians(1.0F)};
  LocalizerConfig config;
  std::unique_ptr<Observation> observation = std::make_unique<Observation>();
  Rng rng{5};
  LineTerms lines{};
  LandmarkTerms landmarks{};

  explicit Fixture(const char* preset) : field(test::field_of(preset)), view(field, test::paper_lens(), 752, 480) {
    map->build(field);
  }
  Pose2 anywhere() {
    return {rng.uniform(-1.2F, 1.2F) * field.half_carpet_length(), rng.uniform(-1.2F, 1.2F) * field.half_carpet_width(),
            rng.uniform(-math::pi, math::pi)};
  }
  void look(const Pose2& truth) {
    test::SyntheticOptions options;
    options.pixel_noise = 0.5F;
    options.max_range = rng.uniform(1.0F, 5.0F);
    make_observation(view.look(truth, camera, options, rng), config, *observation);
    prepare_lines(*map, *observation, 0.1F, 1, lines);
    prepare_landmarks(field, *observation, Landmarks::both, 0.1F, landmarks);
  }
  [[nodiscard]] RefineTerms refine_terms(const Pose2& pose) {
    RefineTerms t;
    t.samples = observation->lines.view();
    t.lines = quarter_lines(field);
    t.camera = camera;
    t.pitch_axis = multiply(rotation_z(camera.yaw), Vec3{0.0F, 1.0F, 0.0F});
    t.roll_axis = {1.0F, 0.0F, 0.0F};
    t.pose = pose;
    const auto [s, c] = math::sin_cos(pose.theta);
    t.sin = s;
    t.cos = c;
    t.pitch = rng.uniform(-0.02F, 0.02F);
    t.roll = rng.uniform(-0.02F, 0.02F);
    t.extra_variance = math::square(rng.uniform(0.0F, 0.1F));
    return t;
  }
};

template <typename Check>
void for_many_views(Check check) {
  for (const char* preset : {"acyut-5x3", "small-2026", "middle-2026"}) {
    Fixture f(preset);
    for (int i = 0; i < 20; ++i) {
      const Pose2 truth = f.anywhere();
      CAPTURE(preset);
      CAPTURE(i);
      f.look(truth);
      check(f, truth);
    }
  }
}

/// By LineMatch of distance_field.h, one sample after the other, in double.
RefineSums exact_sums(const Field& field, const RefineTerms& t, double (&hessian)[15], double (&gradient)[5]) {
  RefineSums out;
  const LineSampleView& v = t.samples;
  for (int i = 0; i < v.count; ++i) {
    const Vec3 ray{v.ground_x[i] - t.camera.x, v.ground_y[i] - t.camera.y, -t.camera.height};
    const auto tilted = [&](float pitch, float roll) {
      const auto cross = [](const Vec3& a, const Vec3& b) {
        return Vec3{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
      };
      const Vec3 p = cross(t.pitch_axis, ray);
      const Vec3 r = cross(t.roll_axis, ray);
      return Vec3{ray.x + pitch * p.x + roll * r.x, ray.y + pitch * p.y + roll * r.y, ray.z + pitch * p.z + roll * r.z};
    };
    const auto ground = [&](const Vec3& r) {
      return GroundPoint{t.camera.x - t.camera.height * r.x / r.z, t.camera.y - t.camera.height * r.y / r.z};
    };
    const Vec3 r = tilted(t.pitch, t.roll);
    out.weight += v.weight[i];
    const FieldPoint p = to_field(t.pose, ground(r));
    const float dx = t.cos * v.dir_x[i] - t.sin * v.dir_y[i];
    const float dy = t.sin * v.dir_x[i] + t.cos * v.dir_y[i];
    const LineMatch line = nearest_line(field, p, dx, dy);
    const float variance = v.own_variance[i] + t.extra_variance;
    const float z2 = line.distance * line.distance / variance;
    if (normalized(r).z > -0.02F || z2 >= 16.0F) {
      out.cost += v.weight[i] * robust_limit;
      continue;
    }
    out.cost += v.weight[i] * robust_cost(z2);
    out.explained += v.weight[i] * robust_weight(z2);
    constexpr float step = 1e-3F;
    const auto slope = [&](const FieldPoint& after, const FieldPoint& before) {
      return (line.normal_x * (after.x - before.x) + line.normal_y * (after.y - before.y)) / (2.0F * step);
    };
    const auto turned = [&](float by) { return to_field({t.pose.x, t.pose.y, t.pose.theta + by}, ground(r)); };
    const auto with = [&](float pitch, float roll) {
      return to_field(t.pose, ground(tilted(t.pitch + pitch, t.roll + roll)));
    };
    const float j[5] = {line.normal_x, line.normal_y, slope(turned(step), turned(-step)),
                        slope(with(step, 0.0F), with(-step, 0.0F)), slope(with(0.0F, step), with(0.0F, -step))};
    const double w = static_cast<double>(v.weight[i] * robust_weight(z2) / variance);
    int at = 0;
    for (int a = 0; a < 5; ++a) {
      for (int b = 0; b <= a; ++b) hessian[at++] += w * static_cast<double>(j[a]) * static_cast<double>(j[b]);
      gradient[a] += w * static_cast<double>(j[a]) * static_cast<double>(line.distance);
    }
  }
  return out;
}

}  // namespace

TEST_CASE("costs of lines and landmarks are the same with every table, for any number of poses") {
  for_many_views([](Fixture& f, const Pose2& truth) {
    for (int count = 1; count <= pose_lanes; ++count) {
      PoseBlock block;
      for (int i = 0; i < count; ++i) {
        block.push_back(i % 2 == 0 ? f.anywhere() : Pose2{truth.x + 0.05F, truth.y, truth.theta});
      }
      float lines[pose_lanes], landmarks[pose_lanes];
      scalar_loc_kernels().line_costs(f.lines, block, lines);
      scalar_loc_kernels().landmark_costs(f.landmarks, block, landmarks);
      for (const LocKernels& kernels : vector_tables()) {
        float other[pose_lanes];
        kernels.line_costs(f.lines, block, other);
        for (int i = 0; i < count; ++i) CHECK(same_bits(other[i], lines[i]));
        kernels.landmark_costs(f.landmarks, block, other);
        for (int i = 0; i < count; ++i) CHECK(same_bits(other[i], landmarks[i]));
      }
    }
  });
}

TEST_CASE("linearisations are the same with every table, for any number of samples") {
  for_many_views([](Fixture& f, const Pose2& truth) {
    RefineTerms terms = f.refine_terms({truth.x + 0.1F, truth.y - 0.05F, truth.theta + 0.05F});
    for (const int left_out : {0, 1, 5, 7}) {
      if (terms.samples.count < left_out) continue;
      terms.samples.count -= left_out;
      if (left_out == 1) terms.extra_variance = 0.0F;
      RefineSums sums;
      scalar_loc_kernels().linearise(terms, sums);
      for (const LocKernels& kernels : vector_tables()) {
        RefineSums other;
        kernels.linearise(terms, other);
        for (int k = 0; k < 15; ++k) CHECK(same_bits(other.hessian[k], sums.hessian[k]));
        for (int k = 0; k < refine_unknowns; ++k) CHECK(same_bits(other.gradient[k], sums.gradient[k]));
        CHECK(same_bits(other.cost, sums.cost));
        CHECK(same_bits(other.explained, sums.explained));
        CHECK(same_bits(other.weight, sums.weight));
      }
    }
  });
}

TEST_CASE("lines cost what the distance at their nearest node says") {
  for_many_views([](Fixture& f, const Pose2& truth) {
    PoseBlock block;
    block.push_back({truth.x - 0.07F, truth.y + 0.04F, truth.theta + 0.03F});
    float costs[pose_lanes];
    scalar_loc_kernels().line_costs(f.lines, block, costs);
    const Pose2 pose{block.x[0], block.y[0], block.theta[0]};
    float expected = 0.0F, weight = 0.0F;
    for (std::size_t i = 0; i < f.observation->filter_lines.size(); ++i) {
      const LineSample s = f.observation->filter_lines[i];
      const FieldPoint p = to_field(pose, s.ground);
      const auto [sine, cosine] = math::sin_cos(pose.theta);
      const LineAxis axis = axis_of(cosine * s.dir_x - sine * s.dir_y, sine * s.dir_x + cosine * s.dir_y);
      const auto node = [](float v) { return DistanceField::cell * std::round(math::abs(v) / DistanceField::cell); };
      const float d = f.map->distance({node(p.x), node(p.y)}, axis);
      expected += s.weight * robust_cost(d * d / (s.variance + 0.01F));
      weight += s.weight;
    }
    // A sample half-way between two nodes may be rounded to the other one.
    const double slack = 0.01 + 0.02 / (1.0 + static_cast<double>(weight));
    CHECK(costs[0] == doctest::Approx(static_cast<double>(expected)).epsilon(slack));
  });
}

TEST_CASE("a landmark costs what the best place of its type costs") {
  for_many_views([](Fixture& f, const Pose2& truth) {
    const Pose2 pose{truth.x - 0.07F, truth.y + 0.04F, truth.theta + 0.03F};
    float expected = 0.0F;
    for (const Junction& j : f.observation->features->junctions) {
      float best = 1e6F;
      for (const FieldLandmark& l : f.field.landmarks()) {
        if (l.type != j.type) continue;
        const GroundPoint g = to_ground(pose, l.at);
        const float xx = j.covariance.xx + 0.01F, yy = j.covariance.yy + 0.01F, xy = j.covariance.xy;
        const float dx = j.ground.x - g.x, dy = j.ground.y - g.y;
        float turn = angle_difference(j.direction[0] + pose.theta, l.direction[0]);
        if (j.type == JunctionType::x) turn = angle_difference(4.0F * turn, 0.0F) * 0.25F;
        const float z2 = (yy * dx * dx - 2.0F * xy * dx * dy + xx * dy * dy) / (xx * yy - xy * xy);
        best = math::min(best, z2 + math::square(turn / 0.2F));
      }
      expected += j.confidence * robust_cost(best);
    }
    CHECK(landmark_log_likelihood(f.landmarks, pose, scalar_loc_kernels()) ==
          doctest::Approx(-static_cast<double>(expected)).epsilon(1e-3));
  });
}

TEST_CASE("a junction that the field has none of costs its full confidence") {
  FieldDimensions d = *field_preset("small-2026");
  d.circle_radius = 0.0F;
  Field field;
  REQUIRE(Field::create(d, field) == Status::ok);
  Features features;
  Junction x;
  x.type = JunctionType::x;
  x.confidence = 0.5F;
  x.covariance = {0.01F, 0.0F, 0.01F};
  features.junctions.push_back(x);
  const auto observation = std::make_unique<Observation>();
  observation->features = &features;
  LandmarkTerms terms;
  prepare_landmarks(field, *observation, Landmarks::lines, 0.1F, terms);
  for (const LocKernels& kernels : {scalar_loc_kernels(), fastest_loc_kernels()}) {
    CHECK(landmark_log_likelihood(terms, {}, kernels) == doctest::Approx(-0.5 * 3.0).epsilon(1e-3));
  }
}

TEST_CASE("a linearisation is that of the exact nearest lines") {
  for_many_views([](Fixture& f, const Pose2& truth) {
    const RefineTerms terms = f.refine_terms({truth.x + 0.03F, truth.y - 0.02F, truth.theta + 0.02F});
    RefineSums sums;
    scalar_loc_kernels().linearise(terms, sums);
    double hessian[15] = {}, gradient[5] = {};
    const RefineSums expected = exact_sums(f.field, terms, hessian, gradient);
    // A sample on the edge of its reach, or as near to one line as to another, may go the other way.
    const double slack = 1e-3 + 0.5 / (1.0 + static_cast<double>(expected.weight));
    CHECK(sums.weight == doctest::Approx(static_cast<double>(expected.weight)).epsilon(1e-4));
    CHECK(sums.cost == doctest::Approx(static_cast<double>(expected.cost)).epsilon(slack));
    CHECK(sums.explained == doctest::Approx(static_cast<double>(expected.explained)).epsilon(slack));
    double trace[5] = {};
    for (int a = 0, at = 0; a < 5; at += ++a + 1) trace[a] = std::sqrt(hessian[at]);
    for (int a = 0, at = 0; a < 5; ++a) {
      for (int b = 0; b <= a; ++b, ++at) {
        CHECK(std::abs(static_cast<double>(sums.hessian[at]) - hessian[at]) <= slack * (1.0 + trace[a] * trace[b]));
      }
      CHECK(std::abs(static_cast<double>(sums.gradient[a]) - gradient[a]) <= slack * (1.0 + 4.0 * trace[a]));
    }
  });
}

TEST_CASE("sines and cosines are those of math::sin_cos with every table") {
  Rng rng(11);
  for (int i = 0; i < 2000; ++i) {
    alignas(64) float angles[pose_lanes], sine[pose_lanes], cosine[pose_lanes];
    const float reach = i % 2 == 0 ? math::pi : 1.0e4F;
    for (float& angle : angles) angle = rng.uniform(-reach, reach);
    if (i == 0) std::copy_n(std::begin({0.0F, -0.0F, math::pi, -math::half_pi, 1e-20F, 1e4F}), 6, angles);
    for (const LocKernels& kernels : {scalar_loc_kernels(), portable_loc_kernels(), fastest_loc_kernels()}) {
      kernels.sin_cos(angles, sine, cosine);
      for (int k = 0; k < pose_lanes; ++k) {
        const auto [s, c] = math::sin_cos(angles[k]);
        CHECK(same_bits(sine[k], s));
        CHECK(same_bits(cosine[k], c));
      }
    }
  }
}

TEST_CASE("noise is the same with every table, normal, and each number by itself") {
  Rng rng(12);
  constexpr int blocks = 5000;
  double sum = 0.0, squares = 0.0, cubes = 0.0, neighbours = 0.0, rows = 0.0;
  int beyond_two = 0, beyond_four = 0;
  float largest = 0.0F;
  for (int i = 0; i < blocks; ++i) {
    std::uint32_t words[noise_words];
    rng.next_u32s(words, noise_words);
    if (i == 0) std::copy_n(std::begin({0U, 0xFFFFFFFFU, 0x100U, 0x80000000U}), 4, words);
    Noise noise;
    scalar_loc_kernels().normals(words, noise);
    for (const LocKernels& kernels : vector_tables()) {
      Noise other;
      kernels.normals(words, other);
      for (int row = 0; row < 3; ++row) {
        for (int k = 0; k < noise_block; ++k) CHECK(same_bits(other.value[row][k], noise.value[row][k]));
      }
    }
    for (int row = 0; row < 3; ++row) {
      for (int k = 0; k < noise_block; ++k) {
        const double v = static_cast<double>(noise.value[row][k]);
        sum += v;
        squares += v * v;
        cubes += v * v * v;
        neighbours += v * static_cast<double>(noise.value[row][(k + noise_block / 2) % noise_block]);
        rows += v * static_cast<double>(noise.value[(row + 1) % 3][k]);
        beyond_two += std::abs(v) > 2.0 ? 1 : 0;
        beyond_four += std::abs(v) > 4.0 ? 1 : 0;
        largest = math::max(largest, math::abs(noise.value[row][k]));
      }
    }
  }
  constexpr double n = blocks * noise_words;
  CHECK(std::abs(sum / n) < 5.0 / std::sqrt(n));
  CHECK(std::abs(squares / n - 1.0) < 5.0 * std::sqrt(2.0 / n));
  CHECK(std::abs(cubes / n) < 5.0 * std::sqrt(15.0 / n));
  CHECK(std::abs(neighbours / n) < 5.0 * std::sqrt(2.0 / n));
  CHECK(std::abs(rows / n) < 5.0 / std::sqrt(n));
  CHECK(std::abs(beyond_two - 0.0455 * n) < 5.0 * std::sqrt(0.0455 * n));
  CHECK(std::abs(beyond_four - 6.33e-5 * n) < 5.0 * std::sqrt(6.33e-5 * n));
  CHECK(largest < 5.9F);
}

TEST_CASE("one random word is the radius and the next the angle") {
  std::uint32_t words[noise_words] = {};
  const std::uint32_t radius_words[] = {0x80000000U, 0x01000000U, 0x7FFFFF00U, 0x12345600U};
  const std::uint32_t angle_words[] = {0x00000000U, 0x40000000U, 0xB504F300U, 0xFFFFFF00U};
  for (int k = 0; k < 4; ++k) {
    words[k] = radius_words[k];
    words[noise_block / 2 + k] = angle_words[k];
  }
  for (const LocKernels& kernels : {scalar_loc_kernels(), fastest_loc_kernels()}) {
    Noise noise;
    kernels.normals(words, noise);
    for (int k = 0; k < 4; ++k) {
      const double u = (static_cast<double>(radius_words[k] >> 8) + 0.5) / 16777216.0;
      const double r = std::sqrt(-2.0 * std::log(u));
      const double turn = static_cast<double>(angle_words[k] >> 8) / 16777216.0 - 0.125;
      const double angle = 2.0 * 3.14159265358979 * turn;
      CHECK(static_cast<double>(noise.value[0][k]) == doctest::Approx(r * std::sin(angle)).epsilon(1e-5));
      CHECK(static_cast<double>(noise.value[0][noise_block / 2 + k]) ==
            doctest::Approx(r * std::cos(angle)).epsilon(1e-5));
    }
  }
}
