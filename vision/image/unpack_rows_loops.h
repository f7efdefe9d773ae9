// SPDX-License-Identifier: Apache-2.0
// Unpacking of rows (unpack.h), eight pixels at a time in one register: where a processor can put its bytes in any
// order. Included by files of kernels for AVX2 and later alone; everything is local to the file.
#pragma once

#include <cstdint>

namespace touchline {
namespace {
namespace unpack_rows {

using Bytes = std::uint8_t __attribute__((vector_size(16)));
using Words = std::uint16_t __attribute__((vector_size(16)));
inline constexpr int pixels = 8;

/// 24 bytes.
[[gnu::always_inline]] inline void store(Bytes first, Bytes last, std::uint8_t* out) {
  __builtin_memcpy(out, &first, sizeof first);
  __builtin_memcpy(out + sizeof first, &last, sizeof last / 2);
}

inline int yuyv(const std::uint8_t* row, int width, std::uint8_t* out) {
  int x = 0;
  for (; x + pixels <= width; x += pixels) {
    Bytes v;
    __builtin_memcpy(&v, row + 2 * x, sizeof v);
    store(__builtin_shufflevector(v, v, 0, 1, 3, 2, 1, 3, 4, 5, 7, 6, 5, 7, 8, 9, 11, 10),
          __builtin_shufflevector(v, v, 9, 11, 12, 13, 15, 14, 13, 15, 0, 0, 0, 0, 0, 0, 0, 0), out + 3 * x);
  }
  return x;
}

inline int rgb565(const std::uint8_t* row, int width, std::uint8_t* out) {
  int x = 0;
  for (; x + pixels <= width; x += pixels) {
    Words v;
    __builtin_memcpy(&v, row + 2 * x, sizeof v);
    const Words red = v >> 11, green = v >> 5 & 63, blue = v & 31;
    const Words low = (red << 3 | red >> 2) | (green << 2 | green >> 4) << 8;
    const Words high = blue << 3 | blue >> 2;
    const Bytes a = reinterpret_cast<Bytes>(low), b = reinterpret_cast<Bytes>(high);
    store(__builtin_shufflevector(a, b, 0, 1, 16, 2, 3, 18, 4, 5, 20, 6, 7, 22, 8, 9, 24, 10),
          __builtin_shufflevector(a, b, 11, 26, 12, 13, 28, 14, 15, 30, 0, 0, 0, 0, 0, 0, 0, 0), out + 3 * x);
  }
  return x;
}

inline UnpackKernels kernels() { return {yuyv, rgb565}; }

}  // namespace unpack_rows
}  // namespace
}  // namespace touchline
