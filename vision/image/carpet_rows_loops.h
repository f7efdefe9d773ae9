// SPDX-License-Identifier: Apache-2.0
// The loops of carpet_rows.h, written so that compilers vectorise them. Included by files of kernels alone, and
// compiled there for that file's processor: everything is local to the file, and no function of another header is
// called.
//
// Quotients are estimated in floating point and then made exact by their remainder: so every processor, however it
// rounds, has the same ones.
#pragma once

#include "vision/image/carpet_rows.h"

namespace touchline {
namespace {
namespace carpet {

inline constexpr int word_px = 64;
inline constexpr int lanes = 16;  // samples of a word
inline constexpr int half = word_px / 2;

[[gnu::always_inline]] inline std::int32_t most(std::int32_t a, std::int32_t b) { return a > b ? a : b; }
[[gnu::always_inline]] inline std::int32_t least(std::int32_t a, std::int32_t b) { return a < b ? a : b; }
[[gnu::always_inline]] inline std::int32_t magnitude(std::int32_t a) { return a < 0 ? -a : a; }

/// 64 pixels of a row; rows that end inside them are copied to where there is room behind.
struct WordRow {
  std::uint64_t wanted;
  std::uint64_t inner;  // both neighbours are carpet's
  const std::uint8_t* y;
  const std::uint8_t* cb;
  const std::uint8_t* cr;
};

/// visit(WordRow) for the words that have samples.
template <typename Visit>
[[gnu::always_inline]] inline void in_words(const CarpetRow& row, Visit visit) {
  for (int first = 0, i = 0; first < row.width; first += word_px, ++i) {
    WordRow word;
    word.wanted = row.mask[i] & CarpetRow::samples;
    if (word.wanted == 0) continue;
    word.inner = row.around[i] << 1 & row.around[i] >> 1;
    word.y = row.y + first;
    word.cb = row.cb + first / 2;
    word.cr = row.cr + first / 2;
    const int used = row.width - first;
    if (used >= word_px) {
      visit(word);
    } else {
      std::uint8_t y[word_px] = {};
      std::uint8_t cb[half] = {};
      std::uint8_t cr[half] = {};
      __builtin_memcpy(y, word.y, static_cast<unsigned>(used));
      __builtin_memcpy(cb, word.cb, static_cast<unsigned>(used + 1) / 2);
      __builtin_memcpy(cr, word.cr, static_cast<unsigned>(used + 1) / 2);
      word.y = y;
      word.cb = cb;
      word.cr = cr;
      visit(word);
    }
  }
}

/// Several bytes at once, wherever they lie.
using FourPixels = std::uint32_t __attribute__((may_alias, aligned(1)));
using TwoSamples = std::uint16_t __attribute__((may_alias, aligned(1)));

/// The samples of a word, one a lane.
struct Samples {
  const FourPixels* four;  // of which the sample is byte 2
  const TwoSamples* cb;    // of which it is byte 1
  const TwoSamples* cr;

