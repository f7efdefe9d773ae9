// SPDX-License-Identifier: Apache-2.0
#include "loc/known_junctions.h"

#include "loc/pose_view.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

constexpr float least_explained = 0.5F;  // of the seen line: below, the pose is right and the field is another one
// A branch is looked for from one to three and a half widths of line from its junction: beyond the corner's own white,
// and short of the next junction (0.4 m on a field with lines of 0.1 m).
constexpr float first_widths = 1.0F;
constexpr float last_widths = 3.5F;
constexpr int branch_samples = 6;
constexpr int least_in_picture = 2;  // of them, or nothing is known of the branch
// Working pixels, 1 sigma by the pose's covariance. The refinement has laid the lines on the picture, so that a
// junction is nearer than the covariance says, which has calibration and floor in it.
constexpr float sharp_px = 4.0F;
constexpr float gate_sigmas = 4.0F;
constexpr float rag_widths = 0.5F;  // what thinning and worn paint move a junction

/// Of a field point in the robot's frame: what the pose's covariance makes of it, m^2.
Sym2 covariance_of(const GroundPoint& g, const Pose2& pose, const PoseCovariance& p) {
  const auto [s, c] = math::sin_cos(pose.theta);
  // The point moves by -R'(dx, dy) and by dtheta times its perpendicular.
  const float xx = c * c * p.xx + 2.0F * c * s * p.xy + s * s * p.yy;
  const float xy = c * s * (p.yy - p.xx) + (c * c - s * s) * p.xy;
  const float yy = s * s * p.xx - 2.0F * c * s * p.xy + c * c * p.yy;
  const float xt = -(c * p.xt + s * p.yt);
  const float yt = -(c * p.yt - s * p.xt);
  return {xx + 2.0F * xt * g.y + p.tt * g.y * g.y, xy + yt * g.y - xt * g.x - p.tt * g.x * g.y,
          yy - 2.0F * yt * g.x + p.tt * g.x * g.x};
}

/// How many sigmas a step is long.
bool within_gate(const GroundPoint& a, const GroundPoint& b, const Sym2& covariance) {
  const float dx = a.x - b.x;
  const float dy = a.y - b.y;
  const float det = covariance.xx * covariance.yy - covariance.xy * covariance.xy;
  if (!(det > 0.0F)) return false;
  const float squared = (covariance.yy * dx * dx - 2.0F * covariance.xy * dx * dy + covariance.xx * dy * dy) / det;
  return squared <= gate_sigmas * gate_sigmas;
}

class Check {
 public:
  Check(const Field& field, const VisionResult& vision, const PoseEstimate& estimate)
      : field_(field),
        vision_(vision),
        estimate_(estimate),
        view_(vision, estimate.pose, estimate.pitch_error, estimate.roll_error) {}

  void run(KnownJunctions& out) {
    for (const FieldLandmark& landmark : field_.landmarks()) {
      Junction known;
      if (!predict(landmark, known)) continue;
      const Junction* seen = claim(known);
      const bool sharp = is_sharp(known);
      if (seen != nullptr) {
        out.list.push_back({sharp ? known : *seen, JunctionSource::both});
      } else if (sharp && all_branches_seen(landmark)) {
        out.list.push_back({known, JunctionSource::map});
      }
    }
    for (std::size_t i = 0; i < vision_.features->junctions.size(); ++i) out.turned_down += claimed_[i] ? 0 : 1;
  }

 private:
  /// The landmark as the pose has it; false where it is out of the picture, or the pose too vague to say where.
  bool predict(const FieldLandmark& landmark, Junction& known) const {
    known.type = landmark.type;
    known.ground = view_.ground(landmark.at);
    known.covariance = covariance_of(known.ground, estimate_.pose, estimate_.covariance);
    known.branches = landmark.branches;
    for (std::size_t k = 0; k < known.direction.size(); ++k) {
      if (static_cast<int>(k) < landmark.branches) {
        known.direction[k] = wrap_angle(landmark.direction[k] - estimate_.pose.theta);
      }
    }
    known.confidence = certainty(estimate_);
    return view_.camera_pixel(known.ground, known.pixel);
  }

