// SPDX-License-Identifier: Apache-2.0
// Every stage of the chain on one sheet.
#include "platform/host/contact_sheet.h"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "platform/host/canvas.h"
#include "platform/host/field_map.h"
#include "platform/host/overlay.h"
#include "vision/image/contour.h"

namespace touchline::host {
namespace {

constexpr int columns = 3;
constexpr int caption_height = 30;
constexpr int gap = 8;

/// The working image in colour: YCbCr, full range (BT.601, as JPEG).
RgbImage mean_picture(const ConstYuv420View& mean) {
  RgbImage out(mean.y.width, mean.y.height);
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const auto luma = static_cast<float>(mean.y.at(x, y));
      const float cb = static_cast<float>(mean.cb.at(x / 2, y / 2)) - 128.0F;
      const float cr = static_cast<float>(mean.cr.at(x / 2, y / 2)) - 128.0F;
      const auto byte = [](float v) { return static_cast<std::uint8_t>(std::clamp(v + 0.5F, 0.0F, 255.0F)); };
      auto* p = out.at(x, y);
      p[0] = byte(luma + 1.402F * cr);
      p[1] = byte(luma - 0.344136F * cb - 0.714136F * cr);
      p[2] = byte(luma + 1.772F * cb);
    }
  }
  return out;
}

/// Without interpolation: working pixels stay visible as blocks.
RgbImage stretched(const RgbImage& picture, int width, int height) {
  RgbImage out(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::copy_n(picture.at(x * picture.width / width, y * picture.height / height), 3, out.at(x, y));
    }
  }
  return out;
}

Canvas dimmed(const RgbImage& picture, float share) {
  Canvas canvas(picture);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) canvas.blend(x, y, colours::black, share);
  }
  return canvas;
}

class Sheet {
 public:
  explicit Sheet(const ContactSheetInput& input)
      : input_(input),
        vision_(*input.vision),
        width_(input.picture->width),
        height_(input.picture->height),
        to_camera_(vision_, width_, height_),
        mean_(stretched(mean_picture(vision_.mean), width_, height_)),
        canvas_(columns * (width_ + gap) + gap, 3 * (height_ + caption_height + gap) + gap, colours::dark) {}

  RgbImage draw() {
    place("1A  camera frame", Canvas(*input_.picture));
    place("1B  green contour (red), convex hull (blue)", contour());
    place("1C  region of interest", masked(vision_.roi, mean_));
    place("2A  line candidates in the region of interest", candidates());
    place("2B  skeleton of the line mask", skeleton());
    place("2C  node graph: nodes, features, edge ends", graph());
    place("3A  features, and what was turned down", features());
    place("3B  field with particles and the pose (black)", map());
    place("    green mask, line mask (white)", masks());
    return canvas_.image();
  }

 private:
  void place(const std::string& caption, const Canvas& tile) {
    const int x = gap + (placed_ % columns) * (width_ + gap);
    const int y = gap + (placed_ / columns) * (height_ + caption_height + gap);
    canvas_.text(x + 2, y + 6, caption, colours::white, 2);
    canvas_.paste(tile.image(), x, y + caption_height);
    ++placed_;
  }

  Canvas contour() const {
    Canvas tile(mean_);
    tile.polyline(outline(vision_.field), colours::red, 2, true);
    tile.polyline(in_camera(vision_.hull), colours::blue, 3, true);
    return tile;
  }
  std::vector<DrawPoint> in_camera(std::span<const GridPoint> points) const {
    std::vector<DrawPoint> drawn;
    for (const auto& p : points) drawn.push_back(to_camera_(p));
    return drawn;
  }
  /// Of a mask that is one blob, or empty.
  std::vector<DrawPoint> outline(const ConstBitView& blob) const {
    for (int y = 0; y < blob.height; ++y) {
      for (int x = 0; x < blob.width; ++x) {
        if (!blob.get(x, y)) continue;
        std::vector<GridPoint> corners(static_cast<std::size_t>(blob.width * blob.height));
        const Contour contour =
            trace_contour(blob, {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)}, corners);
        return in_camera(std::span<const GridPoint>(corners).first(static_cast<std::size_t>(contour.points)));
      }
    }
    return {};
  }
  Canvas masked(const ConstBitView& mask, const RgbImage& picture) const {
    Canvas tile(width_, height_, colours::black);
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        if (!mask.get(x * mask.width / width_, y * mask.height / height_)) continue;
        const auto* p = picture.at(x, y);
        tile.set(x, y, {p[0], p[1], p[2]});
      }
    }
    return tile;
  }
  Canvas candidates() const {
    Canvas tile = masked(vision_.roi, mean_);
    draw_mask(tile, vision_.candidates, to_camera_, colours::blue, 1.0F);
    return tile;
  }
  Canvas skeleton() const {
    Canvas tile(width_, height_, colours::black);
    draw_mask(tile, vision_.skeleton, to_camera_, colours::white, 1.0F);
    return tile;
  }
  Canvas graph() const {
    Canvas tile = dimmed(mean_, 0.35F);
    for (const auto& edge : vision_.graph.edges) {
      std::vector<DrawPoint> line;
      for (const auto& p : vision_.graph.polyline(edge)) line.push_back(to_camera_(p));
      tile.polyline(line, colours::white, 2);
      if (line.empty()) continue;
      tile.disc(line.front(), 3.0F, colours::yellow);
      tile.disc(line.back(), 3.0F, colours::yellow);
    }
    for (const auto& node : vision_.major_nodes) tile.circle(to_camera_(node.at), 5.0F, colours::blue, 2);
    for (const auto& junction : vision_.features->junctions) {
      tile.circle({junction.pixel.u, junction.pixel.v}, 10.0F, colours::pink, 3);
    }
    return tile;
  }
  Canvas features() const {
    Canvas tile(*input_.picture);
    if (input_.estimate.valid) {
      draw_projected_field(tile, vision_.projection, *input_.field, input_.estimate.pose, colours::red);
    }
    draw_features(tile, vision_.projection, *vision_.features, true);
    return tile;
  }
  Canvas map() const {
    Canvas tile(width_, height_, colours::grey);
    FieldMap field(tile, *input_.field, 4, 4, width_ - 8, height_ - 8);
    field.particles(input_.particles, colours::black, 3.0F);
    if (input_.estimate.valid) field.pose(input_.estimate.pose, colours::black, 0.08F);
    return tile;
  }
  Canvas masks() const {
    Canvas tile(width_, height_, colours::black);
    draw_mask(tile, vision_.green, to_camera_, colours::carpet, 1.0F);
    draw_mask(tile, vision_.line_mask, to_camera_, colours::white, 1.0F);
    return tile;
  }

  const ContactSheetInput& input_;
  const VisionResult& vision_;
  int width_;
  int height_;
  WorkToCamera to_camera_;
  RgbImage mean_;
  Canvas canvas_;
  int placed_ = 0;
};

}  // namespace

RgbImage draw_contact_sheet(const ContactSheetInput& input) { return Sheet(input).draw(); }

}  // namespace touchline::host
