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

static_assert(width_block_px == ridge_block_px && max_ridge_px + 2 <= max_ridge_reach_px);

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

/// Eight rows of eight bits of a mask from (x, y) on, wherever that is: bit 8 y + x; zero beyond the image.
BitWord border_block_bits(ConstBitView mask, int x, int y) {
  if (x <= -8 || x >= mask.width) return 0;
  const int byte = x < 0 ? -1 : x / 8;
  const int shift = x - 8 * byte;
  const bool has_left = byte >= 0;
  const bool has_right = shift != 0 && 8 * (byte + 1) < mask.width;
  std::uint8_t rows[ridge_block_px] = {};
  const int first = std::max(-y, 0);
  const int end = std::min(mask.height - y, ridge_block_px);
  for (int r = first; r < end; ++r) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(mask.row(y + r)) + byte;
    unsigned bits = has_left ? bytes[0] : 0U;
    if (has_right) bits |= static_cast<unsigned>(bytes[1]) << 8U;
    rows[r] = static_cast<std::uint8_t>(bits >> shift);
  }
  BitWord all = 0;
  std::memcpy(&all, rows, sizeof all);
  return all;
}
BitWord block_bits(ConstBitView mask, int x, int y) {
  const int byte = static_cast<int>(static_cast<unsigned>(x) / 8U);
  const auto row_bytes = mask.stride * static_cast<int>(sizeof(BitWord));
  if (x < 0 || byte + 1 >= row_bytes || y < 0 || y + ridge_block_px > mask.height) return border_block_bits(mask, x, y);
  const auto* bytes = reinterpret_cast<const unsigned char*>(mask.row(y)) + byte;
  const unsigned shift = static_cast<unsigned>(x) % 8U;
  std::uint32_t halves[2] = {};
  for (int r = 0; r < ridge_block_px; ++r, bytes += row_bytes) {
    std::uint16_t two = 0;
    std::memcpy(&two, bytes, sizeof two);
    halves[r / 4] |= (static_cast<std::uint32_t>(two) >> shift & 0xFFU) << (r % 4 * 8);
  }
  return BitWord{halves[0]} | BitWord{halves[1]} << 32;
}
/// x and y are multiples of eight.
void add_block(BitView mask, int x, int y, BitWord bits) {
  std::uint8_t rows[ridge_block_px];
  std::memcpy(rows, &bits, sizeof rows);
  for (int r = 0; r < ridge_block_px && y + r < mask.height; ++r) {
    unsigned char& eight = reinterpret_cast<unsigned char*>(mask.row(y + r))[x / 8];
    eight = static_cast<unsigned char>(eight | rows[r]);
  }
}
/// Pixels first <= x < end of the eight from x0 on.
unsigned lanes(int x0, int first, int end) {
  const int from = std::clamp(first - x0, 0, 8);
  const int to = std::clamp(end - x0, 0, 8);
  return to <= from ? 0U : ((1U << to) - 1U) & ~((1U << from) - 1U);
}
/// Pixels of a block at (x0, y0) with `inside_x` pixels to the left and the right of them, and `inside_y` above and
/// below.
BitWord inner_block(ConstBitView mask, int x0, int y0, int inside_x, int inside_y) {
  if (x0 >= inside_x && x0 + ridge_block_px + inside_x <= mask.width && y0 >= inside_y &&
      y0 + ridge_block_px + inside_y <= mask.height) {
    return ~BitWord{0};
  }
  const BitWord columns = BitWord{lanes(x0, inside_x, mask.width - inside_x)} * 0x0101010101010101U;
  const unsigned rows = lanes(y0, inside_y, mask.height - inside_y);
  BitWord bits = 0;
  for (int r = 0; r < ridge_block_px; ++r) bits |= ((rows >> r) & 1U) != 0 ? BitWord{0xFF} << (8 * r) : 0;
  return columns & bits;
}

class RidgeSearch {
 public:
  /// Both planes of chroma have one stride.
  RidgeSearch(const ConstYuv420View& image, ConstBitView roi, ConstBitView green, const CarpetModel& carpet,
              BitView strong, BitView weak, const Kernels& kernels)
      : image_(image), roi_(roi), green_(green), carpet_(carpet), strong_(strong), weak_(weak), kernels_(kernels) {
    // The difference of two sums of weight 4 has sqrt(12) of the noise of one luma: 3 and 1.5 sigma, and one grey
    // level.
    strong_margin_ = static_cast<std::int16_t>(carpet.noise * 2 / 3 + 4);
    weak_margin_ = static_cast<std::int16_t>(carpet.noise / 3 + 4);
  }

