// SPDX-License-Identifier: Apache-2.0
// The loops of edge_rows.h in the compilers' own vector notation. Included by each file of kernels alone, and compiled
// there for that file's processor: everything is local to the file.
#pragma once

#include "vision/image/edge_rows.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace touchline {
namespace {
namespace edge_rows {

#if defined(__AVX512BW__)
inline constexpr int lanes = 32;
#elif defined(__AVX2__)
inline constexpr int lanes = 16;
#else
inline constexpr int lanes = 8;
#endif
using I16 = std::int16_t __attribute__((vector_size(2 * lanes)));
using U16 = std::uint16_t __attribute__((vector_size(2 * lanes)));
using I32 = std::int32_t __attribute__((vector_size(2 * lanes)));  // half as many
using U8 = std::uint8_t __attribute__((vector_size(lanes)));

template <typename T>
[[gnu::always_inline]] inline I16 load(const T* from) {
  static_assert(sizeof(T) == 2);
  I16 v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
[[gnu::always_inline]] inline I16 load_bytes(const std::uint8_t* from) {
#if defined(__AVX512BW__)
  return reinterpret_cast<I16>(_mm512_cvtepu8_epi16(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from))));
#elif defined(__AVX2__)
  return reinterpret_cast<I16>(_mm256_cvtepu8_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from))));
#elif defined(__SSE2__)
  const __m128i bytes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from));
  return reinterpret_cast<I16>(_mm_unpacklo_epi8(bytes, _mm_setzero_si128()));
#else
  U8 v;
  __builtin_memcpy(&v, from, sizeof v);
  return __builtin_convertvector(v, I16);
#endif
}
template <typename T>
[[gnu::always_inline]] inline void store(I16 v, T* to) {
  static_assert(sizeof(T) == 2);
  __builtin_memcpy(to, &v, sizeof v);
}

[[gnu::always_inline]] inline I16 larger(I16 a, I16 b) { return a > b ? a : b; }
[[gnu::always_inline]] inline I16 smaller(I16 a, I16 b) { return a < b ? a : b; }
[[gnu::always_inline]] inline I16 absolute(I16 v) { return larger(v, -v); }
[[gnu::always_inline]] inline I16 all(int value) { return static_cast<std::int16_t>(value) - I16{}; }

/// A bit a lane of a mask, whose lanes are all ones or zero.
[[gnu::always_inline]] inline std::uint32_t bits_of(I16 mask) {
#if defined(__AVX512BW__)
  return _mm512_movepi16_mask(reinterpret_cast<__m512i>(mask));
#elif defined(__AVX2__)
  const __m256i v = reinterpret_cast<__m256i>(mask);
  const __m128i bytes = _mm_packs_epi16(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
  return static_cast<std::uint32_t>(_mm_movemask_epi8(bytes));
#elif defined(__SSE2__)
  const __m128i v = reinterpret_cast<__m128i>(mask);
  return static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(v, _mm_setzero_si128())));
#else
  const U8 bytes = __builtin_convertvector(mask & 1, U8);
  std::uint64_t flags = 0;
  __builtin_memcpy(&flags, &bytes, sizeof flags);
  return static_cast<std::uint32_t>((flags * 0x0102040810204080U) >> 56);  // byte i, at bit 8 i, moves to bit 56 + i
#endif
}

[[gnu::always_inline]] inline int absolute(int v) { return v < 0 ? -v : v; }

/// The row from x0 - 2 on, as it is or a copy where it ends within the block.
inline constexpr int padded_px = edge_block_px + 4;
[[gnu::always_inline]] inline const std::uint8_t* padded(const std::uint8_t* luma, int width, int x0,
                                                         std::uint8_t (&copy)[padded_px]) {
  constexpr int inner_px = padded_px - 2;
  if (x0 >= 2 && x0 + edge_block_px + 2 <= width) return luma + x0 - 2;
  if (x0 == 0 && width >= inner_px) {
    copy[0] = luma[1];
    copy[1] = luma[0];
    __builtin_memcpy(copy + 2, luma, inner_px);
  } else if (x0 >= 2 && x0 + edge_block_px == width) {
    __builtin_memcpy(copy, luma + x0 - 2, inner_px);
    copy[inner_px] = luma[width - 1];
    copy[inner_px + 1] = luma[width - 2];
  } else {
    for (int i = 0; i < padded_px; ++i) {
      const int x = x0 - 2 + i;
      const int inside = x < 0 ? -1 - x : x >= width ? 2 * width - 1 - x : x;
      copy[i] = luma[inside < 0 ? 0 : inside >= width ? width - 1 : inside];
    }
  }
  return copy;
}

