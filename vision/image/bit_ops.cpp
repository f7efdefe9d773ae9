// SPDX-License-Identifier: Apache-2.0
// Whole-mask operations: plain loops over words that compilers vectorise; polygon fill by scan lines (Foley, van Dam,
// "Computer Graphics", section 3.6) in exact integers.
#include "vision/image/bit_ops.h"

#include <algorithm>

namespace touchline {
namespace {

template <typename Combine>
void combine(BitView target, ConstBitView other, Combine word) {
  assert(target.width == other.width && target.height == other.height);
  const int words = words_for(target.width);
  if (target.stride == words && other.stride == words) {  // all rows in one piece
    for (int i = 0; i < words * target.height; ++i) target.words[i] = word(target.words[i], other.words[i]);
    return;
  }
  for (int y = 0; y < target.height; ++y) {
    BitWord* to = target.row(y);
    const BitWord* from = other.row(y);
    for (int i = 0; i < words; ++i) to[i] = word(to[i], from[i]);
  }
}

template <typename Change>
void change_all(BitView mask, Change word) {
  const int words = words_for(mask.width);
  if (words == 0) return;
  for (int y = 0; y < mask.height; ++y) {
    BitWord* row = mask.row(y);
    for (int i = 0; i < words; ++i) row[i] = word(row[i]);
    row[words - 1] &= last_word_mask(mask.width);
  }
}

/// Bits first..last of one word, 0 <= first <= last <= 63.
BitWord bit_range(int first, int last) { return (~BitWord{0} << first) & (~BitWord{0} >> (bits_per_word - 1 - last)); }

std::int64_t floor_div(std::int64_t a, std::int64_t positive) {
  return a >= 0 ? a / positive : -((-a + positive - 1) / positive);
}

/// The first pixel whose centre is at or right of where the edge a-b crosses the horizontal line at height `y`.
int first_pixel_right_of(SubpixelPoint a, SubpixelPoint b, std::int64_t y) {
  if (a.y > b.y) std::swap(a, b);
  const std::int64_t rise = std::int64_t{b.y} - a.y;  // > 0: the edge crosses the line
  const std::int64_t x_times_rise = std::int64_t{a.x} * rise + (y - a.y) * (std::int64_t{b.x} - a.x);
  // Smallest i with 16 i + 8 >= x, that is ceil((x - 8) / 16).
  const std::int64_t i = -floor_div(-(x_times_rise - subpixels / 2 * rise), subpixels * rise);
  return static_cast<int>(i);
}

}  // namespace

void clear(BitView mask) {
  if (mask.stride == words_for(mask.width) && mask.height > 0) {  // all rows in one piece
    std::fill_n(mask.words, mask.stride * mask.height, BitWord{0});
    return;
  }
  change_all(mask, [](BitWord) { return BitWord{0}; });
}
void fill(BitView mask) {
  change_all(mask, [](BitWord) { return ~BitWord{0}; });
}
void invert(BitView mask) {
  change_all(mask, [](BitWord w) { return ~w; });
}
void copy(ConstBitView from, BitView to) {
  combine(to, from, [](BitWord, BitWord b) { return b; });
}
void and_with(BitView target, ConstBitView other) {
  combine(target, other, [](BitWord a, BitWord b) { return a & b; });
}
void or_with(BitView target, ConstBitView other) {
  combine(target, other, [](BitWord a, BitWord b) { return a | b; });
}
void and_not_with(BitView target, ConstBitView other) {
  combine(target, other, [](BitWord a, BitWord b) { return a & ~b; });
}

int count(ConstBitView mask) {
  const int words = words_for(mask.width);
  int sum = 0;
  for (int y = 0; y < mask.height; ++y) {
    const BitWord* row = mask.row(y);
    for (int i = 0; i < words; ++i) {
      if constexpr (!vector_registers) {
        if (row[i] == 0) continue;
      }
      sum += bits_set(row[i]);
    }
  }
  return sum;
}

int count(ConstBitView mask, const Kernels& kernels) {
  if (kernels.count_bits == nullptr || mask.stride != words_for(mask.width)) return count(mask);
  return kernels.count_bits(mask.words, std::ptrdiff_t{mask.stride} * mask.height);
}

bool equal(ConstBitView a, ConstBitView b) {
  if (a.width != b.width || a.height != b.height) return false;
  for (int y = 0; y < a.height; ++y) {
    if (!std::equal(a.row(y), a.row(y) + words_for(a.width), b.row(y))) return false;
  }
  return true;
}

bool any_set(ConstBitView mask, int first_x, int first_y, int last_x, int last_y) {
  assert(first_x >= 0 && first_x <= last_x && last_x < mask.width);
  const int first_word = first_x / bits_per_word;
  const int last_word = last_x / bits_per_word;
  // All rows are looked at: where the first pixel lies is hard to foresee.
  BitWord in_first = 0, between = 0, in_last = 0;
  for (int y = first_y; y <= last_y; ++y) {
    const BitWord* row = mask.row(y);
    in_first |= row[first_word];
    in_last |= row[last_word];
    for (int i = first_word + 1; i < last_word; ++i) between |= row[i];
  }
  const BitWord left = ~BitWord{0} << (first_x % bits_per_word);
  const BitWord right = ~BitWord{0} >> (bits_per_word - 1 - last_x % bits_per_word);
  if (first_word == last_word) return (in_first & left & right) != 0;
  return ((in_first & left) | between | (in_last & right)) != 0;
}

void set_span(BitView mask, int y, int first, int last, bool value) {
  if (y < 0 || y >= mask.height) return;
  first = std::max(first, 0);
  last = std::min(last, mask.width - 1);
  if (first > last) return;
  BitWord* row = mask.row(y);
  const int first_word = first / bits_per_word;
  const int last_word = last / bits_per_word;
  for (int i = first_word; i <= last_word; ++i) {
    const BitWord range = bit_range(i == first_word ? first % bits_per_word : 0,
                                    i == last_word ? last % bits_per_word : bits_per_word - 1);
    row[i] = value ? (row[i] | range) : (row[i] & ~range);
  }
}

std::size_t fill_polygon(BitView mask, std::span<const SubpixelPoint> polygon, bool value) {
  const std::size_t used = std::min(polygon.size(), max_polygon_points);
  for (int row = 0; row < mask.height; ++row) {
    const std::int64_t y = std::int64_t{row} * subpixels + subpixels / 2;
    std::array<int, max_polygon_points> crossing{};
    std::size_t crossings = 0;
    for (std::size_t i = 0; i < used; ++i) {
      const SubpixelPoint a = polygon[i];
      const SubpixelPoint b = polygon[i + 1 == used ? 0 : i + 1];
      if ((a.y <= y) != (b.y <= y)) crossing[crossings++] = first_pixel_right_of(a, b, y);
    }
    std::sort(crossing.begin(), crossing.begin() + static_cast<std::ptrdiff_t>(crossings));
    for (std::size_t i = 0; i + 1 < crossings; i += 2) set_span(mask, row, crossing[i], crossing[i + 1] - 1, value);
  }
  return polygon.size() - used;
}

}  // namespace touchline
