// SPDX-License-Identifier: Apache-2.0
// Drawing into an RGB picture. The letters are stb_easy_font's (public domain): rectangles, no bitmap.
#include "platform/host/canvas.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <stb/stb_easy_font.h>

namespace touchline::host {
namespace {

struct FontVertex {  // the layout that stb_easy_font writes
  float x, y, z;
  unsigned char rgba[4];
};

std::vector<FontVertex> text_quads(const std::string& text) {
  std::string copy = text;
  std::vector<FontVertex> vertices(copy.size() * 64 + 64);
  const auto bytes = static_cast<int>(vertices.size() * sizeof(FontVertex));
  const int quads = stb_easy_font_print(0.0F, 0.0F, copy.data(), nullptr, vertices.data(), bytes);
  vertices.resize(static_cast<std::size_t>(quads) * 4);
  return vertices;
}

int floor_int(float v) { return static_cast<int>(std::floor(std::clamp(v, -1e6F, 1e6F))); }

bool finite(DrawPoint p) { return std::isfinite(p.x) && std::isfinite(p.y); }

/// Cuts the segment to the box by Liang-Barsky; false when nothing is left. So a point far away costs nothing.
bool clip(DrawPoint& a, DrawPoint& b, float width, float height, float margin) {
  float t0 = 0.0F;
  float t1 = 1.0F;
  const float dx = b.x - a.x;
  const float dy = b.y - a.y;
  const float p[4] = {-dx, dx, -dy, dy};
  const float q[4] = {a.x + margin, width + margin - a.x, a.y + margin, height + margin - a.y};
  for (int i = 0; i < 4; ++i) {
    if (p[i] == 0.0F) {
      if (q[i] < 0.0F) return false;
      continue;
    }
    const float t = q[i] / p[i];
    if (p[i] < 0.0F) {
      t0 = std::max(t0, t);
    } else {
      t1 = std::min(t1, t);
    }
  }
  if (t0 > t1) return false;
  b = {a.x + t1 * dx, a.y + t1 * dy};
  a = {a.x + t0 * dx, a.y + t0 * dy};
  return true;
}

}  // namespace

Canvas::Canvas(int width, int height, Colour background) : image_(width, height) {
  rectangle(0, 0, width, height, background);
}
Canvas::Canvas(RgbImage image) : image_(std::move(image)) {}

void Canvas::set(int x, int y, Colour colour) {
  if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
  auto* p = image_.at(x, y);
  p[0] = colour.r;
  p[1] = colour.g;
  p[2] = colour.b;
}

void Canvas::blend(int x, int y, Colour colour, float share) {
  if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
  auto* p = image_.at(x, y);
  const auto mix = [share](std::uint8_t old, std::uint8_t added) {
    return static_cast<std::uint8_t>(
        std::lround(static_cast<float>(old) * (1.0F - share) + static_cast<float>(added) * share));
  };
  p[0] = mix(p[0], colour.r);
  p[1] = mix(p[1], colour.g);
  p[2] = mix(p[2], colour.b);
}

void Canvas::rectangle(int x, int y, int width, int height, Colour colour) {
  for (int j = std::max(0, y); j < std::min(image_.height, y + height); ++j) {
    for (int i = std::max(0, x); i < std::min(image_.width, x + width); ++i) set(i, j, colour);
  }
}

void Canvas::line(DrawPoint a, DrawPoint b, Colour colour, int thickness) {
  if (!finite(a) || !finite(b)) return;
  const auto half = static_cast<float>(thickness) * 0.5F;
  if (!clip(a, b, static_cast<float>(width()), static_cast<float>(height()), half + 1.0F)) return;
  const float length = std::max(std::abs(b.x - a.x), std::abs(b.y - a.y));
  const int steps = std::max(1, static_cast<int>(std::ceil(length)));
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    const float x = a.x + t * (b.x - a.x);
    const float y = a.y + t * (b.y - a.y);
    if (thickness <= 1) {
      set(floor_int(x), floor_int(y), colour);
    } else {
      rectangle(floor_int(x - half + 0.5F), floor_int(y - half + 0.5F), thickness, thickness, colour);
    }
  }
}

