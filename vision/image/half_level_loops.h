// SPDX-License-Identifier: Apache-2.0
// Which of sixteen pixels are nearer in luma to the darkest than to the brightest one around them, in the compilers'
// own vector notation. Everything is local to the file that includes it.
#pragma once

#include <cstdint>
#include <cstring>

#include "vision/image/image_view.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace touchline {
namespace {
namespace half_level {

using U8x16 = std::uint8_t __attribute__((vector_size(16)));

inline U8x16 smaller(U8x16 a, U8x16 b) { return a < b ? a : b; }
inline U8x16 larger(U8x16 a, U8x16 b) { return a > b ? a : b; }

/// Columns K to K + 15 of 20, of which `first` has 0 to 15 and `last` 4 to 19. 0 < K < 4.
template <int K>
inline U8x16 columns_from(U8x16 first, U8x16 last) {
#if defined(__SSE2__)
  const __m128i rest = _mm_srli_si128(reinterpret_cast<__m128i>(last), 12);
  return reinterpret_cast<U8x16>(
      _mm_or_si128(_mm_srli_si128(reinterpret_cast<__m128i>(first), K), _mm_slli_si128(rest, 16 - K)));
#else
  const U8x16 rest = __builtin_shufflevector(last, last, 12, 13, 14, 15, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
  return __builtin_shufflevector(first, rest, K, K + 1, K + 2, K + 3, K + 4, K + 5, K + 6, K + 7, K + 8, K + 9, K + 10,
                                 K + 11, K + 12, K + 13, K + 14, K + 15);
#endif
}

/// Lane i: the least of five columns from column i on, of 20 as above.
inline U8x16 least_of_five(U8x16 first, U8x16 last) {
  const U8x16 ends = smaller(first, last);
  return smaller(smaller(ends, columns_from<1>(first, last)),
                 smaller(columns_from<2>(first, last), columns_from<3>(first, last)));
}

/// A bit a lane of a mask, whose lanes are all ones or zero.
inline std::uint32_t bits_of(U8x16 mask) {
#if defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_epi8(reinterpret_cast<__m128i>(mask)));
#else
  std::uint64_t halves[2];
  const U8x16 flags = mask & 1;
  std::memcpy(halves, &flags, sizeof flags);
  // Byte i, at bit 8 i, moves to bit 56 + i.
  const std::uint64_t low = (halves[0] * 0x0102040810204080U) >> 56;
  const std::uint64_t high = (halves[1] * 0x0102040810204080U) >> 56;
  return static_cast<std::uint32_t>(low | high << 8);
#endif
}

/// Sixteen pixels from x on, a bit each: those below the middle between the darkest and the brightest within two
/// pixels. Columns x - 2 .. x + 17 and two rows above and below are inside.
inline std::uint32_t sixteen_below(ImageView<const std::uint8_t> luma, int x, int y) {
  const auto load = [](const std::uint8_t* from) {
    U8x16 v;
    std::memcpy(&v, from, sizeof v);
    return v;
  };
  const std::uint8_t* corner = luma.row(y - 2) + x - 2;
  // Columns from x - 2 and from x + 2 on: 20 in all.
  U8x16 darkest[2] = {load(corner), load(corner + 4)};
  U8x16 brightest[2] = {darkest[0], darkest[1]};
  for (int k = 1; k < 5; ++k) {
    for (int part = 0; part < 2; ++part) {
      const U8x16 row = load(corner + k * luma.stride + 4 * part);
      darkest[part] = smaller(darkest[part], row);
      brightest[part] = larger(brightest[part], row);
    }
  }
  const U8x16 least = least_of_five(darkest[0], darkest[1]);
  const U8x16 most = ~least_of_five(~brightest[0], ~brightest[1]);
  // 2 luma < least + most  is  luma < their mean, rounded up.
  const U8x16 middle = (least | most) - (((least ^ most) >> 1) & 0x7F);
  const U8x16 below = reinterpret_cast<U8x16>(load(luma.row(y) + x) < middle);
  return bits_of(below);
}

}  // namespace half_level
}  // namespace
}  // namespace touchline
