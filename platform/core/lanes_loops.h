// SPDX-License-Identifier: Apache-2.0
// One float, eight or sixteen of them, behind the same names, so that a loop is written once for all. Included by files
// of kernels alone, and compiled there for that file's processor: everything is local to the file, and no function of
// another header is called. Each operation is rounded as the one on a float.
#pragma once

#include <cstdint>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

// Vectors wider than the usual registers never leave these files: no calling convention is touched.
#pragma GCC diagnostic ignored "-Wpsabi"
#if defined(__AVX512F__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // g++ 12 finds it in its own header (bug 105593)
#endif

namespace touchline {
namespace {

/// One lane.
struct One {
  using F = float;
  using I = std::int32_t;
  using M = bool;
  static constexpr int lanes = 1;
};
/// Eight lanes.
struct Eight {
  using F = float __attribute__((vector_size(32)));
  using I = int __attribute__((vector_size(32)));  // as comparisons make them, also where int32_t is a long
  using M = I;                                     // all bits or none
  static constexpr int lanes = 8;
};
#if defined(__AVX512F__)
/// Sixteen lanes.
struct Sixteen {
  using F = float __attribute__((vector_size(64)));
  using I = int __attribute__((vector_size(64)));
  using M = I;
  static constexpr int lanes = 16;
};
#endif

template <class L>
[[gnu::always_inline]] inline typename L::F load(const float* from) {
  typename L::F v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
template <class L>
[[gnu::always_inline]] inline typename L::I load(const std::int32_t* from) {
  typename L::I v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
template <class T, class V>
[[gnu::always_inline]] inline void store(T* to, V v) {
  __builtin_memcpy(to, &v, sizeof v);
}
template <class M, class T>
[[gnu::always_inline]] inline T choose(M m, T yes, T no) {
  return m ? yes : no;
}
template <class F>
[[gnu::always_inline]] inline F least(F a, F b) {
  return a < b ? a : b;
}
template <class F>
[[gnu::always_inline]] inline F most(F a, F b) {
  return a > b ? a : b;
}

/// `a` without what is in `b`, both comparisons' results.
[[gnu::always_inline]] inline bool without(bool a, bool b) { return a && !b; }
template <class M>
[[gnu::always_inline]] inline M without(M a, M b) {
  return a & ~b;
}

[[gnu::always_inline]] inline float magnitude(float a) { return __builtin_fabsf(a); }
[[gnu::always_inline]] inline Eight::F magnitude(Eight::F a) {
  return reinterpret_cast<Eight::F>(reinterpret_cast<Eight::I>(a) & 0x7FFFFFFF);
}
/// `a` where `sign` is not negative, else -a. `sign` may be minus zero, which counts as negative.
[[gnu::always_inline]] inline float with_sign(float a, float sign) { return __builtin_signbit(sign) != 0 ? -a : a; }
[[gnu::always_inline]] inline Eight::F with_sign(Eight::F a, Eight::F sign) {
  return reinterpret_cast<Eight::F>(reinterpret_cast<Eight::I>(a) ^
                                    (reinterpret_cast<Eight::I>(sign) & static_cast<std::int32_t>(0x80000000U)));
}

/// The number's own bits.
[[gnu::always_inline]] inline std::int32_t bits_of(float a) { return __builtin_bit_cast(std::int32_t, a); }
[[gnu::always_inline]] inline Eight::I bits_of(Eight::F a) { return reinterpret_cast<Eight::I>(a); }
[[gnu::always_inline]] inline float from_bits(std::int32_t a) { return __builtin_bit_cast(float, a); }
[[gnu::always_inline]] inline Eight::F from_bits(Eight::I a) { return reinterpret_cast<Eight::F>(a); }

[[gnu::always_inline]] inline std::int32_t truncated(float a) { return static_cast<std::int32_t>(a); }
[[gnu::always_inline]] inline Eight::I truncated(Eight::F a) { return __builtin_convertvector(a, Eight::I); }
[[gnu::always_inline]] inline float as_float(std::int32_t a) { return static_cast<float>(a); }
[[gnu::always_inline]] inline Eight::F as_float(Eight::I a) { return __builtin_convertvector(a, Eight::F); }

/// The same in every lane.
template <class L>
[[gnu::always_inline]] inline typename L::F all(float a) {
  return a - typename L::F{};
}

[[gnu::always_inline]] inline float root(float a) { return __builtin_sqrtf(a); }
template <class L>
[[gnu::always_inline]] inline typename L::I whole(std::int32_t a) {
  return static_cast<int>(a) - typename L::I{};
}

#if defined(__AVX512F__)
[[gnu::always_inline]] inline Sixteen::F magnitude(Sixteen::F a) {
  return reinterpret_cast<Sixteen::F>(reinterpret_cast<Sixteen::I>(a) & 0x7FFFFFFF);
}
[[gnu::always_inline]] inline Sixteen::F with_sign(Sixteen::F a, Sixteen::F sign) {
  return reinterpret_cast<Sixteen::F>(reinterpret_cast<Sixteen::I>(a) ^
                                      (reinterpret_cast<Sixteen::I>(sign) & static_cast<std::int32_t>(0x80000000U)));
}
[[gnu::always_inline]] inline Sixteen::I bits_of(Sixteen::F a) { return reinterpret_cast<Sixteen::I>(a); }
[[gnu::always_inline]] inline Sixteen::F from_bits(Sixteen::I a) { return reinterpret_cast<Sixteen::F>(a); }
[[gnu::always_inline]] inline Sixteen::I truncated(Sixteen::F a) { return __builtin_convertvector(a, Sixteen::I); }
[[gnu::always_inline]] inline Sixteen::F as_float(Sixteen::I a) { return __builtin_convertvector(a, Sixteen::F); }
[[gnu::always_inline]] inline Sixteen::F root(Sixteen::F a) {
  return reinterpret_cast<Sixteen::F>(_mm512_sqrt_ps(reinterpret_cast<__m512>(a)));
}
[[gnu::always_inline]] inline bool any(Sixteen::I m) {
  return _mm512_test_epi32_mask(reinterpret_cast<__m512i>(m), reinterpret_cast<__m512i>(m)) != 0;
}
[[gnu::always_inline]] inline Sixteen::I word_at(const std::uint8_t* from, Sixteen::I at) {
  return reinterpret_cast<Sixteen::I>(_mm512_i32gather_epi32(reinterpret_cast<__m512i>(at), from, 1));
}
[[gnu::always_inline]] inline Sixteen::F byte_at(const std::uint8_t* from, Sixteen::I at) {
  return as_float(word_at(from, at) & 255);
}
[[gnu::always_inline]] inline Sixteen::F float_at(const float* from, Sixteen::I at) {
  return reinterpret_cast<Sixteen::F>(_mm512_i32gather_ps(reinterpret_cast<__m512i>(at), from, 4));
}
#endif
[[gnu::always_inline]] inline Eight::F root(Eight::F a) {
#if defined(__AVX2__)
  return reinterpret_cast<Eight::F>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a)));
#else
  Eight::F r;
  for (int i = 0; i < 8; ++i) r[i] = __builtin_sqrtf(a[i]);
  return r;
#endif
}

[[gnu::always_inline]] inline bool any(bool m) { return m; }
[[gnu::always_inline]] inline bool any(Eight::I m) {
#if defined(__AVX2__)
  return _mm256_movemask_ps(reinterpret_cast<__m256>(m)) != 0;
#else
  std::uint64_t parts[4];
  __builtin_memcpy(parts, &m, sizeof parts);
  return (parts[0] | parts[1] | parts[2] | parts[3]) != 0;
#endif
}

/// The four bytes from each index on, and the float at each.
[[gnu::always_inline]] inline std::int32_t word_at(const std::uint8_t* from, std::int32_t at) {
  std::int32_t v;
  __builtin_memcpy(&v, from + at, sizeof v);
  return v;
}
[[gnu::always_inline]] inline Eight::I word_at(const std::uint8_t* from, Eight::I at) {
#if defined(__AVX2__)
  return reinterpret_cast<Eight::I>(
      _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), reinterpret_cast<__m256i>(at), 1));