  /// One sigma of its place is at most `sharp_px`.
  [[nodiscard]] bool is_sharp(const Junction& known) const {
    float squared = 0.0F;
    const GroundPoint steps[2] = {{math::sqrt(known.covariance.xx), 0.0F}, {0.0F, math::sqrt(known.covariance.yy)}};
    for (const GroundPoint& step : steps) {
      PixelPoint moved;
      if (!view_.projection().pixel({known.ground.x + step.x, known.ground.y + step.y}, moved)) return false;
      squared += math::square(moved.u - known.pixel.u) + math::square(moved.v - known.pixel.v);
    }
    const float pixel = static_cast<float>(vision_.frame_width) / static_cast<float>(vision_.work_width);
    return squared <= math::square(sharp_px * pixel);
  }

  /// Whether vision reports the junction. Each report is claimed once, by the first landmark in whose gate it lies.
  const Junction* claim(const Junction& known) {
    const float rag = math::square(rag_widths * field_.dimensions().line_width);
    const Junction* claimed = nullptr;
    for (std::size_t i = 0; i < vision_.features->junctions.size(); ++i) {
      const Junction& seen = vision_.features->junctions[i];
      GroundPoint at;
      if (claimed_[i] || seen.type != known.type || !view_.projection().ground(seen.pixel, at)) continue;
      const Sym2 sum{seen.covariance.xx + known.covariance.xx + rag, seen.covariance.xy + known.covariance.xy,
                     seen.covariance.yy + known.covariance.yy + rag};
      if (!within_gate(at, known.ground, sum)) continue;
      claimed_[i] = true;
      claimed = &seen;
    }
    return claimed;
  }

  [[nodiscard]] bool all_branches_seen(const FieldLandmark& landmark) const {
    for (int k = 0; k < landmark.branches; ++k) {
      if (!branch_seen(landmark, landmark.direction[k])) return false;
    }
    return true;
  }

  /// Three quarters of what lies in the picture lie in the line mask.
  [[nodiscard]] bool branch_seen(const FieldLandmark& landmark, float direction) const {
    const float width = field_.dimensions().line_width;
    const auto [s, c] = math::sin_cos(direction);
    int in_picture = 0;
    int on_line = 0;
    for (int i = 0; i < branch_samples; ++i) {
      constexpr float step = (last_widths - first_widths) / static_cast<float>(branch_samples - 1);
      const float along = width * (first_widths + step * static_cast<float>(i));
      int x = 0;
      int y = 0;
      const FieldPoint at = on_branch(landmark, {landmark.at.x + along * c, landmark.at.y + along * s}, c, s);
      if (!view_.working_pixel(view_.ground(at), x, y)) continue;
      ++in_picture;
      on_line += view_.line_near(x, y, 1) ? 1 : 0;
    }
    return in_picture >= least_in_picture && 4 * on_line >= 3 * in_picture;
  }

  /// Branches of the circle's crossings that go across the half line follow the circle.
  [[nodiscard]] FieldPoint on_branch(const FieldLandmark& landmark, const FieldPoint& p, float c, float s) const {
    const float radius = field_.dimensions().circle_radius;
    const bool bends =
        landmark.type == JunctionType::x && math::abs(landmark.at.x * c + landmark.at.y * s) < 0.5F * radius;
    if (!bends) return p;
    const float scale = radius / math::hypot(p.x, p.y);
    return {p.x * scale, p.y * scale};
  }

  const Field& field_;
  const VisionResult& vision_;
  const PoseEstimate& estimate_;
  PoseView view_;
  std::array<bool, max_junctions> claimed_{};
};

bool is_sure(const PoseEstimate& estimate, float sure) {
  return estimate.valid && certainty(estimate) >= sure && estimate.explained >= least_explained;
}

}  // namespace

const char* to_string(JunctionSource source) {
  switch (source) {
    case JunctionSource::picture: return "picture";
    case JunctionSource::both: return "both";
    case JunctionSource::map: return "map";
  }
  return "unknown source";
}

void check_junctions(const Field& field, const VisionResult& vision, const PoseEstimate& estimate, float sure,
                     KnownJunctions& out) {
  out.list.clear();
  out.turned_down = 0;
  if (is_sure(estimate, sure)) {
    Check(field, vision, estimate).run(out);
    return;
  }
  for (const Junction& junction : vision.features->junctions) out.list.push_back({junction, JunctionSource::picture});
}

}  // namespace touchline
