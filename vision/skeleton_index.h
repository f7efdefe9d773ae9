// SPDX-License-Identifier: Apache-2.0
// Numbers the pixels of a skeleton in raster order, so that digestion (paper section IV-D) and the node graph (IV-E)
// keep their state per skeleton pixel and not per image pixel: a skeleton covers about one pixel in fifty.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "vision/graph.h"
#include "vision/image/bit_image.h"
#include "vision/image/bit_ops.h"

namespace touchline {

/// Eight neighbours, one bit each, clockwise from north: N, NE, E, SE, S, SW, W, NW.
constexpr int neighbour_dx[8] = {0, 1, 1, 1, 0, -1, -1, -1};
constexpr int neighbour_dy[8] = {-1, -1, 0, 1, 1, 1, 0, -1};

using PixelIndex = std::uint16_t;
inline constexpr PixelIndex no_pixel = 0xFFFF;

/// Memory of a SkeletonIndex.
struct SkeletonIndexMemory {
  std::span<GridPoint> pixels;             // capacity for skeleton pixels, at most 65,535
  std::span<std::uint16_t> pixels_before;  // one a word of the mask
};

class SkeletonIndex {
 public:
  explicit SkeletonIndex(const SkeletonIndexMemory& memory) : memory_(memory) {}

  /// Numbers the pixels of `skeleton`, which must stay as it is while the index is in use. When there are more than the
  /// memory holds, the upper rows are left out (what is near the robot lies below) and their pixels counted in
  /// dropped(). False when the memory has too few words for the mask.
  bool build(ConstBitView skeleton);

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int dropped() const { return dropped_; }
  [[nodiscard]] int width() const { return skeleton_.width; }
  [[nodiscard]] int height() const { return skeleton_.height; }
  /// Pixels in raster order.
  [[nodiscard]] std::span<const GridPoint> pixels() const {
    return memory_.pixels.first(static_cast<std::size_t>(size_));
  }
  [[nodiscard]] GridPoint pixel(PixelIndex i) const { return memory_.pixels[i]; }
  /// The number of a pixel; no_pixel where the skeleton has none.
  [[nodiscard]] PixelIndex at(int x, int y) const;
  /// The number of a pixel of the skeleton.
  [[nodiscard]] PixelIndex number_of(int x, int y) const;
  /// Of the rows that are numbered, the first.
  [[nodiscard]] int first_row() const { return first_row_; }
  /// The words of a row; null where no pixel is numbered.
  [[nodiscard]] const BitWord* row(int y) const {
    return y < first_row_ || y >= skeleton_.height ? nullptr : skeleton_.row(y);
  }
  /// Bit k is set when the neighbour in direction k is a skeleton pixel.
  [[nodiscard]] std::uint8_t neighbours(GridPoint p) const;
  /// Those of them that a walk steps to (steps_of() below).
  [[nodiscard]] std::uint8_t steps(int x, int y) const;

 private:
  void leave_out_rows(int capacity);
  bool number_rows(int most);
  [[nodiscard]] unsigned three(int x, int y) const;  // pixels x - 1, x, x + 1 of row y in bits 0, 1, 2
  [[nodiscard]] unsigned block(int x, int y) const {
    return three(x, y - 1) | three(x, y) << 3U | three(x, y + 1) << 6U;
  }

  SkeletonIndexMemory memory_;
  ConstBitView skeleton_{};
  int first_row_ = 0;
  int size_ = 0;
  int dropped_ = 0;
};

inline PixelIndex SkeletonIndex::number_of(int x, int y) const {
  const auto column = static_cast<unsigned>(x);
  const BitWord below = (BitWord{1} << (column % bits_per_word)) - 1;
  const int w = y * words_for(skeleton_.width) + static_cast<int>(column / bits_per_word);
  const BitWord word = skeleton_.row(y)[column / bits_per_word];
  return static_cast<PixelIndex>(memory_.pixels_before[static_cast<std::size_t>(w)] + bits_set_in_one(word & below));
}

inline PixelIndex SkeletonIndex::at(int x, int y) const {
  return y < first_row_ || !skeleton_.get(x, y) ? no_pixel : number_of(x, y);
}

/// Of eight neighbours, those that a walk steps to: a diagonal neighbour is left out when a straight one touches both
/// it and the pixel. So a corner of a staircase has two ways on and not three ("mixed adjacency", Rosenfeld & Kak).
constexpr std::uint8_t steps_of(std::uint8_t neighbours) {
  unsigned steps = neighbours & 0x55U;  // the four straight neighbours
  for (unsigned k = 1; k < 8; k += 2) {
    const unsigned beside = 1U << (k - 1) | 1U << ((k + 1) & 7U);
    if ((neighbours & beside) == 0) steps |= neighbours & 1U << k;
  }
  return static_cast<std::uint8_t>(steps);
}

/// The neighbours in a block of three by three pixels, whose rows are bits 0-2, 3-5 and 6-8.
constexpr std::uint8_t ring_of(unsigned block) {
  constexpr unsigned places[8] = {1, 2, 5, 8, 7, 6, 3, 0};
  unsigned ring = 0;
  for (unsigned k = 0; k < 8; ++k) ring |= (block >> places[k] & 1U) << k;
  return static_cast<std::uint8_t>(ring);
}
/// steps_of() of the neighbours in each such block.
extern const std::array<std::uint8_t, 512> steps_of_block;

inline unsigned SkeletonIndex::three(int x, int y) const {
  const BitWord* words = row(y);
  if (words == nullptr) return 0;
  const auto w = static_cast<unsigned>(x) / bits_per_word;
  const unsigned bit = static_cast<unsigned>(x) % bits_per_word;
  if (bit == 0) {
    const BitWord left = w > 0 ? words[w - 1] >> (bits_per_word - 1) : 0;
    return static_cast<unsigned>(((words[w] & 3U) << 1) | left);
  }
  BitWord bits = words[w] >> (bit - 1);
  if (bit == bits_per_word - 1 && static_cast<int>(w) + 1 < words_for(skeleton_.width)) bits |= words[w + 1] << 2;
  return static_cast<unsigned>(bits & 7U);
}
inline std::uint8_t SkeletonIndex::neighbours(GridPoint p) const { return ring_of(block(p.x, p.y)); }
inline std::uint8_t SkeletonIndex::steps(int x, int y) const { return steps_of_block[block(x, y)]; }

/// How many of eight bits are set.
int count_of(std::uint8_t neighbours);

}  // namespace touchline
