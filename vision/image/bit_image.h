// SPDX-License-Identifier: Apache-2.0
// Masks of one bit a pixel, 64 pixels a word: pixel x of a row is bit x % 64 of word x / 64.
// Invariant of every mask: bits at and beyond `width` are zero. Outside the image every pixel counts as zero.
#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace touchline {

using BitWord = std::uint64_t;
inline constexpr int bits_per_word = 64;
static_assert(std::endian::native == std::endian::little, "pixel x is bit x % 8 of byte x / 8, too");
constexpr int words_for(int width) { return (width + bits_per_word - 1) / bits_per_word; }

template <typename W>
struct BasicBitView {
  W* words = nullptr;
  int width = 0;
  int height = 0;
  int stride = 0;  // words a row

  [[nodiscard]] W* row(int y) const {
    assert(y >= 0 && y < height);
    return words + static_cast<std::ptrdiff_t>(y) * stride;
  }
  /// False outside the image.
  [[nodiscard]] bool get(int x, int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return false;
    // By the byte: words of 64 bits take small processors several steps to shift.
    const auto* bytes = reinterpret_cast<const unsigned char*>(row(y));
    const unsigned byte = bytes[static_cast<unsigned>(x) / 8U];
    return ((byte >> (static_cast<unsigned>(x) % 8U)) & 1U) != 0;
  }
  void set(int x, int y, bool value) const requires(!std::is_const_v<W>) {
    assert(x >= 0 && x < width);
    const auto column = static_cast<unsigned>(x);
    const unsigned bit = 1U << (column % 8U);
    unsigned char& byte = reinterpret_cast<unsigned char*>(row(y))[column / 8U];
    byte = static_cast<unsigned char>(value ? (byte | bit) : (byte & ~bit));
  }
  operator BasicBitView<const W>() const  // NOLINT: a writable view is a readable one
      requires(!std::is_const_v<W>) {
    return {words, width, height, stride};
  }
};
using BitView = BasicBitView<BitWord>;
using ConstBitView = BasicBitView<const BitWord>;

/// Storage for a mask of up to W x H pixels.
template <int W, int H>
struct BitImage {
  static constexpr int max_width = W;
  static constexpr int max_height = H;
  std::array<BitWord, static_cast<std::size_t>(words_for(W)) * static_cast<std::size_t>(H)> words{};

  [[nodiscard]] BitView view(int width = W, int height = H) { return {words.data(), width, height, words_for(width)}; }
  [[nodiscard]] ConstBitView view(int width = W, int height = H) const {
    return {words.data(), width, height, words_for(width)};
  }
};

}  // namespace touchline
