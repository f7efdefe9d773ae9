// SPDX-License-Identifier: Apache-2.0
#include "vision/junction_places.h"

#include "platform/core/angle.h"
#include "platform/core/elementary.h"
#include "vision/junction_errors.h"

namespace touchline {
namespace {

constexpr float graph_sigma_px = 1.5F;  // working pixels: what thinning moves a crossing by
constexpr float point_sigma_px = 0.5F;  // likewise, of a line point
constexpr float gate_px = 2.5F;         // likewise, across the branch: farther off is another line
constexpr float gate_widths = 0.75F;
constexpr float begin_px = 1.5F;                    // beyond the edge of the line across, where its blur ends
constexpr float short_m = 0.3F;                     // a branch without line points is searched this far, and
constexpr std::size_t most_searched = 12;           // so many working pixels
constexpr float end_m = 0.6F;                       // tilt and an uneven carpet bend what is farther away
constexpr float sin_same_direction = 0.258819045F;  // of 15 degrees
constexpr float branch_sigma = radians(3.0F);       // of a branch's direction, as the search gave it

/// A place's correction with its information matrix: the sum of what the branches say.
struct Correction {
  float xx = 0.0F, xy = 0.0F, yy = 0.0F;
  float x = 0.0F, y = 0.0F;
  void add(const GroundPoint& normal, float offset, float information) {
    xx += information * normal.x * normal.x;
    xy += information * normal.x * normal.y;
    yy += information * normal.y * normal.y;
    x += information * offset * normal.x;
    y += information * offset * normal.y;
  }
};

/// Weighted fit of `across = offset + slope * along`, the slope near zero.
struct BranchFit {
  float w = 0.0F, ws = 0.0F, wss = 0.0F, wa = 0.0F, wsa = 0.0F;
  void add(float along, float across, float weight) {
    w += weight;
    ws += weight * along;
    wss += weight * along * along;
    wa += weight * across;
    wsa += weight * along * across;
  }
};

/// How far from a branch a point may lie.
float reach_across(const LinePoint& p, float line_width_m) {
  return math::max(gate_widths * line_width_m, gate_px * p.sigma);
}

/// Whether a point can belong to a branch in any direction: most are told by this alone.
bool may_be_near(const GroundPoint& at, const LinePoint& p, float line_width_m) {
  constexpr float slack = 1.01F;  // unit vectors are so to rounding
  const float squared = math::square(p.ground.x - at.x) + math::square(p.ground.y - at.y);
  return squared <= slack * (end_m * end_m + math::square(reach_across(p, line_width_m)));
}

class BranchFitter {
 public:
  BranchFitter() = default;
  BranchFitter(const Junction& j, float direction, float line_width_m)
      : at_(j.ground), out_{math::cos(direction), math::sin(direction)}, line_width_m_(line_width_m) {}

  /// A point that may lie on the branch.
  void offer(const LinePoint& p) {
    const float dx = p.ground.x - at_.x;
    const float dy = p.ground.y - at_.y;
    const float along = dx * out_.x + dy * out_.y;
    const float across = dy * out_.x - dx * out_.y;
    if (along < 0.5F * line_width_m_ + begin_px * p.sigma || along > end_m) return;
    if (math::abs(across) > reach_across(p, line_width_m_)) return;
    if (math::abs(out_.x * p.dir_y - out_.y * p.dir_x) > sin_same_direction) return;
    fit_.add(along, across, 1.0F / math::square(point_sigma_px * p.sigma));
  }

  /// Looks for points by itself, a working pixel apart.
  void search(const LinePointInput& input) {
    WorkPoint begin, end;
    const auto away = [this](float along) { return GroundPoint{at_.x + along * out_.x, at_.y + along * out_.y}; };
    if (!input.rays.work_point(away(0.5F * line_width_m_), 0.0F, begin) ||
        !input.rays.work_point(away(0.5F * line_width_m_ + short_m), 0.0F, end)) {
      return;
    }
    const WorkPoint way{end.u - begin.u, end.v - begin.v};
    const float length = math::hypot(way.u, way.v);
    if (!(length > 0.0F)) return;
    StaticVector<WorkPoint, most_searched> places;
    for (int k = 1; !places.full() && static_cast<float>(k) < length; ++k) {
      const float share = static_cast<float>(k) / length;
      places.push_back({begin.u + share * way.u, begin.v + share * way.v});
    }
    FoundLinePoints points;
    find_line_points_at(input, places.span(), way, points);
    for (const LinePoint& point : points.span()) offer(point);
  }

  [[nodiscard]] const BranchFit& fit() const { return fit_; }

 private:
  GroundPoint at_, out_;  // the junction, and the unit direction of the branch
  float line_width_m_ = 0.0F;
  BranchFit fit_;
};

/// What a branch says of the junction's place across itself.
void add_branch(const BranchFit& fit, float direction, Correction& sum) {
  if (!(fit.w > 0.0F)) return;
  const float slope_information = fit.wss + 1.0F / math::square(branch_sigma);
  const float information = fit.w - fit.ws * fit.ws / slope_information;
  const float offset = (fit.wa - fit.ws * fit.wsa / slope_information) / information;
  sum.add({-math::sin(direction), math::cos(direction)}, offset, information);
}

}  // namespace

void place_junctions(const LinePointInput& input, Features& features) {
  const GroundProjection& projection = input.rays.projection();
  // The graph is known to a working pixel; the rest is in camera pixels.
  const float camera_px_per_work_px = input.rays.camera_pixel({1.0F, 1.0F}).u;
  for (Junction& j : features.junctions) {
    if (j.type == JunctionType::x) continue;  // on the centre circle: two of its branches are no straight lines
    const Sym2 prior = projection.ground_covariance(j.pixel, graph_sigma_px * camera_px_per_work_px, 0.0F);
    const float prior_det = prior.xx * prior.yy - prior.xy * prior.xy;
    if (!(prior_det > 0.0F)) continue;
    Correction sum{prior.yy / prior_det, -prior.xy / prior_det, prior.xx / prior_det};
    StaticVector<BranchFitter, 4> branches;  // as many as an X has
    for (int i = 0; i < j.branches; ++i) {
      branches.push_back(BranchFitter(j, j.direction[static_cast<std::size_t>(i)], input.line_width_m));
    }
    for (const LinePoint& p : features.line_points) {
      if (!may_be_near(j.ground, p, input.line_width_m)) continue;
      for (BranchFitter& branch : branches) branch.offer(p);
    }
    for (std::size_t i = 0; i < branches.size(); ++i) {
      if (!(branches[i].fit().w > 0.0F)) branches[i].search(input);
      add_branch(branches[i].fit(), j.direction[i], sum);
    }
    const float det = sum.xx * sum.yy - sum.xy * sum.xy;  // > 0: the prior's part is positive definite
    const GroundPoint at{j.ground.x + (sum.yy * sum.x - sum.xy * sum.y) / det,
                         j.ground.y + (sum.xx * sum.y - sum.xy * sum.x) / det};
    PixelPoint pixel;
    if (!projection.pixel(at, pixel)) continue;
    j.ground = at;
    j.pixel = pixel;
    j.covariance = projection.ground_covariance(pixel, junction_sigma_px, junction_sigma_tilt);
  }
}

}  // namespace touchline
