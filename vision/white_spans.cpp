// SPDX-License-Identifier: Apache-2.0
// White search, near lines: gaps in the green along rows and columns.
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "vision/image/bit_ops.h"
#include "vision/image/morphology.h"
#include "vision/line_extent.h"
#include "vision/white_search.h"

namespace touchline {
namespace {

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
  int before, after;  // pixels of the image before the first and after the last
  int white;          // white pixels in it
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
    const Gap gap{search.image.y.row(y) + first,         1, end - first, first, width - end,
                  count_row(search.white, y, first, end)};
    GapVerdict verdict = judge(gap, expected, expected.across_row, search.carpet);
    if (verdict == GapVerdict::line) {
      const int other = column_extent(search.green, (first + end) / 2, y, gap.length * slope_reach);
      if (wider_than_slope_allows(gap.length, std::min(gap.length, other), other, expected.across_row,
                                  expected.across_column, expected.slanted)) {
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
  const Gap gap{
      search.image.y.row(first) + x, search.image.y.stride, end - first, first, search.green.height - end, white};
  GapVerdict verdict = judge(gap, expected, expected.across_column, search.carpet);
  if (verdict == GapVerdict::line) {
    const int other = row_extent(search.green, x, (first + end) / 2, gap.length * slope_reach);
    if (wider_than_slope_allows(gap.length, std::min(gap.length, other), other, expected.across_column,
                                expected.across_row, expected.slanted)) {
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

}  // namespace

SpanCounts find_white_spans(const ConstYuv420View& image, ConstBitView green, ConstBitView white, LineWidthView widths,
                            const CarpetModel& carpet, BitView lines) {
  SpanSearch search{image, green, white, widths, carpet, lines, {}};
  if (carpet.samples == 0) return search.counts;
  for (int y = 0; y < green.height; ++y) search_row(search, y);
  search_columns(search);
  return search.counts;
}

}  // namespace touchline
