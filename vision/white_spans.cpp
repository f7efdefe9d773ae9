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

struct GapSearch {
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

/// other_extent(limit): pixels without green across the scan, which few gaps need to know.
template <typename OtherExtent>
bool too_wide_for_slope(int length, const ExtentBySlope& extent, OtherExtent other_extent) {
  if (extent.never_wider()) return false;
  if (extent.always_wider()) return true;
  const int other = other_extent(length * slope_reach);
  return extent.wider_at(std::min(length, other), other);
}

void close_row_gap(GapSearch& search, int y, int first, int end) {
  const LineWidth& expected = width_at(search.widths, (first + end) / 2, y);
  const Gap gap{search.image.y.row(y) + first,         1, end - first, first, search.green.width - end,
                count_row(search.white, y, first, end)};
  GapVerdict verdict = judge(gap, expected, expected.across_row, search.carpet);
  if (verdict == GapVerdict::line &&
      too_wide_for_slope(gap.length, {gap.length, expected.across_row, expected.across_column, expected.slanted},
                         [&](int limit) { return column_extent(search.green, (first + end) / 2, y, limit); })) {
    verdict = GapVerdict::too_wide;
  }
  if (count_verdict(verdict, search.counts)) set_span(search.lines, y, first, end - 1, true);
}

void search_row(GapSearch& search, int y) {
  const int words = words_for(search.green.width);
  const BitWord* row = search.green.row(y);
  int gap_begin = -1;
  BitWord before = 0;
  for (int i = 0; i < words; ++i) {
    // A set bit where a pixel differs from its left neighbour: green begins and ends in turn.
    const BitWord changes = row[i] ^ (row[i] << 1 | before);
    before = row[i] >> (bits_per_word - 1);
    for_each_bit(changes, [&](int bit) {
      const int x = i * bits_per_word + bit;
      if (((row[i] >> bit) & 1U) == 0) {
        gap_begin = x;
      } else if (gap_begin >= 0) {
        close_row_gap(search, y, gap_begin, x);
      }
    });
  }
}

/// The bytes that hold pixel x of the rows from `y` on.
template <typename Byte, typename Word>
struct Column {
  Byte* byte;
  std::ptrdiff_t stride;
  unsigned shift;

  Column(const BasicBitView<Word>& mask, int x, int y)
      : byte(reinterpret_cast<Byte*>(mask.row(y)) + x / 8),
        stride(mask.stride * std::ptrdiff_t{sizeof(BitWord)}),
        shift(static_cast<unsigned>(x) % 8U) {}
};

int count_column(ConstBitView mask, int x, int first, int end) {
  const Column<const unsigned char, const BitWord> column(mask, x, first);
  unsigned total = 0;
  for (int k = 0; k < end - first; ++k) total += (unsigned{column.byte[k * column.stride]} >> column.shift) & 1U;
  return static_cast<int>(total);
}
void set_column(BitView mask, int x, int first, int end) {
  const Column<unsigned char, BitWord> column(mask, x, first);
  for (int k = 0; k < end - first; ++k) {
    unsigned char& byte = column.byte[k * column.stride];
    byte = static_cast<unsigned char>(byte | (1U << column.shift));
  }
}

void close_column_gap(GapSearch& search, int x, int first, int end) {
  const LineWidth& expected = width_at(search.widths, x, (first + end) / 2);
  if (end - first > with_tolerance(expected.slanted)) {  // before the white pixels are counted one by one
    ++search.counts.too_wide;
    return;
  }
  const Gap gap{search.image.y.row(first) + x,
                search.image.y.stride,
                end - first,
                first,
                search.green.height - end,
                count_column(search.white, x, first, end)};
  GapVerdict verdict = judge(gap, expected, expected.across_column, search.carpet);
  if (verdict == GapVerdict::line &&
      too_wide_for_slope(gap.length, {gap.length, expected.across_column, expected.across_row, expected.slanted},
                         [&](int limit) { return row_extent(search.green, x, (first + end) / 2, limit); })) {
    verdict = GapVerdict::too_wide;
  }
  if (count_verdict(verdict, search.counts)) set_column(search.lines, x, first, end);
}

/// All columns at once: only where green begins or ends from one row to the next there is something to do.
void search_columns(GapSearch& search) {
  std::array<std::int16_t, max_mask_width> gap_begin{};
  gap_begin.fill(-1);
  const int words = words_for(search.green.width);
  for (int y = 1; y < search.green.height; ++y) {
    const BitWord* above = search.green.row(y - 1);
    const BitWord* here = search.green.row(y);
    for (int i = 0; i < words; ++i) {
      for_each_bit(above[i] ^ here[i], [&](int bit) {
        const int x = i * bits_per_word + bit;
        const auto column = static_cast<std::size_t>(x);
        if (((above[i] >> bit) & 1U) != 0) {
          gap_begin[column] = static_cast<std::int16_t>(y);
        } else if (gap_begin[column] >= 0) {
          close_column_gap(search, x, gap_begin[column], y);
        }
      });
    }
  }
}

SpanSearch search_by_kernel(const GapSearch& search) {
  SpanSearch s;
  s.luma = search.image.y.data;
  s.green = search.green.words;
  s.white = search.white.words;
  s.lines = search.lines.words;
  s.widths = search.widths.data;
  s.luma_stride = search.image.y.stride;
  s.green_stride = search.green.stride;
  s.white_stride = search.white.stride;
  s.lines_stride = search.lines.stride;
  s.widths_stride = search.widths.stride;
  s.width = search.green.width;
  s.height = search.green.height;
  s.least_excess = search.carpet.noise / 8 + 1;
  return s;
}

}  // namespace

SpanCounts find_white_spans(const ConstYuv420View& image, ConstBitView green, ConstBitView white, LineWidthView widths,
                            const CarpetModel& carpet, BitView lines, const Kernels& kernels) {
  clear(lines);
  if (carpet.samples == 0) return {};
  GapSearch search{image, green, white, widths, carpet, lines, {}};
  if (kernels.find_spans != nullptr && green.width >= 4) {
    kernels.find_spans(search_by_kernel(search), search.counts);
    return search.counts;
  }
  for (int y = 0; y < green.height; ++y) search_row(search, y);
  search_columns(search);
  return search.counts;
}

}  // namespace touchline
