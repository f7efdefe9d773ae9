// SPDX-License-Identifier: Apache-2.0
#include "vision/image/moments.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "vision/image/kernels.h"

namespace touchline {
namespace {

/// A window of up to 32 columns of a mask; bits outside the image are zero. A word of 32 bits is what a register of a
/// small processor takes.
class BitWindow {
 public:
  BitWindow(ConstBitView mask, int first, int n) : mask_(mask) {
    const int from = std::max(first, 0);
    left_ = from / 32 * 4;
    right_ = from / 32 * 32 + 32 < mask.width ? left_ + 4 : left_;
    inside_left_ = from < mask.width ? ~std::uint32_t{0} : 0;
    inside_right_ = right_ != left_ && from % 32 != 0 ? ~std::uint32_t{0} : 0;
    if (inside_left_ == 0) left_ = right_ = 0;
    down_ = from % 32;
    up_ = (32 - down_) % 32;
    before_ = from - first;
    window_ = ~std::uint32_t{0} >> (32 - n);
  }
  [[nodiscard]] std::uint32_t row(int y) const {
    const auto* bytes = reinterpret_cast<const unsigned char*>(mask_.row(y));
    const std::uint32_t left = load(bytes + left_) & inside_left_;
    const std::uint32_t right = load(bytes + right_) & inside_right_;
    return ((left >> down_ | right << up_) << before_) & window_;
  }

 private:
  static std::uint32_t load(const unsigned char* from) {
    std::uint32_t word = 0;
    std::memcpy(&word, from, sizeof word);
    return word;
  }
  ConstBitView mask_;
  int left_, right_;  // bytes
  std::uint32_t inside_left_, inside_right_, window_;
  int down_, up_, before_;
};

Moments count_moments(ConstBitView mask, GridPoint at, int radius) {
  Moments m;
  const BitWindow window(mask, at.x - radius, 2 * radius + 1);
  for (int dy = std::max(-radius, -at.y); dy <= std::min(radius, mask.height - 1 - at.y); ++dy) {
    std::int32_t n = 0, x = 0;
    for (std::uint32_t left = window.row(at.y + dy); left != 0; left &= left - 1) {
      const int dx = std::countr_zero(left) - radius;
      ++n;
      x += dx;
      m.xx += dx * dx;
    }
    m.n += n;
    m.x += x;
    m.y += n * dy;
    m.xy += x * dy;
    m.yy += n * dy * dy;
  }
  return m;
}

}  // namespace

bool make_window(ConstBitView mask, GridPoint at, WindowColumns columns, int radius, MomentWindow& window) {
  const int left = at.x + columns.first;
  const int row_bytes = words_for(mask.width) * bits_per_word / 8;
  if (left < 0 || left / 8 + 4 > row_bytes) return false;
  if (at.y < radius || at.y + radius >= mask.height) return false;
  const auto* row = reinterpret_cast<const std::uint8_t*>(mask.row(at.y - radius));
  window = {row + left / 8, reinterpret_cast<const std::uint8_t*>(mask.row(at.y - radius + 1)) - row, left % 8,
            columns.count, radius};
  return true;
}

Moments moments_around(ConstBitView mask, GridPoint at, int radius, const Kernels& kernels) {
  if (kernels.window_moments == nullptr) return count_moments(mask, at, radius);
  const WindowParts parts = parts_of(radius);
  Moments sum;
  for (int k = 0; k < parts.count; ++k) {
    const WindowColumns& columns = parts.part[static_cast<std::size_t>(k)];
    MomentWindow window;
    if (!make_window(mask, at, columns, radius, window)) return count_moments(mask, at, radius);
    Moments m;
    kernels.window_moments(window, m);
    sum = sum + moved(m, columns.middle());
  }
  return sum;
}

}  // namespace touchline