inline void smooth(const std::uint8_t* luma, int width, std::uint64_t blocks, std::int16_t* steps, std::int16_t* sums) {
  for (; blocks != 0; blocks &= blocks - 1) {
    const int x0 = __builtin_ctzll(blocks) * edge_block_px;
    std::uint8_t copy[padded_px];
    const std::uint8_t* from = padded(luma, width, x0, copy);
    for (int i = 0; i < edge_block_px; i += lanes) {
      const I16 a = load_bytes(from + i), b = load_bytes(from + i + 1), c = load_bytes(from + i + 2);
      const I16 d = load_bytes(from + i + 3), e = load_bytes(from + i + 4);
      const I16 step = d - b;
      store(e - a + step + step, steps + x0 + i);
      store(a + e + ((b + d + c) << 2) + c + c, sums + x0 + i);
    }
  }
}

inline std::uint32_t gradients(const EdgeGradients& rows, int x0, int threshold) {
  std::uint32_t bits = 0;
  const I16 bar = all(threshold - 1);
  for (int i = 0; i < edge_block_px; i += lanes) {
    const int x = x0 + i;
    const I16 middle = load(rows.steps[2] + x);
    const I16 inner = load(rows.steps[1] + x) + load(rows.steps[3] + x) + middle;
    const I16 dx = load(rows.steps[0] + x) + load(rows.steps[4] + x) + (inner << 2) + middle + middle;
    const I16 near = load(rows.sums[3] + x) - load(rows.sums[1] + x);
    const I16 dy = load(rows.sums[4] + x) - load(rows.sums[0] + x) + near + near;
    const I16 ax = absolute(dx);
    const I16 ay = absolute(dy);
    const U16 three = reinterpret_cast<U16>(smaller(ax, ay)) * 3;  // up to 48,960
    const I16 magnitude = larger(ax, ay) + reinterpret_cast<I16>(three >> 3);
    store(dx, rows.gx + x);
    store(dy, rows.gy + x);
    store(magnitude, rows.magnitude + x);
    bits |= bits_of(magnitude > bar) << i;
  }
  if (x0 + edge_block_px > rows.width) rows.magnitude[rows.width] = 0;
  return bits;
}

[[gnu::always_inline]] inline I16 pick(I16 mask, I16 yes, I16 no) {
#if defined(__AVX2__) && !defined(__AVX512BW__)
  return reinterpret_cast<I16>(_mm256_blendv_epi8(reinterpret_cast<__m256i>(no), reinterpret_cast<__m256i>(yes),
                                                  reinterpret_cast<__m256i>(mask)));
#else
  return (mask & yes) | (~mask & no);
#endif
}

