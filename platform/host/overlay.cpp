// SPDX-License-Identifier: Apache-2.0
// What vision found and where localization stands, drawn over the camera's picture.
#include "platform/host/overlay.h"

#include <algorithm>
#include <cmath>

#include "platform/host/field_map.h"

namespace touchline::host {
namespace {

constexpr int panel_width = 300;
constexpr int panel_height = 520;          // map, text, legend with the codes of a crowded picture
constexpr float projected_step_m = 0.05F;  // fine enough to follow a fish-eye's bend

/// Draws field points in a row, broken where the camera does not see the ground.
class ProjectedLine {
 public:
  ProjectedLine(Canvas& canvas, const GroundProjection& projection, const Pose2& pose, Colour colour)
      : canvas_(canvas), projection_(projection), pose_(pose), colour_(colour) {}
  void next(const FieldPoint& p) {
    PixelPoint pixel;
    const bool seen = projection_.pixel(to_ground(pose_, p), pixel);
    const DrawPoint at{pixel.u, pixel.v};
    if (seen && has_before_) canvas_.line(before_, at, colour_);
    before_ = at;
    has_before_ = seen;
  }
  void lift() { has_before_ = false; }

 private:
  Canvas& canvas_;
  const GroundProjection& projection_;
  Pose2 pose_;
  Colour colour_;
  DrawPoint before_{};
  bool has_before_ = false;
};

/// Finds room for texts: inside of the picture, and not over one that stands there.
class Labels {
 public:
  explicit Labels(Canvas& canvas) : canvas_(canvas) {}

  void put(int x, int y, const std::string& text, Colour colour, bool dark_ground) {
    if (text.empty()) return;
    const int width = Canvas::text_width(text) + 2;
    Box box{std::clamp(x, 0, std::max(0, canvas_.width() - width)), 0, width};
    constexpr int rows[] = {0, 1, -1, 2, -2, 3, -3, 4};  // rows down from where it belongs
    for (const int row : rows) {
      box.y = std::clamp(y + row * text_height, 0, std::max(0, canvas_.height() - text_height));
      const auto over = [&box](const Box& other) {
        return box.x < other.x + other.width && other.x < box.x + box.width && std::abs(box.y - other.y) < text_height;
      };
      if (std::none_of(taken_.begin(), taken_.end(), over)) break;
    }
    taken_.push_back(box);
    if (dark_ground) {
      canvas_.label(box.x, box.y, text, colour);
    } else {
      canvas_.text(box.x, box.y, text, colour);
    }
  }

