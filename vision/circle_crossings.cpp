// SPDX-License-Identifier: Apache-2.0
// X's by the centre circle: where the half line cuts it. Three of the four ways have to be seen.
#include "vision/junction_search.h"

namespace touchline {
namespace {

/// Whether most of the arc from 10 to 35 degrees beside an angle about the centre was seen.
bool arc_seen(const JunctionSearch& search, float angle, float side) {
  int seen = 0;
  for (int k = 0; k < 6; ++k) {
    const float at = wrap_angle(angle + side * radians(10.0F + 5.0F * static_cast<float>(k))) + math::pi;
    const int bin = static_cast<int>(at / math::two_pi * static_cast<float>(circle_bins));
    seen += search.circle->seen[bin < circle_bins ? bin : 0] ? 1 : 0;
  }
  return seen >= 4;
}

void cut_circle(const JunctionSearch& search, float side) {
  const CircleObservation& circle = search.circle->observation;
  const float r = search.circle->radius_m;
  const float heading = side > 0.0F ? circle.half_line_direction : wrap_angle(circle.half_line_direction + math::pi);
  const GroundPoint out{math::cos(heading), math::sin(heading)};
  const GroundPoint guess{circle.centre.x + r * out.x, circle.centre.y + r * out.y};
  bool inside = false, outside = false;
  float weight = 0.0F, offset = 0.0F;  // of the half line beside the guess, to the left of `out`
  for (const LineSegment& s : search.lines.segments) {
    if (s.on_circle || line_angle(s.direction, out) > radians(12.0F) + 2.0F * s.sigma) continue;
    const float t = (guess.x - s.end[0].x) * s.direction.x + (guess.y - s.end[0].y) * s.direction.y;
    const GroundPoint foot{s.end[0].x + t * s.direction.x, s.end[0].y + t * s.direction.y};
    const float off = (foot.x - guess.x) * -out.y + (foot.y - guess.y) * out.x;
    const float outwards = s.direction.x * out.x + s.direction.y * out.y;
    const float before = outwards > 0.0F ? t : s.length - t;  // of the segment, towards the centre
    const float after = s.length - before;
    if (math::abs(off) >
        1.5F * search.parameters.line_width_m + 2.0F * search.sight.metres_per_px(guess, heading + math::half_pi))
      continue;
    if (math::max(-before, -after) > 0.5F * r) continue;
    const float enough = search.sight.min_branch(guess, heading);
    inside = inside || (before > enough && -after < 0.5F * r);
    outside = outside || (after > enough && -before < 0.5F * r);
    const float w = s.length / (s.sigma + radians(1.0F));
    weight += w;
    offset += w * off;
  }
  if (!inside && !outside) return;
  offset /= weight;
  // Along the half line to the circle: the line misses the centre by `offset`.
  const float aside = math::clamp(offset, -0.5F * r, 0.5F * r);
  const float along = math::sqrt(r * r - aside * aside) - r;
  JunctionCandidate c;
  c.heading = heading;
  c.sigma = 1.0F;
  c.ground = {guess.x + along * out.x - aside * out.y, guess.y + along * out.y + aside * out.x};
  const float angle = math::atan2(c.ground.y - circle.centre.y, c.ground.x - circle.centre.x);
  const int ways = (inside ? 1 : 0) + (outside ? 1 : 0) + (arc_seen(search, angle, 1.0F) ? 1 : 0) +
                   (arc_seen(search, angle, -1.0F) ? 1 : 0);
  if (ways < 3) return reject_junction(search, c, ways, JunctionRejection::branch_too_short);
  const CameraPose& pose = search.rays.projection().pose();
  if (ground_distance(c.ground, {pose.x, pose.y}) > search.parameters.max_range_m)
    return reject_junction(search, c, ways, JunctionRejection::too_far);
  float directions[4];
  for (int k = 0; k < 4; ++k) directions[k] = wrap_angle(heading + static_cast<float>(k) * math::half_pi);
  accept_junction(search, c, JunctionType::x, directions, 4, 0.25F * static_cast<float>(ways));
}

}  // namespace

void cut_circle(const JunctionSearch& search) {
  if (search.circle == nullptr || !search.circle->observation.has_half_line) return;
  cut_circle(search, 1.0F);
  cut_circle(search, -1.0F);
}

bool on_centre_circle(const JunctionSearch& search, const GroundPoint& p) {
  if (search.circle == nullptr) return false;
  const GroundPoint& centre = search.circle->observation.centre;
  const float off = math::hypot(p.x - centre.x, p.y - centre.y) - search.circle->radius_m;
  const GroundPixel pixel(search.rays, p);
  const auto room = [&](float px) { return 1.5F * search.parameters.line_width_m + 2.0F * px; };
  if (off > (1.0F + pixel_slack) * room(pixel.longest())) return false;
  if (off < (1.0F - pixel_slack) * room(pixel.shortest())) return true;
  return off < room(pixel.along(Heading(math::atan2(p.y - centre.y, p.x - centre.x))));
}

bool on_half_line(const JunctionSearch& search, const GroundPoint& p, float direction) {
  if (search.circle == nullptr || !search.circle->observation.has_half_line) return false;
  const CircleObservation& circle = search.circle->observation;
  const float x = circle.centre.x - p.x;
  const float y = circle.centre.y - p.y;
  const auto [s, c] = math::sin_cos(circle.half_line_direction);
  const float across = math::abs(c * y - s * x);
  const float aside = wrap_angle(circle.half_line_direction + math::half_pi);
  if (across > 1.5F * search.parameters.line_width_m + 2.0F * search.sight.metres_per_px(p, aside)) return false;
  return math::abs(angle_difference(math::atan2(y, x), direction)) < right_angle_tolerance;
}

}  // namespace touchline
