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

int count_of(std::uint8_t neighbours) { return count_table[neighbours]; }

bool SkeletonIndex::build(ConstBitView skeleton) {
  skeleton_ = skeleton;
  size_ = 0;
  dropped_ = 0;
  const int words = words_for(skeleton.width);
  if (memory_.pixels_before.size() < static_cast<std::size_t>(words) * static_cast<std::size_t>(skeleton.height)) {
    skeleton_ = {};
    return false;
  }
  const int capacity = static_cast<int>(memory_.pixels.size() < no_pixel ? memory_.pixels.size() : no_pixel);
  int room = capacity;
  first_row_ = skeleton.height;
  for (int y = skeleton.height - 1; y >= 0; --y) {
    const int in_row = count_row(skeleton, y);
    room -= in_row;
    if (room >= 0) {
      first_row_ = y;
    } else {
      dropped_ += in_row;
    }
  }
  for (int y = first_row_; y < skeleton.height; ++y) {
    for (int w = 0; w < words; ++w) {
      memory_.pixels_before[static_cast<std::size_t>(y * words + w)] = static_cast<std::uint16_t>(size_);
      for (BitWord rest = skeleton.row(y)[w]; rest != 0; rest &= rest - 1) {
        const int x = w * bits_per_word + std::countr_zero(rest);
        memory_.pixels[static_cast<std::size_t>(size_++)] = {static_cast<std::int16_t>(x),
                                                             static_cast<std::int16_t>(y)};
      }
    }
  }
  return true;
}

}  // namespace touchline
