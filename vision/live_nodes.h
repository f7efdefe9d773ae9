// SPDX-License-Identifier: Apache-2.0
// The live nodes of the digestion (paper, Algorithm 1) as bits, read through discs: which of them lie within the radius
// of a pixel costs a few words, not a look at each node. Only for digestion.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "vision/digestion.h"
#include "vision/image/bit_image.h"
#include "vision/image/bit_ops.h"
#include "vision/image/vector_registers.h"

namespace touchline::live_nodes {

inline constexpr int strip_px = 16;           // columns of a strip: a row of it is a number of 16 bits
inline constexpr int max_masked_radius = 31;  // the masks of larger discs would take too much of the stack

/// Some rows of a strip at once, as many as a register takes.
using Rows = std::conditional_t<vector_registers, std::uint64_t, std::uint32_t>;
inline constexpr int row_bytes = 2;
inline constexpr int rows_at_once = static_cast<int>(sizeof(Rows)) / row_bytes;
inline constexpr Rows in_every_row = static_cast<Rows>(0x0001000100010001U);

inline Rows load_rows(const unsigned char* from) {
  Rows rows = 0;
  std::memcpy(&rows, from, sizeof rows);
  return rows;
}
inline void store_rows(unsigned char* to, Rows rows) { std::memcpy(to, &rows, sizeof rows); }

/// The disc as bits, from its left column on: a strip for every sixteen columns, with zeros above and below.
class DiscMasks {
 public:
  explicit DiscMasks(int radius) : radius_(radius), rows_(4 * radius + 2 * strip_margin) {
    if (!usable()) return;
    for (int i = 0; i < (2 * radius / strip_px + 1) * rows_; ++i) bits_[static_cast<std::size_t>(i)] = 0;
    for (int dy = -radius; dy <= radius; ++dy) {
      int half = 0;
      while ((half + 1) * (half + 1) + dy * dy <= radius * radius) ++half;
      BitWord row = ((BitWord{2} << (2 * half)) - 1) << (radius - half);
      for (int c = 0; c <= 2 * radius; c += strip_px, row >>= strip_px)
        *at(c, dy + radius) = static_cast<std::uint16_t>(row);
    }
  }
  [[nodiscard]] bool usable() const { return radius_ <= max_masked_radius; }
  /// From column `column`, a multiple of 16, and row `row` of the disc on. The row may lie above or below the disc.
  [[nodiscard]] const unsigned char* strip(int column, int row) const {
    return reinterpret_cast<const unsigned char*>(bits_.data()) +
           row_bytes * (column / strip_px * rows_ + radius_ + strip_margin + row);
  }

 private:
  static constexpr int strip_margin = rows_at_once;
  [[nodiscard]] std::uint16_t* at(int column, int row) {
    return &bits_[static_cast<std::size_t>(column / strip_px * rows_ + radius_ + strip_margin + row)];
  }

  int radius_;
  int rows_;  // of a strip: the disc's, and what a window at the upper or lower edge of the image lies beside it
  std::array<std::uint16_t, static_cast<std::size_t>((2 * max_masked_radius / strip_px + 1) *
                                                     (4 * max_masked_radius + 2 * strip_margin))>
      bits_;
};

/// Sixteen columns of the live nodes from any column on, which lie in two strips.
struct Window {
  unsigned char* left;
  unsigned char* right;
  unsigned shift;  // the window's first column in the left strip
  int x, y;        // of its first bit

  [[nodiscard]] Rows from_left() const { return in_every_row * (0xFFFFU >> shift); }
  [[nodiscard]] Rows load(int row) const {
    const Rows in_left = load_rows(left + row_bytes * row) >> shift;
    const Rows in_right = right_part(load_rows(right + row_bytes * row));
    return (in_left & from_left()) | (in_right & ~from_left());
  }
  void remove(int row, Rows nodes) const {
    store_rows(left + row_bytes * row, load_rows(left + row_bytes * row) & ~((nodes & from_left()) << shift));
    store_rows(right + row_bytes * row, load_rows(right + row_bytes * row) & ~back_right(nodes & ~from_left()));
  }
  void add(int row, Rows nodes) const {
    store_rows(left + row_bytes * row, load_rows(left + row_bytes * row) | (nodes & from_left()) << shift);
    store_rows(right + row_bytes * row, load_rows(right + row_bytes * row) | back_right(nodes & ~from_left()));
  }

