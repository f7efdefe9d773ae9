// SPDX-License-Identifier: Apache-2.0
// Four bytes or two halves in a word, for processors without vector registers (H. S. Warren, "Hacker's Delight", 2nd
// ed., section 2-18); one instruction where the processor has it. With it and without, the results are the same.
#pragma once

#include <bit>
#include <cstdint>

#if defined(__ARM_FEATURE_SIMD32)
#include <arm_acle.h>
#endif

namespace touchline {

/// a - b, at least 0, of each byte.
constexpr std::uint32_t portable_excess(std::uint32_t a, std::uint32_t b) {
  constexpr std::uint32_t tops = 0x80808080U;
  const std::uint32_t low_bits = (a | tops) - (b & ~tops);  // the top bit stays where nothing is borrowed
  const std::uint32_t not_less = ((a & ~b) | (~(a ^ b) & low_bits)) & tops;
  const std::uint32_t difference = low_bits ^ (~(a ^ b) & tops);
  return difference & ((not_less >> 7U) * 255U);
}
inline std::uint32_t excess(std::uint32_t a, std::uint32_t b) {
#if defined(__ARM_FEATURE_SIMD32)
  return __uqsub8(a, b);
#else
  return portable_excess(a, b);
#endif
}

/// Bytes 0 and 2, and bytes 1 and 3, as two numbers of 16 bits.
inline std::uint32_t even_bytes(std::uint32_t v) { return v & 0x00FF00FFU; }
inline std::uint32_t odd_bytes(std::uint32_t v) {
#if defined(__ARM_FEATURE_SIMD32)
  std::uint32_t halves = 0;
  __asm__("uxtb16 %0, %1, ror #8" : "=r"(halves) : "r"(v));  // the compiler's own function rotates first
  return halves;
#else
  return v >> 8U & 0x00FF00FFU;
#endif
}
/// The same added to two numbers of 16 bits, whose sums stay below 65536.
inline std::uint32_t add_even_bytes(std::uint32_t sum, std::uint32_t v) {
#if defined(__ARM_FEATURE_SIMD32)
  return __uxtab16(sum, v);
#else
  return sum + even_bytes(v);
#endif
}
inline std::uint32_t add_odd_bytes(std::uint32_t sum, std::uint32_t v) {
#if defined(__ARM_FEATURE_SIMD32)
  __asm__("uxtab16 %0, %0, %1, ror #8" : "+r"(sum) : "r"(v));
  return sum;
#else
  return sum + odd_bytes(v);
#endif
}

/// The lower halves of two words, and the upper ones.
inline std::uint32_t lower_halves(std::uint32_t a, std::uint32_t b) {
#if defined(__ARM_FEATURE_SIMD32)
  std::uint32_t both = 0;
  __asm__("pkhbt %0, %1, %2, lsl #16" : "=r"(both) : "r"(a), "r"(b));
  return both;
#else
  return (a & 0xFFFFU) | b << 16U;
#endif
}
inline std::uint32_t upper_halves(std::uint32_t a, std::uint32_t b) {
#if defined(__ARM_FEATURE_SIMD32)
  std::uint32_t both = 0;
  __asm__("pkhtb %0, %1, %2, asr #16" : "=r"(both) : "r"(b), "r"(a));
  return both;
#else
  return a >> 16U | (b & 0xFFFF0000U);
#endif
}

/// The smaller of two halves, both below 0x8000.
constexpr std::uint32_t portable_smaller_halves(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t not_less = ((a | 0x80008000U) - b) >> 15U & 0x00010001U;
  return a ^ ((a ^ b) & ((not_less << 15U) - not_less));
}
inline std::uint32_t smaller_halves(std::uint32_t a, std::uint32_t b) {
#if defined(__ARM_FEATURE_SIMD32)
  (void)__usub16(a, b);  // notes where nothing is borrowed, for the selection
  return __sel(b, a);
#else
  return portable_smaller_halves(a, b);
#endif
}

/// |half - half_bias|, for halves between 1 and 0x7FFF.
inline constexpr int half_bias = 0x4000;
constexpr std::uint32_t portable_without_bias_and_sign(std::uint32_t biased) {
  const std::uint32_t negative = 0x00010001U & ~(biased >> 14U);
  return ((biased & 0x3FFF3FFFU) ^ ((negative << 14U) - negative)) + negative;
}
inline std::uint32_t without_bias_and_sign(std::uint32_t biased) {
#if defined(__ARM_FEATURE_SIMD32)
  constexpr std::int32_t bias = half_bias * 0x00010001;
  const auto lanes = static_cast<std::int32_t>(biased);
  const auto negated = static_cast<std::uint32_t>(__ssub16(bias, lanes));
  const auto plain = static_cast<std::uint32_t>(__ssub16(lanes, bias));  // its signs are those that are selected by
  return __sel(plain, negated);
#else
  return portable_without_bias_and_sign(biased);
#endif
}

/// Of each byte.
inline std::uint32_t smaller_bytes(std::uint32_t a, std::uint32_t b) { return a - excess(a, b); }
inline std::uint32_t larger_bytes(std::uint32_t a, std::uint32_t b) { return a + excess(b, a); }

/// Of the four.
inline int smallest_byte(std::uint32_t v) {
  v = smaller_bytes(v, std::rotr(v, 16));
  return static_cast<int>(smaller_bytes(v, std::rotr(v, 8)) & 0xFFU);
}
inline int largest_byte(std::uint32_t v) {
  v = larger_bytes(v, std::rotr(v, 16));
  return static_cast<int>(larger_bytes(v, std::rotr(v, 8)) & 0xFFU);
}

}  // namespace touchline
