// SPDX-License-Identifier: Apache-2.0
// Set bits of many words, by a table of the bits of each half byte (W. Mula, N. Kurz, D. Lemire, "Faster Population
// Counts Using AVX2 Instructions", The Computer Journal 61(1), 2018). Included by files of kernels alone, and compiled
// there for that file's processor: everything is local to the file.
#pragma once

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

namespace touchline {
namespace {
namespace bit_count {

/// The sums of the bits of eight bytes each.
[[gnu::always_inline]] inline __m256i sums_of(__m256i bits) {
  const __m256i table = _mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4,  //
                                         0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
  const __m256i half_byte = _mm256_set1_epi8(15);
  const __m256i low = _mm256_shuffle_epi8(table, _mm256_and_si256(bits, half_byte));
  const __m256i high = _mm256_shuffle_epi8(table, _mm256_and_si256(_mm256_srli_epi16(bits, 4), half_byte));
  return _mm256_sad_epu8(_mm256_add_epi8(low, high), _mm256_setzero_si256());
}

inline int count_bits(const std::uint64_t* words, std::ptrdiff_t size) {
  __m256i sums = _mm256_setzero_si256();
  std::ptrdiff_t i = 0;
  for (; i + 4 <= size; i += 4) {
    sums = _mm256_add_epi64(sums, sums_of(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(words + i))));
  }
  std::int64_t total = _mm256_extract_epi64(sums, 0) + _mm256_extract_epi64(sums, 1) + _mm256_extract_epi64(sums, 2) +
                       _mm256_extract_epi64(sums, 3);
  for (; i < size; ++i) total += __builtin_popcountll(words[i]);
  return static_cast<int>(total);
}

}  // namespace bit_count
}  // namespace
}  // namespace touchline