#else
  Eight::I v;
  for (int i = 0; i < 8; ++i) v[i] = word_at(from, static_cast<std::int32_t>(at[i]));
  return v;
#endif
}
[[gnu::always_inline]] inline float float_at(const float* from, std::int32_t at) { return from[at]; }
[[gnu::always_inline]] inline Eight::F float_at(const float* from, Eight::I at) {
#if defined(__AVX2__)
  return reinterpret_cast<Eight::F>(_mm256_i32gather_ps(from, reinterpret_cast<__m256i>(at), 4));
#else
  Eight::F v;
  for (int i = 0; i < 8; ++i) v[i] = from[at[i]];
  return v;
#endif
}

/// The byte at each index; three more behind it may be read.
[[gnu::always_inline]] inline float byte_at(const std::uint8_t* from, std::int32_t at) {
  return static_cast<float>(from[at]);
}
[[gnu::always_inline]] inline Eight::F byte_at(const std::uint8_t* from, Eight::I at) {
#if defined(__AVX2__)
  const __m256i words = _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), reinterpret_cast<__m256i>(at), 1);
  return as_float(reinterpret_cast<Eight::I>(words) & 255);
#else
  Eight::I v;
  for (int i = 0; i < 8; ++i) v[i] = from[at[i]];
  return as_float(v);
#endif
}

/// Which lanes of a block that starts at `first` lie before `count`.
template <class L>
[[gnu::always_inline]] inline typename L::M lanes_before(int first, int count) {
  if constexpr (L::lanes == 1) {
    return first < count;
  } else {
    return Eight::I{0, 1, 2, 3, 4, 5, 6, 7} < count - first;
  }
}

}  // namespace
}  // namespace touchline
