// SPDX-License-Identifier: Apache-2.0
#include "vision/white_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

#include "vision/image/bit_ops.h"
#include "vision/line_extent.h"
#include "vision/image/morphology.h"

namespace touchline {
namespace {

constexpr std::int32_t magnitude(std::int32_t v) { return v < 0 ? -v : v; }

/// First x >= from with bit == value; width when there is none.
int next_bit(const BitWord* row, int width, int from, bool value) {
  const BitWord flip = value ? 0 : ~BitWord{0};
  int i = from / bits_per_word;
  BitWord word = (row[i] ^ flip) & (~BitWord{0} << (from % bits_per_word));
  const int words = words_for(width);
  while (word == 0) {
    if (++i >= words) return width;
    word = row[i] ^ flip;
  }
  return std::min(i * bits_per_word + std::countr_zero(word), width);
}

/// A gap in the green along a row or a column: pixels first .. first + length - 1.
struct Gap {
  const std::uint8_t* luma;  // of the first pixel
  std::ptrdiff_t step;       // to the next pixel along the gap
  int length;
  int before, after;         // pixels of the image before the first and after the last
  int white;                 // white pixels in it
};

enum class GapVerdict : std::uint8_t { line, too_wide, too_thin, not_white, not_bright };

/// The line's pixels near one end against the green beyond that end, so that a shadow along the line does no harm.
/// `at` points to the gap's pixel at that end, `outward` leads out of it.
bool brighter_than_end(const std::uint8_t* at, std::ptrdiff_t outward, int length, int available, std::int32_t noise) {
  const int inner = length >= 4 ? 1 : 0;  // the outermost pixel of a wide gap is a mixture
  const int outer = std::min(2, available);
  const std::int32_t line = at[-outward * inner] + at[-outward * std::min(inner + 1, length - 1)];
  const std::int32_t green = at[outward] + at[outward * outer];
  return line > green + green / 16 + noise / 8;
}

GapVerdict judge(const Gap& gap, const LineWidth& width, std::uint16_t across, const CarpetModel& carpet) {
  if (gap.length > with_tolerance(width.slanted) || width.slanted == 0) return GapVerdict::too_wide;
  if (gap.length * 2 * 16 < across - 16) return GapVerdict::too_thin;
  if (gap.white * 2 < gap.length || gap.white == 0) return GapVerdict::not_white;
  const std::uint8_t* last = gap.luma + gap.step * (gap.length - 1);
  if (!brighter_than_end(gap.luma, -gap.step, gap.length, gap.before, carpet.noise) ||
      !brighter_than_end(last, gap.step, gap.length, gap.after, carpet.noise)) {
    return GapVerdict::not_bright;
  }
  return GapVerdict::line;
}

bool count_verdict(GapVerdict verdict, SpanCounts& counts) {
  switch (verdict) {
    case GapVerdict::line: ++counts.found; return true;
    case GapVerdict::too_wide: ++counts.too_wide; return false;
    case GapVerdict::too_thin: ++counts.too_thin; return false;
    case GapVerdict::not_white: ++counts.not_white; return false;
    case GapVerdict::not_bright: ++counts.not_bright; return false;
  }
  return false;
}

int count_row(ConstBitView mask, int y, int first, int end) {
  int total = 0;
  const BitWord* row = mask.row(y);
  for (int i = first / bits_per_word; i <= (end - 1) / bits_per_word; ++i) {
    BitWord word = row[i];
    if (i == first / bits_per_word) word &= ~BitWord{0} << (first % bits_per_word);
    if (i == (end - 1) / bits_per_word && end % bits_per_word != 0) word &= (BitWord{1} << (end % bits_per_word)) - 1;
    total += bits_set(word);
  }
  return total;
}

struct SpanSearch {
  const ConstYuv420View& image;
  ConstBitView green;
  ConstBitView white;
  LineWidthView widths;
  const CarpetModel& carpet;
  BitView lines;
  SpanCounts counts;
};

/// Pixels without green along the row (column) through a pixel, at most `limit` to each side.
int row_extent(ConstBitView green, int x, int y, int limit) {
  int left = x;
  while (left > 0 && x - left < limit && !green.get(left - 1, y)) --left;
  int right = x;
  while (right + 1 < green.width && right - x < limit && !green.get(right + 1, y)) ++right;
  return right - left + 1;
}
int column_extent(ConstBitView green, int x, int y, int limit) {
  int top = y;
  while (top > 0 && y - top < limit && !green.get(x, top - 1)) --top;
  int bottom = y;
  while (bottom + 1 < green.height && bottom - y < limit && !green.get(x, bottom + 1)) ++bottom;
  return bottom - top + 1;
}
constexpr int slope_reach = 4;  // a slope flatter than 1 : 8 is as good as level

void search_row(SpanSearch& search, int y) {
  const int width = search.green.width;
  const BitWord* row = search.green.row(y);
  int end_of_green = next_bit(row, width, 0, true);
  while (end_of_green < width) {
    const int first = next_bit(row, width, end_of_green, false);
    if (first >= width) return;
    const int end = next_bit(row, width, first, true);
    if (end >= width) return;
    const LineWidth& expected = width_at(search.widths, (first + end) / 2, y);
    const Gap gap{search.image.y.row(y) + first, 1, end - first, first, width - end, count_row(search.white, y, first, end)};
    GapVerdict verdict = judge(gap, expected, expected.across_row, search.carpet);
    if (verdict == GapVerdict::line) {
      const int other = column_extent(search.green, (first + end) / 2, y, gap.length * slope_reach);
      if (wider_than_slope_allows(gap.length, std::min(gap.length, other), other, expected.across_row, expected.across_column, expected.slanted)) {
        verdict = GapVerdict::too_wide;
      }
    }
    if (count_verdict(verdict, search.counts)) {
      set_span(search.lines, y, first, end - 1, true);
    }
    end_of_green = end;
  }
}


void close_gap(SpanSearch& search, int x, int first, int end) {
  const LineWidth& expected = width_at(search.widths, x, (first + end) / 2);
  if (end - first > with_tolerance(expected.slanted)) {  // before the white pixels are counted one by one
    ++search.counts.too_wide;
    return;
  }
  int white = 0;
  for (int y = first; y < end; ++y) white += search.white.get(x, y) ? 1 : 0;
  const Gap gap{search.image.y.row(first) + x, search.image.y.stride, end - first, first, search.green.height - end, white};
  GapVerdict verdict = judge(gap, expected, expected.across_column, search.carpet);
  if (verdict == GapVerdict::line) {
    const int other = row_extent(search.green, x, (first + end) / 2, gap.length * slope_reach);
    if (wider_than_slope_allows(gap.length, std::min(gap.length, other), other, expected.across_column, expected.across_row, expected.slanted)) {
      verdict = GapVerdict::too_wide;
    }
  }
  if (!count_verdict(verdict, search.counts)) return;
  for (int y = first; y < end; ++y) search.lines.set(x, y, true);
}

/// All columns at once: only where green begins or ends from one row to the next there is something to do.
void search_columns(SpanSearch& search) {
  std::array<std::int16_t, max_mask_width> gap_begin{};
  gap_begin.fill(-1);
  const int words = words_for(search.green.width);
  for (int y = 1; y < search.green.height; ++y) {
    const BitWord* above = search.green.row(y - 1);
    const BitWord* here = search.green.row(y);
    for (int i = 0; i < words; ++i) {
      for (BitWord change = above[i] ^ here[i]; change != 0; change &= change - 1) {
        const int bit = std::countr_zero(change);
        const int x = i * bits_per_word + bit;
        const auto column = static_cast<std::size_t>(x);
        if (((above[i] >> bit) & 1U) != 0) {
          gap_begin[column] = static_cast<std::int16_t>(y);
        } else if (gap_begin[column] >= 0) {
          close_gap(search, x, gap_begin[column], y);
        }
      }
    }
  }
}

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

/// `p` points to the first pixel, `along` leads to the side, `beside` to the neighbours that smooth it, across the scan. Lumas are
/// sums of weight 4. Written as plain loops of eight for the compiler to vectorise.
Ridge8 brighter_than_sides(const std::uint8_t* p, std::ptrdiff_t along, std::ptrdiff_t beside, std::uint16_t weak_margin,
                           std::uint16_t strong_margin) {
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
  RidgeSearch(const ConstYuv420View& image, ConstBitView roi, ConstBitView green, const CarpetModel& carpet, BitView strong,
              BitView weak)
      : image_(image), roi_(roi), green_(green), carpet_(carpet), strong_(strong), weak_(weak) {
    // The difference of two sums of weight 4 has sqrt(12) of the noise of one luma: 3 and 1.5 sigma, and one grey level.
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
    Ridge8 ridge = brighter_than_sides(image_.y.row(y) + x0, dx + dy * stride, dx != 0 ? stride : 1, weak_margin_, strong_margin_);
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

  /// Chroma over luma, compared without a division: at least an eighth less green than the side, and not more of any colour: a
  /// yellow post is brighter and less green than the carpet, but no line.
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

/// border = pixels of `mask` that lack a neighbour in their row or column.
void border_of(ConstBitView mask, BitView border) {
  const int words = words_for(mask.width);
  for (int y = 0; y < mask.height; ++y) {
    const BitWord* row = mask.row(y);
    for (int i = 0; i < words; ++i) {
      BitWord inner = row[i] << 1 | (i > 0 ? row[i - 1] >> (bits_per_word - 1) : 0);
      inner &= row[i] >> 1 | (i + 1 < words ? row[i + 1] << (bits_per_word - 1) : 0);
      inner &= y > 0 ? mask.row(y - 1)[i] : 0;
      inner &= y + 1 < mask.height ? mask.row(y + 1)[i] : 0;
      border.row(y)[i] = row[i] & ~inner;
    }
  }
}

/// Whether a luma is below the middle between the darkest and the brightest within two pixels.
bool below_half_level(ImageView<const std::uint8_t> luma, int x, int y) {
  const int x0 = std::max(x - 2, 0);
  const int x1 = std::min(x + 2, luma.width - 1);
  const int y1 = std::min(y + 2, luma.height - 1);
  int darkest = 255;
  int brightest = 0;
  for (int v = std::max(y - 2, 0); v <= y1; ++v) {
    const std::uint8_t* row = luma.row(v);
    for (int u = x0; u <= x1; ++u) {
      darkest = std::min<int>(darkest, row[u]);
      brightest = std::max<int>(brightest, row[u]);
    }
  }
  return 2 * luma.at(x, y) < darkest + brightest;
}

/// Rows of a block row whose widest line still lets `lines` grow at this step.
bool grows(LineWidthView widths, int block_y, int step) {
  for (int i = 0; i < widths.width; ++i) {
    if (widths.at(i, block_y).slanted >= step * 32) return true;
  }
  return false;
}

}  // namespace

SpanCounts find_white_spans(const ConstYuv420View& image, ConstBitView green, ConstBitView white, LineWidthView widths,
                            const CarpetModel& carpet, BitView lines) {
  SpanSearch search{image, green, white, widths, carpet, lines, {}};
  if (carpet.samples == 0) return search.counts;
  for (int y = 0; y < green.height; ++y) search_row(search, y);
  search_columns(search);
  return search.counts;
}

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

void trim_to_half_level(ImageView<const std::uint8_t> luma, BitView lines, BitView scratch) {
  for (int pass = 0; pass < 2; ++pass) {
    border_of(lines, scratch);
    for_each_set_bit(scratch, [&](int x, int y) {
      if (below_half_level(luma, x, y)) lines.set(x, y, false);
    });
  }
}

void grow_into_white(ConstBitView white, LineWidthView widths, BitView lines, BitView scratch) {
  constexpr int max_steps = 16;  // half of a line of 32 px: nearer than a robot's own feet
  const int words = words_for(lines.width);
  for (int step = 1; step <= max_steps; ++step) {
    bool any = false;
    copy(lines, scratch);
    for (int y = 0; y < lines.height; ++y) {
      if (!grows(widths, std::min(y / width_block_px, widths.height - 1), step)) continue;
      any = true;
      for (int i = 0; i < words; ++i) {
        BitWord spread = 0;
        for (int dy = -1; dy <= 1; ++dy) {
          if (y + dy < 0 || y + dy >= lines.height) continue;
          const BitWord* row = static_cast<ConstBitView>(scratch).row(y + dy);
          spread |= row[i] | row[i] << 1 | row[i] >> 1;
          if (i > 0) spread |= row[i - 1] >> (bits_per_word - 1);
          if (i + 1 < words) spread |= row[i + 1] << (bits_per_word - 1);
        }
        lines.row(y)[i] |= spread & white.row(y)[i];
      }
    }
    if (!any) return;
  }
}

}  // namespace touchline
