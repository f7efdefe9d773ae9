// SPDX-License-Identifier: Apache-2.0
#include "vision/skeleton_index.h"

#include <array>
#include <bit>

#include "vision/image/bit_ops.h"

namespace touchline {
namespace {

constexpr std::array<std::uint8_t, 256> make_count_table() {
  std::array<std::uint8_t, 256> table{};
  for (unsigned n = 0; n < 256; ++n) table[n] = static_cast<std::uint8_t>(bits_set(n));
  return table;
}
constexpr std::array<std::uint8_t, 256> count_table = make_count_table();

int count_row(ConstBitView image, int y) {
  int count = 0;
  for (int w = 0; w < words_for(image.width); ++w) count += bits_set(image.row(y)[w]);
  return count;
}

}  // namespace

constinit const std::array<std::uint8_t, 512> steps_of_block = [] {
  std::array<std::uint8_t, 512> table{};
  for (unsigned block = 0; block < table.size(); ++block) table[block] = steps_of(ring_of(block));
  return table;
}();

int count_of(std::uint8_t neighbours) { return count_table[neighbours]; }

bool SkeletonIndex::build(ConstBitView skeleton) {
  skeleton_ = skeleton;
  size_ = 0;
  dropped_ = 0;
  first_row_ = 0;
  const int words = words_for(skeleton.width);
  if (memory_.pixels_before.size() < static_cast<std::size_t>(words) * static_cast<std::size_t>(skeleton.height)) {
    skeleton_ = {};
    return false;
  }
  const int capacity = static_cast<int>(memory_.pixels.size() < no_pixel ? memory_.pixels.size() : no_pixel);
  if (number_rows(capacity - bits_per_word)) return true;
  leave_out_rows(capacity);
  (void)number_rows(capacity);
  return true;
}

/// The lowest rows that there is room for.
void SkeletonIndex::leave_out_rows(int capacity) {
  int room = capacity;
  first_row_ = skeleton_.height;
  for (int y = skeleton_.height - 1; y >= 0; --y) {
    const int in_row = count_row(skeleton_, y);
    room -= in_row;
    if (room >= 0) {
      first_row_ = y;
    } else {
      dropped_ += in_row;
    }
  }
}

/// Numbers the pixels from the first row on; false when a word begins with more than `most` numbers given.
bool SkeletonIndex::number_rows(int most) {
  const int words = words_for(skeleton_.width);
  GridPoint* const pixels = memory_.pixels.data();
  std::size_t size = 0;
  for (int y = first_row_; y < skeleton_.height; ++y) {
    const BitWord* row = skeleton_.row(y);
    for (int w = 0; w < words; ++w) {
      memory_.pixels_before[static_cast<std::size_t>(y * words + w)] = static_cast<std::uint16_t>(size);
      if (row[w] == 0) continue;
      if (static_cast<int>(size) > most) return false;
      for_each_bit(row[w], [&](int b) {
        pixels[size++] = {static_cast<std::int16_t>(w * bits_per_word + b), static_cast<std::int16_t>(y)};
      });
    }
  }
  size_ = static_cast<int>(size);
  return true;
}

}  // namespace touchline
