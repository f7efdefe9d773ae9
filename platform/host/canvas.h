// SPDX-License-Identifier: Apache-2.0
// Drawing into an RGB picture: points, lines, circles, text. Everything is cut off at the picture's edge. For pictures
// that people look at; no result depends on it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "platform/host/image_file.h"

namespace touchline::host {

struct Colour {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
};
namespace colours {
inline constexpr Colour black{0, 0, 0}, white{255, 255, 255}, grey{128, 128, 128}, dark{40, 44, 48};
inline constexpr Colour red{235, 40, 40}, green{40, 200, 60}, blue{40, 90, 255}, yellow{255, 225, 30};
inline constexpr Colour orange{255, 150, 20}, pink{255, 90, 190}, cyan{40, 220, 230}, carpet{36, 120, 52};
}  // namespace colours

/// A place in the picture, continuous: the centre of pixel (i, j) is (i + 0.5, j + 0.5).
struct DrawPoint {
  float x = 0.0F;
  float y = 0.0F;
};

inline constexpr int text_height = 12;  // pixels a line of text takes at scale 1

class Canvas {
 public:
  Canvas(int width, int height, Colour background);
  explicit Canvas(RgbImage image);

  [[nodiscard]] int width() const { return image_.width; }
  [[nodiscard]] int height() const { return image_.height; }
  [[nodiscard]] const RgbImage& image() const { return image_; }

  void set(int x, int y, Colour colour);
  /// `share` of the colour over what is there, 0..1.
  void blend(int x, int y, Colour colour, float share);
  void rectangle(int x, int y, int width, int height, Colour colour);
  void line(DrawPoint a, DrawPoint b, Colour colour, int thickness = 1);
  void polyline(std::span<const DrawPoint> points, Colour colour, int thickness = 1, bool closed = false);
  void circle(DrawPoint centre, float radius, Colour colour, int thickness = 1);
  void disc(DrawPoint centre, float radius, Colour colour);
  void cross(DrawPoint centre, float radius, Colour colour, int thickness = 1);
  void arrow(DrawPoint from, DrawPoint to, Colour colour, int thickness = 1);
  /// The top-left corner of the text is at (x, y). Printable ASCII; other characters are left out.
  void text(int x, int y, const std::string& text, Colour colour, int scale = 1);
  /// Text on a dark ground, readable on any picture.
  void label(int x, int y, const std::string& text, Colour colour, int scale = 1);
  /// Copies `picture` so that its top-left corner is at (x, y), enlarged by a whole factor.
  void paste(const RgbImage& picture, int x, int y, int factor = 1);

  static int text_width(const std::string& text, int scale = 1);

 private:
  RgbImage image_;
};

}  // namespace touchline::host
