// SPDX-License-Identifier: Apache-2.0
// Which of 64 pixels are nearer in luma to the darkest than to the brightest one around them, in the compilers' own
// vector notation. Included by each file of kernels alone, and compiled there for that file's processor: everything is
// local to the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace touchline {
namespace {
namespace half_level {

#if defined(__AVX512BW__)
inline constexpr int lanes = 64;
#elif defined(__AVX2__)
inline constexpr int lanes = 32;
#else
inline constexpr int lanes = 16;
#endif
using U8 = std::uint8_t __attribute__((vector_size(lanes)));

[[gnu::always_inline]] inline U8 smaller(U8 a, U8 b) { return a < b ? a : b; }
[[gnu::always_inline]] inline U8 larger(U8 a, U8 b) { return a > b ? a : b; }
[[gnu::always_inline]] inline U8 load(const std::uint8_t* from) {
  U8 v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}

/// As many columns as lanes, from column K on: `first` has the columns from 0 on, `last` those from 4 on. 0 < K < 4.
#if defined(__SSE2__) && !defined(__AVX2__)
template <int K>
[[gnu::always_inline]] inline U8 columns_from(U8 first, U8 last) {
  const __m128i rest = _mm_srli_si128(reinterpret_cast<__m128i>(last), 12);
  return reinterpret_cast<U8>(
      _mm_or_si128(_mm_srli_si128(reinterpret_cast<__m128i>(first), K), _mm_slli_si128(rest, 16 - K)));
}
#else
template <int K, int... I>
[[gnu::always_inline]] inline U8 shifted(U8 first, U8 last, std::integer_sequence<int, I...> /*lanes*/) {
  return __builtin_shufflevector(first, last, (I + K < lanes ? I + K : lanes + I + K - 4)...);
}
template <int K>
[[gnu::always_inline]] inline U8 columns_from(U8 first, U8 last) {
  return shifted<K>(first, last, std::make_integer_sequence<int, lanes>{});
}
#endif

/// Lane i: the least of five columns from column i on.
[[gnu::always_inline]] inline U8 least_of_five(U8 first, U8 last) {
  return smaller(smaller(smaller(first, last), columns_from<1>(first, last)),
                 smaller(columns_from<2>(first, last), columns_from<3>(first, last)));
}

/// A bit a lane where a is smaller.
[[gnu::always_inline]] inline std::uint64_t bits_smaller(U8 a, U8 b) {
#if defined(__AVX512BW__)
  return _mm512_cmplt_epu8_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b));
#elif defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_epi8(reinterpret_cast<__m256i>(a < b)));
#elif defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_epi8(reinterpret_cast<__m128i>(a < b)));
#else
  std::uint64_t halves[2];
  const U8 flags = reinterpret_cast<U8>(a < b) & 1;
  __builtin_memcpy(halves, &flags, sizeof flags);
  // Byte i, at bit 8 i, moves to bit 56 + i.
  return (halves[0] * 0x0102040810204080U) >> 56 | (halves[1] * 0x0102040810204080U) >> 56 << 8;
#endif
}

/// Of one vector of pixels from `at` on.
[[gnu::always_inline]] inline std::uint64_t lanes_below(const std::uint8_t* at, std::ptrdiff_t stride) {
  const std::uint8_t* corner = at - 2 * stride - 2;
  // Columns from two to the left and from two to the right on.
  U8 darkest[2] = {load(corner), load(corner + 4)};
  U8 brightest[2] = {darkest[0], darkest[1]};
  for (int k = 1; k < 5; ++k) {
    for (int part = 0; part < 2; ++part) {
      const U8 row = load(corner + k * stride + 4 * part);
      darkest[part] = smaller(darkest[part], row);
      brightest[part] = larger(brightest[part], row);
    }
  }
  const U8 least = least_of_five(darkest[0], darkest[1]);
  const U8 most = ~least_of_five(~brightest[0], ~brightest[1]);
  // 2 luma < least + most  is  luma < their mean, rounded up.
  const U8 middle = (least | most) - (((least ^ most) >> 1) & 0x7F);
  return bits_smaller(load(at), middle);
}

/// Of 64 pixels from `at` on the `wanted` ones below the middle between the darkest and the brightest within two
/// pixels, of which all are in memory.
inline std::uint64_t below_half_level(const std::uint8_t* at, std::ptrdiff_t stride, std::uint64_t wanted) {
  constexpr std::uint64_t one_vector = ~std::uint64_t{0} >> (64 - lanes);
  std::uint64_t below = 0;
  for (int i = 0; i < 64; i += lanes) {
    if ((wanted >> i & one_vector) != 0) below |= lanes_below(at + i, stride) << i;
  }
  return below & wanted;
}

}  // namespace half_level
}  // namespace
}  // namespace touchline