 private:
  struct Box {
    int x, y, width;
  };
  Canvas& canvas_;
  std::vector<Box> taken_;
};

/// Four letters at most, so that a crowd of rejected candidates stays readable.
const char* short_code(JunctionRejection reason) {
  switch (reason) {
    case JunctionRejection::none: return "";
    case JunctionRejection::no_ground: return "sky";
    case JunctionRejection::too_far: return "far";
    case JunctionRejection::straight: return "str";
    case JunctionRejection::curved: return "crv";
    case JunctionRejection::branch_too_short: return "shrt";
    case JunctionRejection::bad_angles: return "ang";
    case JunctionRejection::too_many_branches: return "many";
    case JunctionRejection::at_border: return "edge";
    case JunctionRejection::bridge: return "bridge";
    case JunctionRejection::duplicate: return "dup";
  }
  return "?";
}

void draw_branches(Canvas& canvas, const GroundProjection& projection, const Junction& junction, Colour colour) {
  for (int i = 0; i < junction.branches && i < 4; ++i) {
    const float angle = junction.direction[static_cast<std::size_t>(i)];
    const GroundPoint end{junction.ground.x + 0.25F * std::cos(angle), junction.ground.y + 0.25F * std::sin(angle)};
    PixelPoint pixel;
    if (!projection.pixel(end, pixel)) continue;
    canvas.line({junction.pixel.u, junction.pixel.v}, {pixel.u, pixel.v}, colour, i == 0 ? 3 : 2);
  }
}

void draw_circle_observation(Canvas& canvas, Labels& labels, const GroundProjection& projection,
                             const CircleObservation& circle) {
  PixelPoint pixel;
  if (!projection.pixel(circle.centre, pixel)) return;
  canvas.circle({pixel.u, pixel.v}, 8.0F, colours::cyan, 2);
  labels.put(static_cast<int>(pixel.u) + 10, static_cast<int>(pixel.v) - 6, "circle", colours::cyan, true);
  if (!circle.has_half_line) return;
  for (const float side : {-0.4F, 0.4F}) {
    const GroundPoint end{circle.centre.x + side * std::cos(circle.half_line_direction),
                          circle.centre.y + side * std::sin(circle.half_line_direction)};
    PixelPoint tip;
    if (projection.pixel(end, tip)) canvas.line({pixel.u, pixel.v}, {tip.u, tip.v}, colours::cyan, 2);
  }
}

void draw_hull(Canvas& canvas, const VisionResult& vision, const WorkToCamera& to_camera) {
  std::vector<DrawPoint> corners;
  for (const auto& p : vision.hull) corners.push_back(to_camera(p));
  canvas.polyline(corners, colours::blue, 2, true);
}

/// The end of a line that is too long: of a path it tells the most.
std::string fitting(const std::string& line, int width) {
  if (Canvas::text_width(line) <= width) return line;
  std::size_t left_out = 1;
  while (left_out < line.size() && Canvas::text_width("..." + line.substr(left_out)) > width) ++left_out;
  return "..." + line.substr(left_out);
}

/// The codes beside the grey crosses of this picture, in lines that fit.
std::vector<std::string> code_lines(const Features& features, int width) {
  std::vector<JunctionRejection> told;
  std::vector<std::string> lines;
  for (const auto& candidate : features.rejections) {
    if (std::find(told.begin(), told.end(), candidate.reason) != told.end()) continue;
    told.push_back(candidate.reason);
    std::string word = std::string(short_code(candidate.reason)) + ": " + to_string(candidate.reason);
    std::replace(word.begin(), word.end(), '_', ' ');
    if (lines.empty()) lines.emplace_back("x turned down as junction:");
    if (Canvas::text_width(lines.back() + "  " + word) > width) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : "  ") + word;
  }
  return lines;
}

void draw_legend(Canvas& canvas, const OverlayInput& input, int left, int y) {
  const std::pair<const char*, Colour> entries[] = {
      {"pose, its field lines", colours::red}, {"truth", colours::cyan}, {"mirrored pose", colours::grey},
      {"particles", colours::orange},          {"ROI", colours::blue},   {"skeleton", colours::green},
      {"line points", colours::yellow}};
  int column = 0;
  for (const auto& [text, colour] : entries) {
    const int x = left + column * (panel_width - 16) / 2;
    canvas.rectangle(x, y, 9, 9, colour);
    canvas.text(x + 14, y, text, colours::white);
    y += column * text_height;
    column = 1 - column;
  }
  y += column * text_height + 6;
  for (const auto& line : code_lines(*input.vision->features, panel_width - 16)) {
    canvas.text(left, y, line, colours::white);
    y += text_height;
  }
}

void draw_panel(Canvas& canvas, const OverlayInput& input, int left) {
  FieldMap map(canvas, *input.field, left + 8, 8, panel_width - 16, 220);
  map.particles(input.particles, colours::orange);
  if (input.estimate.valid && input.estimate.has_mirror) map.pose(input.estimate.mirror, colours::grey);
  if (input.has_truth) map.pose(input.truth, colours::cyan);
  if (input.estimate.valid) map.pose(input.estimate.pose, colours::red);
  int y = 236;
  for (const auto& line : input.text) {
    canvas.text(left + 8, y, fitting(line, panel_width - 16), colours::white);
    y += text_height;
  }
  draw_legend(canvas, input, left + 8, y + 6);
}

void draw_features(Canvas& canvas, Labels& labels, const GroundProjection& projection, const Features& features,
                   bool rejected) {
  if (features.has_circle) draw_circle_observation(canvas, labels, projection, features.circle);
  for (const auto& junction : features.junctions) {
    const Colour colour = colour_of(junction.type);
    const DrawPoint at{junction.pixel.u, junction.pixel.v};
    draw_branches(canvas, projection, junction, colour);
    canvas.circle(at, 6.0F, colour, 2);
    const int percent = static_cast<int>(std::lround(junction.confidence * 100.0F));
    labels.put(static_cast<int>(at.x) + 8, static_cast<int>(at.y) - 14,
               std::string(to_string(junction.type)) + " " + std::to_string(percent), colour, true);
  }
  for (const auto& post : features.posts) {
    const DrawPoint at{post.pixel.u, post.pixel.v};
    canvas.circle(at, 7.0F, colours::yellow, 2);
    labels.put(static_cast<int>(at.x) + 8, static_cast<int>(at.y) - 4, "post", colours::yellow, true);
  }
  if (!rejected) return;
  for (const auto& candidate : features.rejections) {
    const DrawPoint at{candidate.pixel.u, candidate.pixel.v};
    canvas.cross(at, 3.0F, colours::grey);
    labels.put(static_cast<int>(at.x) + 4, static_cast<int>(at.y) - 10, short_code(candidate.reason), colours::white,
               false);
  }
}

}  // namespace

