// SPDX-License-Identifier: Apache-2.0
// Whole-mask operations, 64 pixels a word. All of them keep the invariant of bit_image.h: bits at and beyond the width
// stay zero. Views that take part in one call have the same width and height.
#pragma once

#include <bit>
#include <span>

#include "vision/image/bit_image.h"
#include "vision/image/kernels.h"
#include "vision/image/vector_registers.h"

namespace touchline {

/// The bits of a row's last word that are inside the image; all ones when the width is a multiple of 64.
constexpr BitWord last_word_mask(int width) {
  const int used = width % bits_per_word;
  return used == 0 ? ~BitWord{0} : (BitWord{1} << used) - 1;
}

/// Set bits of each byte of a word.
constexpr BitWord bits_of_bytes(BitWord word) {
  word -= (word >> 1) & 0x5555555555555555U;
  word = (word & 0x3333333333333333U) + ((word >> 2) & 0x3333333333333333U);
  return (word + (word >> 4)) & 0x0F0F0F0F0F0F0F0FU;
}
/// Set bits of a word, in plain arithmetic: std::popcount calls the compiler's library where the processor has no such
/// instruction, and these sums are vectorised.
constexpr int bits_set(BitWord word) {
  word = bits_of_bytes(word);
  word += word >> 8;
  word += word >> 16;
  word += word >> 32;
  return static_cast<int>(word & 0x7FU);
}
/// The same of a single word: by a multiplication, which no vector of 64-bit words has, where it is one instruction.
constexpr int bits_set_in_one(BitWord word) {
  if constexpr (sizeof(void*) < sizeof(BitWord)) return bits_set(word);
  return static_cast<int>((bits_of_bytes(word) * 0x0101010101010101U) >> 56);
}

void clear(BitView mask);
void fill(BitView mask);
void copy(ConstBitView from, BitView to);
void invert(BitView mask);
/// target = target AND other.
void and_with(BitView target, ConstBitView other);
/// target = target OR other.
void or_with(BitView target, ConstBitView other);
/// target = target AND NOT other.
void and_not_with(BitView target, ConstBitView other);
[[nodiscard]] int count(ConstBitView mask);
[[nodiscard]] int count(ConstBitView mask, const Kernels& kernels);
[[nodiscard]] bool equal(ConstBitView a, ConstBitView b);
/// Whether a pixel of the rectangle is set, first and last both included; all of it lies inside the image.
[[nodiscard]] bool any_set(ConstBitView mask, int first_x, int first_y, int last_x, int last_y);

/// Sets or clears the pixels first..last (both included) of a row; the part outside the image is ignored.
void set_span(BitView mask, int y, int first, int last, bool value);

/// A point in 1/16 pixel, continuous: the centre of pixel (i, j) is (16 i + 8, 16 j + 8).
inline constexpr int subpixels = 16;
struct SubpixelPoint {
  std::int32_t x = 0;
  std::int32_t y = 0;
};

/// Sets or clears every pixel whose centre lies inside the polygon, by the even-odd rule; any simple or crossing
/// polygon of up to `max_polygon_points`, also one that reaches outside the image. Two polygons that share an edge
/// share no pixel. Coordinates up to
/// +-2^20 (65,536 pixels). Points beyond the capacity are ignored and the return value says how many.
inline constexpr std::size_t max_polygon_points = 32;  // an outline drawn by hand in a configuration file
std::size_t fill_polygon(BitView mask, std::span<const SubpixelPoint> polygon, bool value);

/// Calls visit(bit) for every set bit, the lowest first.
template <typename Visit>
void for_each_bit(BitWord word, Visit visit) {
  if constexpr (vector_registers) {
    for (BitWord left = word; left != 0; left &= left - 1) visit(std::countr_zero(left));
  } else {  // a register of a small processor at a time
    for (auto left = static_cast<std::uint32_t>(word); left != 0; left &= left - 1) visit(std::countr_zero(left));
    for (auto left = static_cast<std::uint32_t>(word >> 32U); left != 0; left &= left - 1) {
      visit(32 + std::countr_zero(left));
    }
  }
}

/// Calls visit(x, y) for every set pixel, rows from the top, each from the left.
template <typename Visit>
void for_each_set_bit(ConstBitView mask, Visit visit) {
  const int words = words_for(mask.width);
  for (int y = 0; y < mask.height; ++y) {
    const BitWord* row = mask.row(y);
    for (int i = 0; i < words; ++i) {
      for_each_bit(row[i], [&](int bit) { visit(i * bits_per_word + bit, y); });
    }
  }
}

}  // namespace touchline
