// SPDX-License-Identifier: Apache-2.0
// Images of fixed storage, and views of them. Storage is templated; algorithms take views and are compiled once.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace touchline {

/// A rectangle of samples in somebody else's memory. `stride` is in samples, >= width.
template <typename T>
struct ImageView {
  T* data = nullptr;
  int width = 0;
  int height = 0;
  int stride = 0;

  [[nodiscard]] T* row(int y) const {
    assert(y >= 0 && y < height);
    return data + static_cast<std::ptrdiff_t>(y) * stride;
  }
  [[nodiscard]] T& at(int x, int y) const {
    assert(x >= 0 && x < width);
    return row(y)[x];
  }
  operator ImageView<const T>() const  // NOLINT: a writable view is a readable one
      requires(!std::is_const_v<T>) {
    return {data, width, height, stride};
  }
};

/// Storage for up to W x H samples; view() may be smaller.
template <typename T, int W, int H>
struct Image {
  static constexpr int max_width = W;
  static constexpr int max_height = H;
  std::array<T, static_cast<std::size_t>(W) * static_cast<std::size_t>(H)> samples{};

  [[nodiscard]] ImageView<T> view(int width = W, int height = H) { return {samples.data(), width, height, width}; }
  [[nodiscard]] ImageView<const T> view(int width = W, int height = H) const {
    return {samples.data(), width, height, width};
  }
};

/// Full-range YCbCr (BT.601, JPEG convention) in 4:2:0: chroma has half the width and height, rounded up.
template <typename T>
struct Yuv420 {
  ImageView<T> y;
  ImageView<T> cb;
  ImageView<T> cr;

  operator Yuv420<const T>() const  // NOLINT: a writable view is a readable one
      requires(!std::is_const_v<T>) {
    return {y, cb, cr};
  }
};
using Yuv420View = Yuv420<std::uint8_t>;
using ConstYuv420View = Yuv420<const std::uint8_t>;

}  // namespace touchline