Colour colour_of(JunctionType type) {
  if (type == JunctionType::x) return colours::pink;
  return type == JunctionType::t ? colours::orange : colours::cyan;
}

void draw_projected_field(Canvas& canvas, const GroundProjection& projection, const Field& field, const Pose2& pose,
                          Colour colour) {
  ProjectedLine pen(canvas, projection, pose, colour);
  for (const auto& line : field.lines()) {
    const float length = std::hypot(line.b.x - line.a.x, line.b.y - line.a.y);
    const int steps = std::max(1, static_cast<int>(length / projected_step_m));
    for (int i = 0; i <= steps; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(steps);
      pen.next({line.a.x + t * (line.b.x - line.a.x), line.a.y + t * (line.b.y - line.a.y)});
    }
    pen.lift();
  }
  const float radius = field.dimensions().circle_radius;
  for (int i = 0; i <= 96; ++i) {
    const float angle = 6.2831853F * static_cast<float>(i) / 96.0F;
    pen.next({radius * std::cos(angle), radius * std::sin(angle)});
  }
}

void draw_features(Canvas& canvas, const GroundProjection& projection, const Features& features, bool rejected) {
  Labels labels(canvas);
  draw_features(canvas, labels, projection, features, rejected);
}

void draw_mask(Canvas& canvas, const ConstBitView& mask, const WorkToCamera& to_camera, Colour colour, float share) {
  for (int y = 0; y < canvas.height(); ++y) {
    const int row = std::min(mask.height - 1, static_cast<int>((static_cast<float>(y) + 0.5F) / to_camera.y));
    for (int x = 0; x < canvas.width(); ++x) {
      if (mask.get(static_cast<int>((static_cast<float>(x) + 0.5F) / to_camera.x), row))
        canvas.blend(x, y, colour, share);
    }
  }
}

/// A square for each junction that the field alone has told.
void draw_known(Canvas& canvas, Labels& labels, const std::vector<KnownJunction>& known) {
  constexpr float half = 6.0F;
  for (const auto& [junction, source] : known) {
    if (source != JunctionSource::map) continue;
    const Colour colour = colour_of(junction.type);
    const auto [u, v] = junction.pixel;
    const DrawPoint corner[4] = {
        {u - half, v - half}, {u + half, v - half}, {u + half, v + half}, {u - half, v + half}};
    for (std::size_t i = 0; i < 4; ++i) canvas.line(corner[i], corner[(i + 1) % 4], colour, 2);
    labels.put(static_cast<int>(u + half) + 2, static_cast<int>(v), std::string(to_string(junction.type)) + " map",
               colour, true);
  }
}

RgbImage draw_overlay(const OverlayInput& input) {
  const RgbImage& picture = *input.picture;
  const VisionResult& vision = *input.vision;
  Canvas view(picture);  // the picture alone, so that nothing runs into the panel
  const WorkToCamera to_camera(vision, picture.width, picture.height);
  draw_mask(view, vision.skeleton, to_camera, colours::green, 0.8F);
  draw_hull(view, vision, to_camera);
  for (const auto& point : vision.features->line_points)
    view.disc({point.pixel.u, point.pixel.v}, 1.5F, colours::yellow);
  if (input.estimate.valid)
    draw_projected_field(view, vision.projection, *input.field, input.estimate.pose, colours::red);
  Labels labels(view);
  draw_features(view, labels, vision.projection, *vision.features, true);
  draw_known(view, labels, input.known);
  Canvas sheet(picture.width + panel_width, std::max(picture.height, panel_height), colours::dark);
  sheet.paste(view.image(), 0, 0);
  draw_panel(sheet, input, picture.width);
  return sheet.image();
}

}  // namespace touchline::host