void Canvas::polyline(std::span<const DrawPoint> points, Colour colour, int thickness, bool closed) {
  for (std::size_t i = 1; i < points.size(); ++i) line(points[i - 1], points[i], colour, thickness);
  if (closed && points.size() > 2) line(points.back(), points.front(), colour, thickness);
}

void Canvas::circle(DrawPoint centre, float radius, Colour colour, int thickness) {
  const int corners = std::clamp(static_cast<int>(radius * 2.0F) + 12, 12, 180);
  DrawPoint before{centre.x + radius, centre.y};
  for (int i = 1; i <= corners; ++i) {
    const float angle = 6.2831853F * static_cast<float>(i) / static_cast<float>(corners);
    const DrawPoint next{centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
    line(before, next, colour, thickness);
    before = next;
  }
}

void Canvas::disc(DrawPoint centre, float radius, Colour colour) {
  if (!finite(centre)) return;
  for (int y = floor_int(centre.y - radius); y <= floor_int(centre.y + radius); ++y) {
    for (int x = floor_int(centre.x - radius); x <= floor_int(centre.x + radius); ++x) {
      const float dx = static_cast<float>(x) + 0.5F - centre.x;
      const float dy = static_cast<float>(y) + 0.5F - centre.y;
      if (dx * dx + dy * dy <= radius * radius) set(x, y, colour);
    }
  }
}

void Canvas::cross(DrawPoint centre, float radius, Colour colour, int thickness) {
  line({centre.x - radius, centre.y - radius}, {centre.x + radius, centre.y + radius}, colour, thickness);
  line({centre.x - radius, centre.y + radius}, {centre.x + radius, centre.y - radius}, colour, thickness);
}

void Canvas::arrow(DrawPoint from, DrawPoint to, Colour colour, int thickness) {
  line(from, to, colour, thickness);
  const float dx = to.x - from.x;
  const float dy = to.y - from.y;
  const float length = std::hypot(dx, dy);
  if (!(length > 0.0F)) return;
  const float head = std::min(length * 0.5F, 5.0F + 2.0F * static_cast<float>(thickness));
  const float ux = dx / length * head;
  const float uy = dy / length * head;
  line(to, {to.x - ux - 0.6F * uy, to.y - uy + 0.6F * ux}, colour, thickness);
  line(to, {to.x - ux + 0.6F * uy, to.y - uy - 0.6F * ux}, colour, thickness);
}

void Canvas::text(int x, int y, const std::string& text, Colour colour, int scale) {
  const auto vertices = text_quads(text);
  const auto s = static_cast<float>(scale);
  for (std::size_t i = 0; i + 3 < vertices.size(); i += 4) {
    const auto& a = vertices[i];
    const auto& b = vertices[i + 2];
    const int left = static_cast<int>(a.x * s);
    const int top = static_cast<int>(a.y * s);
    rectangle(x + left, y + top, static_cast<int>(b.x * s) - left, static_cast<int>(b.y * s) - top, colour);
  }
}

void Canvas::label(int x, int y, const std::string& text, Colour colour, int scale) {
  rectangle(x - 2, y - 2, text_width(text, scale) + 4, (text_height - 1) * scale + 2, colours::dark);
  this->text(x, y, text, colour, scale);
}

void Canvas::paste(const RgbImage& picture, int x, int y, int factor) {
  for (int j = 0; j < picture.height * factor; ++j) {
    for (int i = 0; i < picture.width * factor; ++i) {
      const auto* p = picture.at(i / factor, j / factor);
      set(x + i, y + j, {p[0], p[1], p[2]});
    }
  }
}

int Canvas::text_width(const std::string& text, int scale) {
  std::string copy = text;
  return stb_easy_font_width(copy.data()) * scale;
}

}  // namespace touchline::host