  /// One block of the width table: all its pixels share the reaches.
  void search_block(int block_x, int block_y, const LineWidth& width) const {
    if (width.slanted == 0) return;  // no ground there
    const int x0 = block_x * width_block_px;
    const int y0 = block_y * width_block_px;
    // What is a line already stays one.
    const BitWord wanted = block_bits(roi_, x0, y0) & ~block_bits(strong_, x0, y0) & inner_block(roi_, x0, y0, 1, 1);
    if (wanted == 0) return;
    const Reaches along_row = reaches_for(width.across_row, width.slanted);
    const Reaches along_column = reaches_for(width.across_column, width.slanted);
    RidgeBlock block{image_.y.data,   image_.y.stride,    image_.y.width, image_.y.height, x0, y0, {}, {},
                     along_row.count, along_column.count, weak_margin_,   strong_margin_};
    for (std::size_t k = 0; k < along_row.px.size(); ++k) {
      block.row_reach[k] = along_row.px[k];
      block.column_reach[k] = along_column.px[k];
    }
    RidgeBits bits;
    kernels_.find_ridges(block, bits);
    Found found;
    for (int k = 0; k < along_row.count; ++k) {
      look({x0, y0, along_row.px[static_cast<std::size_t>(k)], 0}, wanted, bits.row_weak[k], bits.row_strong[k], found);
    }
    for (int k = 0; k < along_column.count; ++k) {
      look({x0, y0, 0, along_column.px[static_cast<std::size_t>(k)]}, wanted, bits.column_weak[k],
           bits.column_strong[k], found);
    }
    if (found.weak == 0) return;
    add_block(strong_, x0, y0, found.strong);
    add_block(weak_, x0, y0, found.weak);
  }

 private:
  struct Found {
    BitWord weak = 0, strong = 0;
  };
  struct Look {
    int x0, y0, dx, dy;
  };

  /// Of those that are bright enough, the ones between green on both sides that are whiter than these.
  void look(const Look& at, BitWord wanted, BitWord weak, BitWord strong, Found& found) const {
    // Where one is found already and cannot become more, there is nothing to learn.
    BitWord left = weak & wanted & ~(found.strong | (found.weak & ~strong));
    if (left == 0) return;
    left &= inner_block(roi_, at.x0, at.y0, at.dx != 0 ? at.dx : 1, at.dy != 0 ? at.dy + 1 : 1);
    left &= block_bits(green_, at.x0 - at.dx, at.y0 - at.dy) & block_bits(green_, at.x0 + at.dx, at.y0 + at.dy);
    for (; left != 0; left &= left - 1) {
      const int bit = std::countr_zero(left);
      const int x = at.x0 + bit % ridge_block_px;
      const int y = at.y0 + bit / ridge_block_px;
      const BitWord flag = BitWord{1} << bit;
      const Colour here = colour(x, y);
      // Without a branch: no processor could predict one.
      const bool before = whiter(here, colour(x - at.dx, y - at.dy));
      const bool after = whiter(here, colour(x + at.dx, y + at.dy));
      const BitWord both = static_cast<int>(before) & static_cast<int>(after) ? flag : 0;
      found.weak |= both;
      found.strong |= strong & both;
    }
  }

  struct Colour {
    std::int32_t luma, greenness, chroma;
  };
  [[nodiscard]] Colour colour(int x, int y) const {
    const int chroma = static_cast<int>(static_cast<unsigned>(y) / 2U) * image_.cb.stride +
                       static_cast<int>(static_cast<unsigned>(x) / 2U);
    const std::int32_t cb = image_.cb.data[chroma] - 128;
    const std::int32_t cr = image_.cr.data[chroma] - 128;
    return {image_.y.at(x, y), cb * carpet_.axis_cb + cr * carpet_.axis_cr, magnitude(cb) + magnitude(cr)};
  }
  /// Chroma over luma, compared without a division: at least an eighth less green than the side, and not more of any
  /// colour: a yellow post is brighter and less green than the carpet, but no line.
  static bool whiter(const Colour& here, const Colour& side) {
    const bool less_green = here.greenness * side.luma * 8 < side.greenness * here.luma * 7;
    const bool less_colour = here.chroma * side.luma < side.chroma * here.luma;
    return (static_cast<int>(less_green) & static_cast<int>(less_colour)) != 0;
  }

  ConstYuv420View image_;
  ConstBitView roi_;
  ConstBitView green_;
  CarpetModel carpet_;
  BitView strong_;
  BitView weak_;
  const Kernels& kernels_;
  std::int16_t strong_margin_ = 0;
  std::int16_t weak_margin_ = 0;
};

}  // namespace

GrowResult find_white_ridges(const ConstYuv420View& image, ConstBitView roi, ConstBitView green, LineWidthView widths,
                             const CarpetModel& carpet, BitView lines, BitView scratch, const Kernels& kernels) {
  if (carpet.samples == 0) return {};
  copy(lines, scratch);
  const RidgeSearch search(image, roi, green, carpet, lines, scratch, kernels);
  for (int by = 0; by < widths.height; ++by) {
    for (int bx = 0; bx < widths.width; ++bx) search.search_block(bx, by, widths.at(bx, by));
  }
  return grow_inside(lines, scratch);
}

}  // namespace touchline
