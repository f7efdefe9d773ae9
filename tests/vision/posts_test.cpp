// SPDX-License-Identifier: Apache-2.0
#include "vision/posts.h"

#include <doctest/doctest.h>

#include <functional>

#include "tests/vision/drawn_ground.h"

namespace touchline {
namespace {

using test::Bits;
using test::Scene;
using test::Seen;

/// Pixels that see a vertical thing: `hit` gets the ray and tells.
Bits draw(const Seen& seen, const std::function<bool(const Vec3&)>& hit) {
  Bits colour(320, 240);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      Vec3 ray;
      const WorkPoint centre{static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F};
      if (seen.projection.robot_ray(seen.rays->camera_pixel(centre), ray) && hit(ray)) colour.view().set(x, y, true);
    }
  }
  return colour;
}

/// A cylinder that stands at `at`, from `low` to `high` metres: where the ray meets it, if it does.
bool hits_pole(const Vec3& ray, const GroundPoint& at, float radius, float low, float high) {
  const float a = ray.x * ray.x + ray.y * ray.y;
  const float b = ray.x * at.x + ray.y * at.y;
  const float c = at.x * at.x + at.y * at.y - radius * radius;
  const float root = b * b - a * c;
  if (root < 0.0F || b <= 0.0F) return false;
  const float z = 0.58F + (b - math::sqrt(root)) / a * ray.z;
  return z >= low && z <= high;
}

struct Found {
  PostWork work;
  StaticVector<PostObservation, max_posts> posts;
};

Found find(const Seen& seen, const Bits& colour, const Bits& carpet) {
  Found found;
  (void)find_posts(colour.view(), *seen.rays, {seen.mask.view(), carpet.view(), carpet.view(), {}}, {0.10F, 6.0F},
                   found.work, found.posts);
  return found;
}

Bits without(const Bits& carpet, const Bits& things) {
  Bits rest = carpet;
  for (std::size_t i = 0; i < rest.words.size(); ++i) rest.words[i] &= ~things.words[i];
  return rest;
}

}  // namespace

TEST_CASE("a post, near and far, ahead and aside: its axis on the ground") {
  const Seen seen{Scene{}};
  for (const GroundPoint at :
       {GroundPoint{0.6F, 0.2F}, GroundPoint{1.0F, -0.9F}, GroundPoint{2.0F, 0.5F}, GroundPoint{3.0F, 0.0F}}) {
    CAPTURE(at.x);
    CAPTURE(at.y);
    const Bits colour = draw(seen, [&](const Vec3& r) { return hits_pole(r, at, 0.05F, 0.0F, 1.0F); });
    const Found found = find(seen, colour, without(seen.carpet, colour));
    REQUIRE(found.posts.size() == 1);
    const PostObservation& post = found.posts[0];
    const float range = math::hypot(at.x, at.y);
    CHECK(math::hypot(post.ground.x - at.x, post.ground.y - at.y) < 0.02F + 0.04F * range);
    const float bearing = angle_difference(math::atan2(post.ground.y, post.ground.x), math::atan2(at.y, at.x));
    CHECK(math::abs(bearing) < radians(0.8F));
    CHECK(post.covariance.xx > 0.0F);
    CHECK(post.confidence > 0.0F);
  }
}

TEST_CASE("both posts and the crossbar of a goal") {
  const Seen seen{Scene{}};
  const GroundPoint left{1.8F, 0.6F}, right{1.8F, -0.6F};
  const Bits colour = draw(seen, [&](const Vec3& r) {
    if (hits_pole(r, left, 0.05F, 0.0F, 1.0F) || hits_pole(r, right, 0.05F, 0.0F, 1.0F)) return true;
    const float t = 1.8F / r.x;
    return r.x > 0.0F && math::abs(t * r.y) < 0.6F && math::abs(0.58F + t * r.z - 1.0F) < 0.05F;
  });
  CHECK(find(seen, colour, without(seen.carpet, colour)).posts.size() == 2);
}

TEST_CASE("a hidden foot, a short stump, a wide wall and a poster in the air are no posts") {
  const Seen seen{Scene{}};
  const GroundPoint at{1.5F, 0.0F};
  const Bits post = draw(seen, [&](const Vec3& r) { return hits_pole(r, at, 0.05F, 0.0F, 1.0F); });
  const Bits box = draw(seen, [&](const Vec3& r) { return hits_pole(r, {1.2F, 0.0F}, 0.12F, 0.0F, 0.3F); });
  const Bits covered = without(post, box);
  CHECK(find(seen, covered, without(without(seen.carpet, post), box)).posts.empty());
  const Bits stump = draw(seen, [&](const Vec3& r) { return hits_pole(r, at, 0.05F, 0.0F, 0.3F); });
  CHECK(find(seen, stump, without(seen.carpet, stump)).posts.empty());
  const Bits wall = draw(seen, [&](const Vec3& r) { return hits_pole(r, at, 0.25F, 0.0F, 1.0F); });
  CHECK(find(seen, wall, without(seen.carpet, wall)).posts.empty());
  const Bits poster = draw(seen, [&](const Vec3& r) { return hits_pole(r, at, 0.05F, 0.6F, 1.2F); });
  CHECK(find(seen, poster, seen.carpet).posts.empty());
}

TEST_CASE("a post beyond the range, and more posts than there is room for") {
  const Seen seen{Scene{}};
  const Bits far = draw(seen, [&](const Vec3& r) { return hits_pole(r, {7.0F, 0.0F}, 0.05F, 0.0F, 1.0F); });
  CHECK(find(seen, far, without(seen.carpet, far)).posts.empty());
  const Bits many = draw(seen, [&](const Vec3& r) {
    bool hit = false;
    for (int i = -3; i <= 3; ++i) {
      const float angle = 0.35F * static_cast<float>(i);
      hit = hit || hits_pole(r, {1.5F * math::cos(angle), 1.5F * math::sin(angle)}, 0.05F, 0.0F, 1.0F);
    }
    return hit;
  });
  const Found found = find(seen, many, without(seen.carpet, many));
  CHECK(found.posts.size() == 4);
  CHECK(found.posts.dropped() == 3);
}

}  // namespace touchline
