// SPDX-License-Identifier: Apache-2.0
// Images drawn as text, so that a vision test shows what it tests. Bits: '#' is set, anything else is not.
// Gray: a digit is itself times a scale. Heap is fine here: this is test support.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vision/image/bit_image.h"
#include "vision/image/image_view.h"

namespace touchline::test {

/// A mask of any size with storage of its own. Converts to views.
struct Bits {
  int width = 0;
  int height = 0;
  std::vector<BitWord> words;

  Bits() = default;
  Bits(int w, int h)
      : width(w), height(h), words(static_cast<std::size_t>(words_for(w)) * static_cast<std::size_t>(h)) {}
  [[nodiscard]] BitView view() { return {words.data(), width, height, words_for(width)}; }
  [[nodiscard]] ConstBitView view() const { return {words.data(), width, height, words_for(width)}; }
  bool operator==(const Bits&) const = default;
};

/// bits({"..##..", ".####."}); rows shorter than the first are filled with zeros.
inline Bits bits(const std::vector<std::string_view>& rows) {
  Bits image(rows.empty() ? 0 : static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
  for (int y = 0; y < image.height; ++y) {
    const std::string_view row = rows[static_cast<std::size_t>(y)];
    for (int x = 0; x < image.width && x < static_cast<int>(row.size()); ++x) {
      if (row[static_cast<std::size_t>(x)] == '#') image.view().set(x, y, true);
    }
  }
  return image;
}

/// One line of text a row, with a line feed before the first, so that two pictures stand below each other in a report.
inline std::string ascii(ConstBitView image) {
  std::string text;
  for (int y = 0; y < image.height; ++y) {
    text += '\n';
    for (int x = 0; x < image.width; ++x) text += image.get(x, y) ? '#' : '.';
  }
  return text;
}
inline std::string ascii(const Bits& image) { return ascii(image.view()); }

/// The invariant of every mask: nothing is set at and beyond the width.
inline bool padding_is_clear(ConstBitView image) {
  const int used = image.width % bits_per_word;
  for (int y = 0; y < image.height && used != 0; ++y) {
    if ((image.row(y)[words_for(image.width) - 1] >> used) != 0) return false;
  }
  return true;
}

/// Each pixel is set with the given probability. Same seed, same image.
inline Bits random_bits(int width, int height, int percent, unsigned seed) {
  std::mt19937 random(seed);
  Bits image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.view().set(x, y, static_cast<int>(random() % 100) < percent);
  }
  return image;
}

/// Sizes that go wrong first: nothing, one and two pixels, around the word, and the working sizes.
inline const std::vector<std::pair<int, int>>& awkward_sizes() {
  static const std::vector<std::pair<int, int>> sizes = {
      {0, 0},  {0, 5},  {5, 0},  {1, 1},  {1, 9},   {9, 1},   {2, 2},   {2, 9},   {9, 2},  {3, 3},
      {63, 7}, {64, 7}, {65, 7}, {64, 1}, {128, 3}, {129, 3}, {320, 9}, {512, 3}, {640, 5}};
  return sizes;
}

/// Samples with storage of their own.
template <typename T>
struct Samples {
  int width = 0;
  int height = 0;
  std::vector<T> samples;

  Samples() = default;
  Samples(int w, int h, T value = T{})
      : width(w), height(h), samples(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}
  [[nodiscard]] ImageView<T> view() { return {samples.data(), width, height, width}; }
  [[nodiscard]] ImageView<const T> view() const { return {samples.data(), width, height, width}; }
  bool operator==(const Samples&) const = default;
};
using Gray = Samples<std::uint8_t>;

/// gray({"0129", "3459"}, 28): digits times the scale.
inline Gray gray(const std::vector<std::string_view>& rows, int scale = 1) {
  Gray image(rows.empty() ? 0 : static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const char digit = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
      image.view().at(x, y) = static_cast<std::uint8_t>((digit - '0') * scale);
    }
  }
  return image;
}

}  // namespace touchline::test