/// Lanes where a * u + b * v, exactly, is more than `bar`, whose lanes are 0 or -1. |a|, |b| < 2^15, the sum < 2^31.
[[gnu::always_inline]] inline I16 product_exceeds(I16 a, I16 b, I16 u, I16 v, I16 bar) {
#if defined(__AVX512BW__)
  const __m512i x = reinterpret_cast<__m512i>(a), y = reinterpret_cast<__m512i>(b);
  const __m512i p = reinterpret_cast<__m512i>(u), q = reinterpret_cast<__m512i>(v);
  const __m512i t = reinterpret_cast<__m512i>(bar);
  const __mmask16 low = _mm512_cmpgt_epi32_mask(
      _mm512_madd_epi16(_mm512_unpacklo_epi16(x, y), _mm512_unpacklo_epi16(p, q)), _mm512_unpacklo_epi16(t, t));
  const __mmask16 high = _mm512_cmpgt_epi32_mask(
      _mm512_madd_epi16(_mm512_unpackhi_epi16(x, y), _mm512_unpackhi_epi16(p, q)), _mm512_unpackhi_epi16(t, t));
  return reinterpret_cast<I16>(_mm512_packs_epi32(_mm512_movm_epi32(low), _mm512_movm_epi32(high)));
#elif defined(__AVX2__)
  const __m256i x = reinterpret_cast<__m256i>(a), y = reinterpret_cast<__m256i>(b);
  const __m256i p = reinterpret_cast<__m256i>(u), q = reinterpret_cast<__m256i>(v);
  const __m256i t = reinterpret_cast<__m256i>(bar);
  const __m256i low = _mm256_cmpgt_epi32(_mm256_madd_epi16(_mm256_unpacklo_epi16(x, y), _mm256_unpacklo_epi16(p, q)),
                                         _mm256_unpacklo_epi16(t, t));
  const __m256i high = _mm256_cmpgt_epi32(_mm256_madd_epi16(_mm256_unpackhi_epi16(x, y), _mm256_unpackhi_epi16(p, q)),
                                          _mm256_unpackhi_epi16(t, t));
  return reinterpret_cast<I16>(_mm256_packs_epi32(low, high));
#elif defined(__SSE2__)
  const __m128i x = reinterpret_cast<__m128i>(a), y = reinterpret_cast<__m128i>(b);
  const __m128i p = reinterpret_cast<__m128i>(u), q = reinterpret_cast<__m128i>(v);
  const __m128i t = reinterpret_cast<__m128i>(bar);
  const __m128i low =
      _mm_cmpgt_epi32(_mm_madd_epi16(_mm_unpacklo_epi16(x, y), _mm_unpacklo_epi16(p, q)), _mm_unpacklo_epi16(t, t));
  const __m128i high =
      _mm_cmpgt_epi32(_mm_madd_epi16(_mm_unpackhi_epi16(x, y), _mm_unpackhi_epi16(p, q)), _mm_unpackhi_epi16(t, t));
  return reinterpret_cast<I16>(_mm_packs_epi32(low, high));
#else
  using I16x4 = std::int16_t __attribute__((vector_size(8)));
  const auto half = [&](auto part) {
    const auto wide = [&](I16 w) { return __builtin_convertvector(part(w), I32); };
    return __builtin_convertvector(wide(a) * wide(u) + wide(b) * wide(v) > wide(bar), I16x4);
  };
  const I16x4 low = half([](I16 w) { return __builtin_shufflevector(w, w, 0, 1, 2, 3); });
  const I16x4 high = half([](I16 w) { return __builtin_shufflevector(w, w, 4, 5, 6, 7); });
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
#endif
}

/// The maxima among all lanes from x on. The gradient's line meets the neighbours' ring at least / most of the way from
/// a side, in a row or a column with the pixel, to a corner; on the other side likewise. Of two equal neighbours the
/// one against the gradient's direction stays.
[[gnu::always_inline]] inline I16 maxima_at(const EdgeNeighbours& rows, int x) {
  const I16 gx = load(rows.gx + x);
  const I16 gy = load(rows.gy + x);
  const I16 ax = absolute(gx);
  const I16 ay = absolute(gy);
  const I16 flat = ay > ax;
  const I16 falling = (gx < 0) ^ (gy < 0);  // the corners are upper right and lower left
  const I16 back = pick(flat, gy, gx) < 0;  // the gradient leads up, or left
  const I16 upper_right = load(rows.above + x + 1);
  const I16 lower_left = load(rows.below + x - 1);
  const I16 first_corner = pick(falling, pick(flat, lower_left, upper_right), load(rows.below + x + 1));
  const I16 last_corner = pick(falling, pick(flat, upper_right, lower_left), load(rows.above + x - 1));
  const I16 first_side = pick(flat, load(rows.below + x), load(rows.here + x + 1));
  const I16 last_side = pick(flat, load(rows.above + x), load(rows.here + x - 1));
  const I16 here = load(rows.here + x);
  const I16 least = smaller(ax, ay);
  const I16 rest = larger(ax, ay) - least;
  return product_exceeds(here - first_side, here - first_corner, rest, least, back) &
         product_exceeds(here - last_side, here - last_corner, rest, least, ~back);
}

