// SPDX-License-Identifier: Apache-2.0
#include "platform/host/sim/expected_landmarks.h"

#include "platform/host/sim/vec.h"

namespace touchline::sim {
namespace {

const char* type_name(JunctionType type) {
  switch (type) {
    case JunctionType::x: return "X";
    case JunctionType::t: return "T";
    case JunctionType::l: return "L";
  }
  return "?";
}

/// All landmarks of a field by type, name and place.
std::vector<ExpectedLandmark> all_landmarks(const Field& field) {
  std::vector<ExpectedLandmark> all;
  const auto add = [&](const std::string& type, std::size_t number, const FieldPoint& at) {
    ExpectedLandmark mark;
    mark.type = type;
    mark.name = type + std::to_string(number);
    mark.world = at;
    all.push_back(mark);
  };
  std::size_t number = 0;
  for (const FieldLandmark& landmark : field.landmarks()) add(type_name(landmark.type), number++, landmark.at);
  const FieldDimensions& f = field.dimensions();
  if (f.penalty_mark > 0.0F) {
    add("P", 0, {-f.length * 0.5F + f.penalty_mark, 0.0F});
    add("P", 1, {f.length * 0.5F - f.penalty_mark, 0.0F});
  }
  number = 0;
  for (const FieldPoint& post : field.posts()) add("G", number++, post);
  return all;
}

bool inside(const FrameView& image, const PixelPoint& p) {
  return p.u >= 0.0F && p.v >= 0.0F && p.u < static_cast<float>(image.width) && p.v < static_cast<float>(image.height);
}

}  // namespace

std::vector<ExpectedLandmark> expected_landmarks(const Field& field, const Scene& scene, const Lens& lens,
                                                 const SimFrame& frame) {
  const GroundProjection projection(lens, frame.true_camera);
  const FieldPoint eye = to_field(frame.truth, {frame.true_camera.x, frame.true_camera.y});
  std::vector<ExpectedLandmark> seen;
  for (ExpectedLandmark mark : all_landmarks(field)) {
    const GroundPoint at = to_ground(frame.truth, mark.world);
    mark.range = length(at.x, at.y);
    mark.bearing = math::atan2(at.y, at.x);
    if (mark.range > farthest_landmark || !projection.pixel(at, mark.px) || !inside(frame.image, mark.px)) continue;
    FieldPoint target = mark.world;
    if (mark.type == "G") {  // the side of the foot that faces the camera
      const float away = math::max(length(eye.x - target.x, eye.y - target.y), 1e-3F);
      const float radius = field.dimensions().post_diameter * 0.5F;
      target = {target.x + (eye.x - target.x) * radius / away, target.y + (eye.y - target.y) * radius / away};
      if (!projection.pixel(to_ground(frame.truth, target), mark.front_foot_px)) mark.front_foot_px = mark.px;
    }
    Vec3 ray;
    if (lens.ray(mark.px, ray)) mark.theta = math::acos(ray.z);
    mark.occluded = scene.occluded({eye.x, eye.y, frame.true_camera.height}, {target.x, target.y, 0.0F});
    seen.push_back(mark);
  }
  return seen;
}

}  // namespace touchline::sim
