// SPDX-License-Identifier: Apache-2.0
// Rows of 32 pixels in the compilers' own vector notation, for the search for ridges (ridge_search_loops.h). Everything
// is local to the file that includes it.
#pragma once

#include <cstdint>

#include "vision/image/ridge_reaches_loops.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace touchline {
namespace {
namespace ridge {

#if defined(__AVX2__)
inline constexpr int lanes = 16;
#else
inline constexpr int lanes = 8;
#endif
using I16 = std::int16_t __attribute__((vector_size(2 * lanes)));
using U8 = std::uint8_t __attribute__((vector_size(lanes)));

/// A bit a pixel of a strip's row, row by row; and the same in the window: from `margin_px` to the left of the column
/// to as many to its right.
using Rows = std::uint32_t __attribute__((vector_size(32)));
using Windows = std::uint64_t __attribute__((vector_size(64)));

[[gnu::always_inline]] inline I16 load_bytes(const std::uint8_t* from) {
#if defined(__AVX2__)
  return reinterpret_cast<I16>(_mm256_cvtepu8_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from))));
#elif defined(__SSE2__)
  return reinterpret_cast<I16>(
      _mm_unpacklo_epi8(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from)), _mm_setzero_si128()));
#else
  U8 v;
  __builtin_memcpy(&v, from, sizeof v);
  return __builtin_convertvector(v, I16);
#endif
}

/// A row of the column: 32 numbers of 16 bits, in as many vectors as that takes.
struct Pixels {
  static constexpr int parts = column_px / lanes;
  I16 part[parts];

  Pixels() = default;
  [[gnu::always_inline]] explicit Pixels(const std::int16_t* from) {
    for (int i = 0; i < parts; ++i) __builtin_memcpy(&part[i], from + i * lanes, sizeof(I16));
  }
  [[gnu::always_inline]] explicit Pixels(const std::uint8_t* from) {
    for (int i = 0; i < parts; ++i) part[i] = load_bytes(from + i * lanes);
  }
  [[gnu::always_inline]] void store(std::int16_t* to) const {
    for (int i = 0; i < parts; ++i) __builtin_memcpy(to + i * lanes, &part[i], sizeof(I16));
  }
};
template <typename Operation>
[[gnu::always_inline]] inline Pixels each(const Pixels& a, const Pixels& b, Operation operation) {
  Pixels out;
  for (int i = 0; i < Pixels::parts; ++i) out.part[i] = operation(a.part[i], b.part[i]);
  return out;
}
[[gnu::always_inline]] inline Pixels operator+(const Pixels& a, const Pixels& b) {
  return each(
      a, b, [](I16 x, I16 y) __attribute__((always_inline)) { return x + y; });
}
[[gnu::always_inline]] inline Pixels operator-(const Pixels& a, const Pixels& b) {
  return each(
      a, b, [](I16 x, I16 y) __attribute__((always_inline)) { return x - y; });
}
[[gnu::always_inline]] inline Pixels larger(const Pixels& a, const Pixels& b) {
  return each(
      a, b, [](I16 x, I16 y) __attribute__((always_inline)) { return x > y ? x : y; });
}
/// A sixteenth more.
[[gnu::always_inline]] inline Pixels with_sixteenth(const Pixels& a) {
  return each(
      a, a, [](I16 x, I16) __attribute__((always_inline)) { return x + (x >> 4); });
}
[[gnu::always_inline]] inline Pixels all(std::int16_t value) {
  Pixels out;
  for (I16& v : out.part) v = value - I16{};
  return out;
}

/// A bit a pixel where it is larger than a number.
#if defined(__AVX2__)
[[gnu::always_inline]] inline std::uint32_t bits_above(const Pixels& v, std::int16_t least) {
  const __m256i bytes =
      _mm256_packs_epi16(reinterpret_cast<__m256i>(v.part[0] > least), reinterpret_cast<__m256i>(v.part[1] > least));
  return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_permute4x64_epi64(bytes, 0xD8)));
}
#elif defined(__SSE2__)
[[gnu::always_inline]] inline std::uint32_t bits_above(const Pixels& v, std::int16_t least) {
  const auto half = [&](int i) __attribute__((always_inline)) {
    return static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(
        reinterpret_cast<__m128i>(v.part[i] > least), reinterpret_cast<__m128i>(v.part[i + 1] > least))));
  };
  return half(0) | half(2) << 16;
}
#else
[[gnu::always_inline]] inline std::uint32_t bits_above(const Pixels& v, std::int16_t least) {
  std::uint32_t bits = 0;
  for (int i = 0; i < Pixels::parts; ++i) {
    const U8 bytes = __builtin_convertvector((v.part[i] > least) & 1, U8);
    std::uint64_t flags = 0;
    __builtin_memcpy(&flags, &bytes, sizeof flags);
    // Byte k, at bit 8 k, moves to bit 56 + k.
    bits |= static_cast<std::uint32_t>((flags * 0x0102040810204080U) >> 56) << (i * lanes);
  }
  return bits;
}
#endif
/// The same of eight rows. Not by way of memory: what is stored in parts and loaded as a whole has to wait.
[[gnu::always_inline]] inline Rows bits_above(const Pixels (&rows)[strip_rows], std::int16_t least) {
  return Rows{bits_above(rows[0], least), bits_above(rows[1], least), bits_above(rows[2], least),
              bits_above(rows[3], least), bits_above(rows[4], least), bits_above(rows[5], least),
              bits_above(rows[6], least), bits_above(rows[7], least)};
}

}  // namespace ridge
}  // namespace
}  // namespace touchline
