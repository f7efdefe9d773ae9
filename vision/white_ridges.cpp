// SPDX-License-Identifier: Apache-2.0
// White search, far and worn lines: what stands out from the green on both sides, eight pixels at once.
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

#include "vision/image/bit_ops.h"
#include "vision/white_search.h"

namespace touchline {
namespace {

constexpr std::int32_t magnitude(std::int32_t v) { return v < 0 ? -v : v; }

/// Steps to both sides at which a line of the block's width is left behind, whatever its slant: from the right angle to
/// 45 degrees in the image. One and a half pixels more for the blur.
struct Reaches {
  std::array<int, 3> px{};
  int count = 0;
};
Reaches reaches_for(std::uint16_t across, std::uint16_t slanted) {
  Reaches reaches;
  if (slanted == 0) return reaches;
  const auto narrow = std::min(across, slanted);
  const int candidates[3] = {(narrow * 19 / 16 + 32) / 16, ((narrow + slanted) / 2 + 32) / 16, (slanted + 32) / 16};
  for (const int reach : candidates) {
    if (reach > max_ridge_px + 2) break;
    if (reaches.count > 0 && reaches.px[static_cast<std::size_t>(reaches.count - 1)] == reach) continue;
    reaches.px[static_cast<std::size_t>(reaches.count++)] = reach;
  }
  return reaches;
}

/// Eight bytes of 0 or 1 to eight bits; the multiplication moves byte i, at bit 8 i, to bit 56 + i.
unsigned pack_eight_flags(const std::uint8_t* flags) {
  std::uint64_t eight = 0;
  std::memcpy(&eight, flags, sizeof eight);
  return static_cast<unsigned>((eight * 0x0102040810204080U) >> 56);
}

/// Which of eight neighbouring pixels stand out from both sides, a bit each.
struct Ridge8 {
  unsigned weak = 0;
  unsigned strong = 0;
};

/// `p` points to the first pixel, `along` leads to the side, `beside` to the neighbours that smooth it, across the
/// scan. Lumas are sums of weight 4. Written as plain loops of eight for the compiler to vectorise.
Ridge8 brighter_than_sides(const std::uint8_t* p, std::ptrdiff_t along, std::ptrdiff_t beside,
                           std::uint16_t weak_margin, std::uint16_t strong_margin) {
  constexpr int n = width_block_px;
  std::array<std::uint16_t, n> here;
  std::array<std::uint16_t, n> side;
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    here[k] = static_cast<std::uint16_t>(p[i - beside] + 2 * p[i] + p[i + beside]);
    const auto before = static_cast<std::uint16_t>(p[i - along - beside] + 2 * p[i - along] + p[i - along + beside]);
    const auto after = static_cast<std::uint16_t>(p[i + along - beside] + 2 * p[i + along] + p[i + along + beside]);
    side[k] = std::max(before, after);
    side[k] = static_cast<std::uint16_t>(side[k] + side[k] / 16);
  }
  std::array<std::uint8_t, n> weak;
  std::array<std::uint8_t, n> strong;
  for (std::size_t k = 0; k < n; ++k) {
    weak[k] = here[k] > static_cast<std::uint16_t>(side[k] + weak_margin) ? 1 : 0;
    strong[k] = here[k] > static_cast<std::uint16_t>(side[k] + strong_margin) ? 1 : 0;
  }
  return {pack_eight_flags(weak.data()), pack_eight_flags(strong.data())};
}

/// Eight bits of a mask's row from x on; x is a multiple of eight.
unsigned eight_bits(ConstBitView mask, int x, int y) {
  return static_cast<unsigned>(mask.row(y)[x / bits_per_word] >> (x % bits_per_word)) & 0xFFU;
}
void set_eight_bits(BitView mask, int x, int y, unsigned bits) {
  mask.row(y)[x / bits_per_word] |= static_cast<BitWord>(bits) << (x % bits_per_word);
}
/// Pixels first <= x < end of the eight from x0 on.
unsigned lanes(int x0, int first, int end) {
  const int from = std::clamp(first - x0, 0, 8);
  const int to = std::clamp(end - x0, 0, 8);
  return to <= from ? 0U : ((1U << to) - 1U) & ~((1U << from) - 1U);
}

class RidgeSearch {
 public:
  RidgeSearch(const ConstYuv420View& image, ConstBitView roi, ConstBitView green, const CarpetModel& carpet,
              BitView strong, BitView weak)
      : image_(image), roi_(roi), green_(green), carpet_(carpet), strong_(strong), weak_(weak) {
    // The difference of two sums of weight 4 has sqrt(12) of the noise of one luma: 3 and 1.5 sigma, and one grey
    // level.
    strong_margin_ = static_cast<std::uint16_t>(carpet.noise * 2 / 3 + 4);
    weak_margin_ = static_cast<std::uint16_t>(carpet.noise / 3 + 4);
  }

