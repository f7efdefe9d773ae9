// SPDX-License-Identifier: Apache-2.0
#include "vision/white_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "vision/image/bit_ops.h"
#include "vision/image/morphology.h"

namespace touchline {
namespace {

constexpr std::int32_t magnitude(std::int32_t v) { return v < 0 ? -v : v; }

const LineWidth& width_at(LineWidthView widths, int x, int y) {
  return widths.at(std::clamp(x / width_block_px, 0, widths.width - 1), std::clamp(y / width_block_px, 0, widths.height - 1));
}

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

/// Pixels that a line's extent may have: a quarter more for the roughness of the table, two and a half for the blur of both ends.
constexpr int with_tolerance(int sixteenths) { return (sixteenths * 5 / 4 + 40) / 16; }

/// A strip that is `length` pixels along the scan and `other` across the scan through the same pixel has the slope
/// s = length / other; its extent along the scan is the root of across^2 + s (slanted^2 - across^2 - other_across^2) + s^2 other_across^2.
bool wider_than_slope_allows(int length, int other, std::uint16_t across, std::uint16_t other_across, std::uint16_t slanted) {
  const std::int64_t a = std::int64_t{across} * across;
  const std::int64_t b = std::int64_t{other_across} * other_across;
  const std::int64_t mixed = std::max<std::int64_t>(std::int64_t{slanted} * slanted - a - b, 0);
  const std::int64_t n = std::min(length, other);
  const std::int64_t d = std::max(other, 1);
  const std::int64_t extent2 = a + mixed * n / d + b * n * n / (d * d);        // 2^-8 square pixels
  const std::int64_t least = std::max(length * 16 - 40, 0) * std::int64_t{4};  // length <= 5/4 extent + 40/16
  return least * least > 25 * extent2;
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
      if (wider_than_slope_allows(gap.length, other, expected.across_row, expected.across_column, expected.slanted)) {
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
    if (wider_than_slope_allows(gap.length, other, expected.across_column, expected.across_row, expected.slanted)) {
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

struct RidgeSearch {
  const ConstYuv420View& image;
  ConstBitView green;
  const CarpetModel& carpet;
  std::int32_t noise_margin;

  [[nodiscard]] std::int32_t greenness(int x, int y) const {
    return ((image.cb.at(x / 2, y / 2) - 128) * carpet.axis_cb + (image.cr.at(x / 2, y / 2) - 128) * carpet.axis_cr) / 16;
  }
  [[nodiscard]] std::int32_t chroma(int x, int y) const {
    return magnitude(image.cb.at(x / 2, y / 2) - 128) + magnitude(image.cr.at(x / 2, y / 2) - 128);
  }

  /// `p` points into the luma; `along` steps through the scan, `beside` to the neighbours that smooth it.
  [[nodiscard]] static std::int32_t smooth(const std::uint8_t* p, std::ptrdiff_t beside) {
    return p[-beside] + 2 * p[0] + p[beside];
  }

  [[nodiscard]] bool is_ridge(int x, int y, int dx, int dy) const {
    const std::uint8_t* p = image.y.row(y) + x;
    const std::ptrdiff_t beside = dx != 0 ? image.y.stride : 1;
    const std::ptrdiff_t along = dx + dy * static_cast<std::ptrdiff_t>(image.y.stride);
    const std::int32_t here = smooth(p, beside);
    const std::int32_t before = smooth(p - along, beside);
    const std::int32_t after = smooth(p + along, beside);
    if (here <= before + before / 16 + noise_margin || here <= after + after / 16 + noise_margin) return false;
    if (!green.get(x - dx, y - dy) || !green.get(x + dx, y + dy)) return false;
    return whiter(x, y, here, x - dx, y - dy, before) && whiter(x, y, here, x + dx, y + dy, after);
  }
  /// Chroma over luma, compared without a division: at least an eighth less green than the side, and not more of any colour: a
  /// yellow post is brighter and less green than the carpet, but no line.
  [[nodiscard]] bool whiter(int x, int y, std::int32_t luma, int side_x, int side_y, std::int32_t side_luma) const {
    return greenness(x, y) * side_luma * 8 < greenness(side_x, side_y) * luma * 7 &&
           chroma(x, y) * side_luma < chroma(side_x, side_y) * luma;
  }
};

/// One block of the width table: all its pixels share the reaches.
int search_block(const RidgeSearch& search, ConstBitView roi, int block_x, int block_y, const LineWidth& width, BitView lines) {
  const Reaches along_row = reaches_for(width.across_row, width.slanted);
  const Reaches along_column = reaches_for(width.across_column, width.slanted);
  const int x0 = std::max(block_x * width_block_px, 1);
  const int x1 = std::min(block_x * width_block_px + width_block_px, roi.width - 1);
  const int y0 = std::max(block_y * width_block_px, 1);
  const int y1 = std::min(block_y * width_block_px + width_block_px, roi.height - 1);
  int found = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      if (!roi.get(x, y)) continue;
      bool ridge = false;
      for (int k = 0; k < along_row.count && !ridge; ++k) {
        const int reach = along_row.px[static_cast<std::size_t>(k)];
        ridge = x - reach >= 0 && x + reach < roi.width && search.is_ridge(x, y, reach, 0);
      }
      for (int k = 0; k < along_column.count && !ridge; ++k) {
        const int reach = along_column.px[static_cast<std::size_t>(k)];
        ridge = y - reach >= 1 && y + reach < roi.height - 1 && search.is_ridge(x, y, 0, reach);
      }
      if (!ridge) continue;
      lines.set(x, y, true);
      ++found;
    }
  }
  return found;
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

int find_white_ridges(const ConstYuv420View& image, ConstBitView roi, ConstBitView green, LineWidthView widths,
                      const CarpetModel& carpet, BitView lines) {
  if (carpet.samples == 0) return 0;
  // Lumas are sums of weight 4 over three neighbours: their difference has sqrt(12) of the noise of one. Three sigma: 10.4 / 16.
  const RidgeSearch search{image, green, carpet, carpet.noise * 2 / 3 + 4};
  int found = 0;
  for (int by = 0; by < widths.height; ++by) {
    for (int bx = 0; bx < widths.width; ++bx) found += search_block(search, roi, bx, by, widths.at(bx, by), lines);
  }
  return found;
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
