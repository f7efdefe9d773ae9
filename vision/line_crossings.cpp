// SPDX-License-Identifier: Apache-2.0
// Candidates for junctions: two straight stretches that meet at a right angle, each going up to the other.
#include "vision/junction_search.h"

namespace touchline {
namespace {

bool nearly_parallel(const GroundPoint& a, const GroundPoint& b) {
  constexpr float least = radians(30.0F);
  constexpr float tan_least = 0.577350269F;
  constexpr float slack = 1.0e-4F;  // most are told without the angle itself
  const float across = math::abs(a.x * b.y - a.y * b.x);
  const float along = tan_least * math::abs(a.x * b.x + a.y * b.y);
  if (across > (1.0F + slack) * along) return false;
  return across < (1.0F - slack) * along || line_angle(a, b) < least;
}

/// `a` is the one whose direction is known better. A short `b` tells where it is better than how it is turned, and
/// lines of a field are at right angles: its direction is the mean of both, weighted by what they are good for.
void consider(const JunctionSearch& search, const LineSegment& a, const LineSegment& b) {
  if (nearly_parallel(a.direction, b.direction)) return;  // nearly one line: where they cross says nothing
  GroundPoint square{-a.direction.y, a.direction.x};
  if (square.x * b.direction.x + square.y * b.direction.y < 0.0F) square = {-square.x, -square.y};
  const float off = math::atan2(square.x * b.direction.y - square.y * b.direction.x,
                                square.x * b.direction.x + square.y * b.direction.y);
  const float sigma_b = b.sigma;
  const float tolerance = math::min(right_angle_tolerance + 2.0F * sigma_b, max_angle_tolerance);
  const float prior = right_angle_sigma * right_angle_sigma + a.sigma * a.sigma;
  const bool right = math::abs(off) <= tolerance;
  const float turn = right ? off * prior / (prior + sigma_b * sigma_b) : off;
  const auto [s, c] = math::sin_cos(turn);
  const GroundPoint direction_b{c * square.x - s * square.y, s * square.x + c * square.y};
  // A long one is taken from its end beside the crossing, where what its direction is off matters least.
  const float side[2] = {math::abs(distance_across(a, b.end[0])), math::abs(distance_across(a, b.end[1]))};
  const GroundPoint middle = b.is_short
                                 ? GroundPoint{0.5F * (b.end[0].x + b.end[1].x), 0.5F * (b.end[0].y + b.end[1].y)}
                                 : b.end[side[0] < side[1] ? 0 : 1];
  const float det = a.direction.x * direction_b.y - a.direction.y * direction_b.x;
  const float t =
      ((middle.x - a.end[0].x) * direction_b.y - (middle.y - a.end[0].y) * direction_b.x) / det;  // det is near +-1
  JunctionCandidate found;
  found.ground = {a.end[0].x + t * a.direction.x, a.end[0].y + t * a.direction.y};
  if (!search.sight.reaches(a, a.direction, found.ground) || !search.sight.reaches(b, direction_b, found.ground))
    return;
  found.heading = math::atan2(a.direction.y, a.direction.x);
  found.other = math::atan2(direction_b.y, direction_b.x);
  found.off_angle = math::abs(off);
  // A plane's direction is best at its own middle; b was turned about the point it is taken from.
  const float turned = math::sqrt(prior * sigma_b * sigma_b / (prior + sigma_b * sigma_b));
  const float lever = ground_distance(middle, found.ground);
  // What it is off from a right angle tells how far thinning has moved its ends.
  const float moved = 0.5F * b.length * math::sin(math::abs(off));
  found.sigma = search.sight.place_sigma(found.ground, a, math::hypot(turned * lever, moved));
  if (!right) {
    return reject_junction(search, found, 2,
                           a.chain == b.chain ? JunctionRejection::curved : JunctionRejection::bad_angles);
  }
  search.work.candidates.push_back(found);
}

}  // namespace

void find_line_crossings(const JunctionSearch& search, std::size_t i) {
  const auto& segments = search.lines.segments;
  for (std::size_t k = 0; k < i; ++k) {
    if (segments[k].on_circle) continue;
    const bool first_is_better = segments[i].sigma < segments[k].sigma;
    consider(search, segments[first_is_better ? i : k], segments[first_is_better ? k : i]);
  }
}

}  // namespace touchline
