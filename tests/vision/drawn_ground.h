// SPDX-License-Identifier: Apache-2.0
// Field lines drawn on the ground, seen through a lens as a mask of the working image, thinned and made a node graph:
// the input of the stages that measure on the ground, without any colour.
#pragma once

#include <memory>
#include <vector>

#include "tests/support/ascii_image.h"
#include "vision/circle.h"
#include "vision/graph_storage.h"
#include "vision/junctions.h"
#include "vision/line_segments.h"
#include "vision/work_rays.h"

namespace touchline::test {

struct DrawnLine {
  GroundPoint a, b;  // robot's frame, metres; between the centres of lines
};
struct DrawnCircle {
  GroundPoint centre;
  float radius = 0.5F;
  float from = -10.0F, to = 10.0F;  // drawn where the angle about the centre is between, radians
};

/// A 752x480 camera with a 185 degree equidistant lens, 0.58 m high, looking 30 degrees down.
struct Scene {
  float line_width = 0.10F;
  float pitch_deg = 30.0F;
  float roll_deg = 0.0F;
  std::vector<DrawnLine> lines;
  std::vector<DrawnCircle> circles;
};

/// Everything that the stages made of a scene.
struct Seen {
  explicit Seen(const Scene& scene, float circle_radius = 0.0F);

  Bits mask, skeleton, carpet;
  std::vector<Vec3> grid;
  GroundProjection projection;
  std::unique_ptr<WorkRays> rays;
  std::unique_ptr<GraphStorage<320, 240>> storage = std::make_unique<GraphStorage<320, 240>>();
  NodeGraphResult graph;
  std::unique_ptr<LineSegments> lines = std::make_unique<LineSegments>();
  CircleWork circle_work;
  std::unique_ptr<JunctionWork> junction_work = std::make_unique<JunctionWork>();
  std::unique_ptr<Features> features = std::make_unique<Features>();

  [[nodiscard]] int count(JunctionType type) const;
  /// The junction of that type nearest to a point; null when there is none within 0.3 m.
  [[nodiscard]] const Junction* nearest(JunctionType type, const GroundPoint& p) const;
  /// Distance in camera pixels.
  [[nodiscard]] float pixels_off(const Junction& j, const GroundPoint& truth) const;
  [[nodiscard]] bool rejected(JunctionRejection reason, const GroundPoint& near) const;
};

}  // namespace touchline::test