[[gnu::always_inline]] inline bool is_maximum(const EdgeNeighbours& rows, int x) {
  const int gx = rows.gx[x];
  const int gy = rows.gy[x];
  const int ax = absolute(gx);
  const int ay = absolute(gy);
  const int sx = gx < 0 ? -1 : 1;
  const std::uint16_t* ahead = gy < 0 ? rows.above : rows.below;
  const std::uint16_t* behind = gy < 0 ? rows.below : rows.above;
  const int side_ahead = ax >= ay ? rows.here[x + sx] : ahead[x];
  const int side_behind = ax >= ay ? rows.here[x - sx] : behind[x];
  const int least = ax < ay ? ax : ay;
  const int most = ax + ay - least;
  const int here = rows.here[x] * most;
  return here > side_ahead * (most - least) + ahead[x + sx] * least &&
         here >= side_behind * (most - least) + behind[x - sx] * least;
}

inline EdgeMaxima maxima(const EdgeNeighbours& rows, int x0, std::uint64_t candidates, int threshold) {
  constexpr std::uint64_t one_vector = (std::uint64_t{1} << lanes) - 1;
  const I16 bar = all(threshold - 1);
  EdgeMaxima found;
  for (int i = 0; i < 64; i += lanes) {
    const std::uint64_t wanted = candidates >> i & one_vector;
    if (wanted == 0) continue;
    const int x = x0 + i;
    if (x + lanes <= rows.width) {
      const std::uint64_t weak = bits_of(maxima_at(rows, x)) & wanted;
      found.weak |= weak << i;
      found.strong |= (bits_of(load(rows.here + x) > bar) & weak) << i;
      continue;
    }
    for (int k = 0; x + k < rows.width; ++k) {  // a row's last columns
      if ((wanted >> k & 1U) == 0 || !is_maximum(rows, x + k)) continue;
      found.weak |= std::uint64_t{1} << (i + k);
      if (rows.here[x + k] >= threshold) found.strong |= std::uint64_t{1} << (i + k);
    }
  }
  return found;
}

inline void direction_at(const EdgeLuma& luma, int x, std::uint64_t flag, EdgeDirections& found) {
  const int left = x > 0 ? x - 1 : 0;
  const int right = x + 1 < luma.width ? x + 1 : x;
  const std::uint8_t *a = luma.above, *h = luma.here, *b = luma.below;
  const int gx = a[right] + 2 * h[right] + b[right] - a[left] - 2 * h[left] - b[left];
  const int gy = b[left] + 2 * b[x] + b[right] - a[left] - 2 * a[x] - a[right];
  if (absolute(gx) >= absolute(gy)) found.along_row |= flag;
  if (gx >= 0) found.right |= flag;
  if (gy >= 0) found.below |= flag;
}

inline EdgeDirections directions(const EdgeLuma& luma, int x0, std::uint64_t wanted) {
  constexpr std::uint64_t one_vector = (std::uint64_t{1} << lanes) - 1;
  EdgeDirections found;
  for (int i = 0; i < 64; i += lanes) {
    const std::uint64_t here = wanted >> i & one_vector;
    if (here == 0) continue;
    const int x = x0 + i;
    if (x < 1 || x + lanes + 1 > luma.width) {
      for (int k = 0; k < lanes; ++k) {
        if ((here >> k & 1U) != 0) direction_at(luma, x + k, std::uint64_t{1} << (i + k), found);
      }
      continue;
    }
    const I16 step_left = load_bytes(luma.below + x - 1) - load_bytes(luma.above + x - 1);
    const I16 step_right = load_bytes(luma.below + x + 1) - load_bytes(luma.above + x + 1);
    const I16 step = load_bytes(luma.below + x) - load_bytes(luma.above + x);
    const I16 gy = step_left + step + step + step_right;
    const I16 run = load_bytes(luma.here + x + 1) - load_bytes(luma.here + x - 1);
    const I16 gx = load_bytes(luma.above + x + 1) + load_bytes(luma.below + x + 1) - load_bytes(luma.above + x - 1) -
                   load_bytes(luma.below + x - 1) + run + run;
    found.along_row |= std::uint64_t{bits_of(absolute(gx) >= absolute(gy))} << i;
    found.right |= std::uint64_t{bits_of(gx >= 0)} << i;
    found.below |= std::uint64_t{bits_of(gy >= 0)} << i;
  }
  return found;
}

inline EdgeKernels kernels() { return {smooth, gradients, maxima, directions}; }

}  // namespace edge_rows
}  // namespace
}  // namespace touchline