  /// One block of the width table: all its pixels share the reaches.
  void search_block(int block_x, int block_y, const LineWidth& width) const {
    const Reaches along_row = reaches_for(width.across_row, width.slanted);
    const Reaches along_column = reaches_for(width.across_column, width.slanted);
    const int x0 = block_x * width_block_px;
    const int y0 = std::max(block_y * width_block_px, 1);
    const int y1 = std::min(block_y * width_block_px + width_block_px, roi_.height - 1);
    for (int y = y0; y < y1; ++y) {
      const unsigned wanted = eight_bits(roi_, x0, y) & lanes(x0, 1, roi_.width - 1);
      if (wanted == 0) continue;
      Ridge8 found;
      for (int k = 0; k < along_row.count; ++k) {
        const int reach = along_row.px[static_cast<std::size_t>(k)];
        add(found, look(x0, y, reach, 0, wanted & lanes(x0, reach, roi_.width - reach) & ~found.strong));
      }
      for (int k = 0; k < along_column.count; ++k) {
        const int reach = along_column.px[static_cast<std::size_t>(k)];
        if (y - reach < 1 || y + reach >= roi_.height - 1) continue;
        add(found, look(x0, y, 0, reach, wanted & ~found.strong));
      }
      set_eight_bits(strong_, x0, y, found.strong);
      set_eight_bits(weak_, x0, y, found.weak);
    }
  }

 private:
  static void add(Ridge8& sum, const Ridge8& more) {
    sum.weak |= more.weak;
    sum.strong |= more.strong;
  }

  /// Brighter by luma first, for eight at once; few are left for the colour.
  [[nodiscard]] Ridge8 look(int x0, int y, int dx, int dy, unsigned wanted) const {
    if (wanted == 0) return {};
    const std::ptrdiff_t stride = image_.y.stride;
    Ridge8 ridge =
        brighter_than_sides(image_.y.row(y) + x0, dx + dy * stride, dx != 0 ? stride : 1, weak_margin_, strong_margin_);
    ridge.weak &= wanted;
    for (unsigned left = ridge.weak; left != 0; left &= left - 1) {
      const int x = x0 + std::countr_zero(left);
      if (!green_.get(x - dx, y - dy) || !green_.get(x + dx, y + dy) || !whiter(x, y, x - dx, y - dy) ||
          !whiter(x, y, x + dx, y + dy)) {
        ridge.weak &= ~(left & (0U - left));
      }
    }
    ridge.strong &= ridge.weak;
    return ridge;
  }

  /// Chroma over luma, compared without a division: at least an eighth less green than the side, and not more of any
  /// colour: a yellow post is brighter and less green than the carpet, but no line.
  [[nodiscard]] bool whiter(int x, int y, int side_x, int side_y) const {
    const std::int32_t luma = image_.y.at(x, y);
    const std::int32_t side_luma = image_.y.at(side_x, side_y);
    return greenness(x, y) * side_luma * 8 < greenness(side_x, side_y) * luma * 7 &&
           chroma(x, y) * side_luma < chroma(side_x, side_y) * luma;
  }
  [[nodiscard]] std::int32_t greenness(int x, int y) const {
    return (image_.cb.at(x / 2, y / 2) - 128) * carpet_.axis_cb + (image_.cr.at(x / 2, y / 2) - 128) * carpet_.axis_cr;
  }
  [[nodiscard]] std::int32_t chroma(int x, int y) const {
    return magnitude(image_.cb.at(x / 2, y / 2) - 128) + magnitude(image_.cr.at(x / 2, y / 2) - 128);
  }

  const ConstYuv420View& image_;
  ConstBitView roi_;
  ConstBitView green_;
  const CarpetModel& carpet_;
  BitView strong_;
  BitView weak_;
  std::uint16_t strong_margin_ = 0;
  std::uint16_t weak_margin_ = 0;
};

}  // namespace

GrowResult find_white_ridges(const ConstYuv420View& image, ConstBitView roi, ConstBitView green, LineWidthView widths,
                             const CarpetModel& carpet, BitView lines, BitView scratch) {
  if (carpet.samples == 0) return {};
  copy(lines, scratch);
  const RidgeSearch search(image, roi, green, carpet, lines, scratch);
  for (int by = 0; by < widths.height; ++by) {
    for (int bx = 0; bx < widths.width; ++bx) search.search_block(bx, by, widths.at(bx, by));
  }
  return grow_inside(lines, scratch);
}

}  // namespace touchline