  [[gnu::always_inline]] explicit Samples(const WordRow& word)
      : four(reinterpret_cast<const FourPixels*>(word.y)),
        cb(reinterpret_cast<const TwoSamples*>(word.cb)),
        cr(reinterpret_cast<const TwoSamples*>(word.cr)) {}
  [[gnu::always_inline]] std::int32_t left(int i) const { return static_cast<std::int32_t>(four[i] >> 8 & 255U); }
  [[gnu::always_inline]] std::int32_t luma(int i) const { return static_cast<std::int32_t>(four[i] >> 16 & 255U); }
  [[gnu::always_inline]] std::int32_t right(int i) const { return static_cast<std::int32_t>(four[i] >> 24); }
  /// Chroma as differences from grey.
  [[gnu::always_inline]] std::int32_t b(int i) const { return (cb[i] >> 8) - 128; }
  [[gnu::always_inline]] std::int32_t r(int i) const { return (cr[i] >> 8) - 128; }
};

/// Without a branch: what vectorises. `flag` is 0 or 1.
[[gnu::always_inline]] inline std::int32_t pick(std::int32_t flag, std::int32_t a, std::int32_t otherwise) {
  return otherwise ^ ((a ^ otherwise) & -flag);
}

/// floor(n / d), but at most 256. 0 <= n < 2^27, 0 < d < 2^18.
[[gnu::always_inline]] inline std::int32_t quotient(std::int32_t n, std::int32_t d) {
  const std::int32_t held = least(n, 256 * d);
  const auto q = static_cast<std::int32_t>(static_cast<float>(held) / static_cast<float>(d));
  const std::int32_t rest = held - q * d;
  return q + (rest >= d ? 1 : 0) - (rest < 0 ? 1 : 0);
}

struct Colour {
  std::int32_t hue, saturation, value;
};

/// As hsv_from_ycbcr() (hsv.h), without a branch.
[[gnu::always_inline]] inline Colour colour_of(std::int32_t luma, std::int32_t b, std::int32_t r) {
  const std::int32_t red = 359 * r;
  const std::int32_t green = -88 * b - 183 * r;
  const std::int32_t blue = 454 * b;
  const std::int32_t high = most(most(red, green), blue);
  const std::int32_t chroma = high - least(least(red, green), blue);
  const std::int32_t value = (luma << 8) + high;

  const std::int32_t from_red = 60 * (green - blue);
  const std::int32_t from_green = 60 * (blue - red) + 120 * chroma;
  const std::int32_t from_blue = 60 * (red - green) + 240 * chroma;
  const std::int32_t from_others = pick(high == green ? 1 : 0, from_green, from_blue);
  const std::int32_t half_units = pick(high == red ? 1 : 0, from_red, from_others);
  const std::int32_t turned = half_units + pick(half_units < 0 ? 1 : 0, 360 * chroma, 0);
  const std::int32_t hue = quotient(turned + chroma, most(2 * chroma, 1));  // 0 where chroma is
  const std::int32_t saturation = least(quotient(510 * chroma + most(value, 0), most(2 * value, 1)), 255);
  return {pick(hue == 180 ? 1 : 0, 0, hue), pick(chroma == 0 ? 1 : 0, 0, pick(value > 0 ? 1 : 0, saturation, 255)),
          least(most((value + 128) >> 8, 0), 255)};
}

inline void count_colours(const CarpetRow& row, const HsvRange& range, CarpetColours& colours) {
  const HsvRange gate = range;
  const std::int32_t around_zero = gate.hue_low > gate.hue_high ? 1 : 0;
  constexpr std::int32_t outside = 255;  // no hue
  in_words(
      row, [&](const WordRow& word) __attribute__((always_inline)) {
        const Samples s(word);
        std::int32_t hues[lanes];
        std::int32_t saturations[lanes];
        for (int i = 0; i < lanes; ++i) {
          const Colour c = colour_of(s.luma(i), s.b(i), s.r(i));
          const std::int32_t past_low = c.hue >= gate.hue_low ? 1 : 0;
          const std::int32_t up_to_high = c.hue <= gate.hue_high ? 1 : 0;
          const std::int32_t hue_inside = (past_low & up_to_high) | (around_zero & (past_low | up_to_high));
          const std::int32_t inside = hue_inside & (c.saturation >= gate.saturation_low ? 1 : 0) &
                                      (c.saturation <= gate.saturation_high ? 1 : 0) &
                                      (c.value >= gate.value_low ? 1 : 0) & (c.value <= gate.value_high ? 1 : 0);
          hues[i] = pick(inside, c.hue, outside);
          saturations[i] = c.saturation;
        }
        for (std::uint64_t left = word.wanted; left != 0; left &= left - 1) {
          const int i = __builtin_ctzll(left) / 4;
          if (hues[i] == outside) continue;
          ++colours.hues[hues[i]];
          ++colours.saturations[saturations[i]];
          ++colours.samples;
        }
      });
}

inline void sum_chroma(const CarpetRow& row, ChromaSums& sums) {
  std::int32_t cb[lanes] = {};
  std::int32_t cr[lanes] = {};
  std::int32_t samples[lanes] = {};
  in_words(
      row, [&](const WordRow& word) __attribute__((always_inline)) {
        const Samples s(word);
        std::int32_t wanted[lanes];
        for (int i = 0; i < lanes / 2; ++i) {
          wanted[i] = (static_cast<std::uint32_t>(word.wanted) & 4U << (4 * i)) != 0 ? -1 : 0;
          wanted[i + lanes / 2] = (static_cast<std::uint32_t>(word.wanted >> half) & 4U << (4 * i)) != 0 ? -1 : 0;
        }
        for (int i = 0; i < lanes; ++i) {
          cb[i] += s.b(i) & wanted[i];
          cr[i] += s.r(i) & wanted[i];
          samples[i] -= wanted[i];
        }
      });
  for (int i = 0; i < lanes; ++i) {
    sums.cb += cb[i];
    sums.cr += cr[i];
    sums.samples += samples[i];
  }
}

inline void count_ratios(const CarpetRow& row, const ChromaAxis& given, CarpetRatios& ratios) {
  const ChromaAxis axis = given;
  in_words(
      row, [&](const WordRow& word) __attribute__((always_inline)) {
        const Samples s(word);
        std::int32_t greenness[lanes];
        std::int32_t chroma[lanes];
        std::int32_t rough[lanes];
        for (int i = 0; i < lanes; ++i) {
          const std::int32_t luma = most(s.luma(i), 1);
          const std::int32_t along = s.b(i) * axis.cb + s.r(i) * axis.cr;
          greenness[i] = least(quotient(most(along, 0), luma), 255);
          chroma[i] = least(quotient((magnitude(s.b(i)) + magnitude(s.r(i))) * 256, luma), 255);
          // Clipped, so that a line's edge does not count as noise.
          rough[i] = least(magnitude(2 * s.luma(i) - s.left(i) - s.right(i)), 32);
        }
        for (std::uint64_t left = word.wanted; left != 0; left &= left - 1) {
          const int bit = __builtin_ctzll(left);
          const int i = bit / 4;
          ++ratios.greenness[greenness[i]];
          ++ratios.chroma[chroma[i]];
          ++ratios.lumas[s.luma(i)];
          const auto inner = static_cast<std::int32_t>(word.inner >> bit & 1U);
          ratios.roughness += rough[i] & -inner;
          ratios.rough_samples += inner;
        }
      });
}

inline CarpetKernels kernels() { return {count_colours, sum_chroma, count_ratios}; }

}  // namespace carpet
}  // namespace
}  // namespace touchline