 private:
  [[nodiscard]] Rows right_part(Rows rows) const { return rows << (strip_px - 1U - shift) << 1U; }
  [[nodiscard]] Rows back_right(Rows rows) const { return rows >> (strip_px - 1U - shift) >> 1U; }
};

/// The live nodes of a disc inside a window: its words that hold any.
struct Guests {
  static constexpr std::size_t most = (2 * max_masked_radius + rows_at_once) / rows_at_once;
  Window window;
  std::size_t words;
  std::array<Rows, most> inside;
  std::array<int, most> row;  // in the window
};
static_assert(std::is_trivially_default_constructible_v<Guests>, "made for every pixel");

/// The live nodes as bits, in strips of sixteen columns. The first strip stays empty: it is what lies left and right of
/// the image.
class LiveNodes {
 public:
  LiveNodes(std::span<BitWord> memory, int width, int height, int radius)
      : bits_(reinterpret_cast<unsigned char*>(memory.data())),
        strips_((width + strip_px - 1) / strip_px),
        rows_(rows_of_strip(height)),
        radius_(radius),
        height_(std::min((2 * radius + rows_at_once) / rows_at_once * rows_at_once, rows_)),
        masks_(radius) {
    const std::size_t size = live_node_words(width, height);
    assert(memory.size() >= size);
    for (std::size_t i = 0; i < size; ++i) memory[i] = 0;
  }

  /// Word i of row y of a mask.
  void set_row(int i, int y, BitWord nodes) {
    constexpr int strips_a_word = bits_per_word / strip_px;
    for (int k = i * strips_a_word; k < std::min((i + 1) * strips_a_word, strips_); ++k, nodes >>= strip_px) {
      const auto row = static_cast<std::uint16_t>(nodes);
      std::memcpy(strip(k) + row_bytes * y, &row, sizeof row);
    }
  }

  /// Whether a disc is never wider than a window.
  [[nodiscard]] bool has_one_window() const { return 2 * radius_ < strip_px; }
  /// Calls visit(guests) with the live nodes within the radius of `centre`, window after window.
  template <typename Visit>
  void visit_disc(GridPoint centre, Visit visit) const {
    const int top = std::max(std::min(centre.y - radius_, rows_ - height_), 0);
    for (int c = 0; c <= 2 * radius_; c += strip_px) {
      const int x = centre.x - radius_ + c;
      const int left = (x + strip_px) / strip_px - 1;
      if (x <= -strip_px || left >= strips_) continue;
      Guests guests;
      guests.window = {strip(left) + row_bytes * top, strip(left + 1) + row_bytes * top,
                       static_cast<unsigned>(x) % strip_px, x, top};
      if (masks_.usable()) {
        gather(masks_.strip(c, top - centre.y + radius_), guests);
        visit(guests);
      } else {
        gather_far(centre, guests, visit);
      }
    }
  }

 private:
  [[nodiscard]] unsigned char* strip(int i) const { return bits_ + (i == strips_ ? 0 : row_bytes * (i + 1) * rows_); }
  void gather(const unsigned char* mask, Guests& guests) const {
    const Window window = guests.window;
    std::size_t words = 0;
    for (int row = 0; row < height_; row += rows_at_once) {
      const Rows inside = window.load(row) & load_rows(mask + row_bytes * row);
      guests.inside[words] = inside;  // taken when there is something in it: no branch to foresee
      guests.row[words] = row;
      words += inside != 0 ? 1U : 0U;
    }
    guests.words = words;
  }
  /// Where there are no masks: word by word.
  template <typename Visit>
  void gather_far(GridPoint centre, Guests& guests, Visit& visit) const {
    for (int row = 0; row < height_; row += rows_at_once) {
      Rows inside = 0;
      for_each_bit(guests.window.load(row), [&](int b) {
        const int dx = guests.window.x + b % strip_px - centre.x;
        const int dy = guests.window.y + row + b / strip_px - centre.y;
        if (dx <= radius_ && dx * dx + dy * dy <= radius_ * radius_) inside |= Rows{1} << b;
      });
      guests.inside[0] = inside;
      guests.row[0] = row;
      guests.words = inside != 0 ? 1U : 0U;
      visit(guests);
    }
  }

  unsigned char* bits_;
  int strips_;
  int rows_;  // of a strip
  int radius_;
  int height_;  // of a window: it covers the disc
  DiscMasks masks_;
};

}  // namespace touchline::live_nodes
