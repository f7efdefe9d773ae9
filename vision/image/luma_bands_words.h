// SPDX-License-Identifier: Apache-2.0
// The loops of luma_bands.h for processors without vector registers: two lumas of 16 bits in each word of 32, compared
// by whether a subtraction leaves the top bit alone (H. S. Warren, "Hacker's Delight", 2nd ed., section 2-18). A band
// is kept as 0x8000 - low and 0x8000 + high, so that it is not negated for every pixel.
#pragma once

#include "vision/image/luma_bands_loops.h"
#include "vision/image/word_lanes.h"

namespace touchline {
namespace {
namespace band_words {

inline constexpr std::uint32_t tops = 0x80008000U;
inline constexpr std::uint16_t top = 0x8000U;
inline constexpr int half_px = 32;  // pixels, a bit each, that one register takes

/// Of each chroma sample 0x8000 - low in the lower half, and 0x8000 + high in the upper one.
struct Bands {
  std::uint32_t band[bands::word_samples];
};

inline std::uint32_t load_word(const void* from) {
  std::uint32_t word = 0;
  __builtin_memcpy(&word, from, sizeof word);
  return word;
}

/// One chroma sample whose hue is in the range.
inline LumaBand coloured_band(const HsvBandPlan& f, std::int32_t b, std::int32_t r) {
  const bands::Offsets o = bands::offsets(b, r);
  const std::int32_t largest = bands::most(bands::most(o.red, o.green), o.blue);
  const std::int32_t chroma = largest - bands::least(bands::least(o.red, o.green), o.blue);
  if (chroma == 0) return f.neutral;
  const std::int32_t value_offset = (largest + 128) >> bands::offset_bits;
  std::int32_t from = f.value_low == 0 ? 0 : bands::most(0, f.value_low - value_offset);
  std::int32_t to = f.value_high == 255 ? 255 : bands::least(255, f.value_high - value_offset);
  if (f.divisor_high != 0) {
    const std::int32_t t = 510 * chroma - f.divisor_high * largest;
    from = bands::most(from, bands::luma_quotient(t, f.divisor_high, f.reciprocal_high) + 1);
  }
  if (f.divisor_low != 0) {
    const std::int32_t t = 510 * chroma - f.divisor_low * largest;
    to = bands::least(to, bands::luma_quotient(t, f.divisor_low, f.reciprocal_low));
  }
  if (from > to) return {};
  return {static_cast<std::uint8_t>(from), static_cast<std::uint8_t>(to)};
}

/// The band of any chroma sample. What has another hue is left at once.
inline constexpr std::uint32_t empty_band = (0x8000U - 255U) | 0x8000U << 16U;
inline std::uint32_t band_of(const HsvBandPlan& f, std::int32_t b, std::int32_t r) {
  const bool past_first = f.from.a * b + f.from.b * r >= 0;
  const bool before_last = f.to.a * b + f.to.b * r < 0;
  const bool hue = f.any_hue || (past_first && before_last) || (f.wide && (past_first || before_last));
  if (!hue && (b != 0 || r != 0)) return empty_band;
  const LumaBand band = coloured_band(f, b, r);
  return band.low > band.high ? empty_band : (0x8000U - band.low) | (0x8000U + band.high) << 16U;
}

/// Whether any of the samples leaves anything.
inline bool hsv_samples(const HsvBandPlan& f, const std::uint8_t* cb, const std::uint8_t* cr, int count, Bands& out,
                        BandMemo* memo) {
  std::uint32_t any = 0;
  for (int i = 0; i < count; ++i) {
    const std::uint32_t sample = cb[i] | std::uint32_t{cr[i]} << 8U;
    BandMemo::Entry& entry = memo->entries[BandMemo::slot_of(sample)];
    if (entry.sample != sample) entry = {sample, band_of(f, cb[i] - 128, cr[i] - 128)};
    out.band[i] = entry.band;
    any |= entry.band;
  }
  return any != empty_band;  // a band with the same bits set is the empty one
}

inline bool white_samples(const CarpetLimits& f, const std::uint8_t* cb, const std::uint8_t* cr, int count, Bands& out,
                          BandMemo* memo) {
  for (int i = 0; i < count; ++i) {
    const std::uint32_t sample = cb[i] | std::uint32_t{cr[i]} << 8U;
    BandMemo::Entry& entry = memo->entries[BandMemo::slot_of(sample)];
    if (entry.sample != sample) {
      entry = {sample, static_cast<std::uint32_t>(top - bands::least_white(f, cb[i] - 128, cr[i] - 128))};
    }
    out.band[i] = entry.band;
  }
  return true;
}

/// Flags at the lanes' tops, of pixels 0, 2 and 1, 3, to bits 28 to 31.
inline std::uint32_t four_bits(std::uint32_t even, std::uint32_t odd) {
  const std::uint32_t pairs = (even & tops) >> 1U | (odd & tops);
  return (pairs | pairs << 14U) & 0xF0000000U;
}

/// 32 pixels. `Bounded`: whether there is a largest luma, too.
template <bool Bounded>
inline std::uint32_t half_word(const std::uint8_t* y, const std::uint32_t* band) {
  std::uint32_t bits = 0;
  for (int i = 0; i < half_px; i += 4) {
    const std::uint32_t luma = load_word(y + i);
    const std::uint32_t left = band[i / 2], right = band[i / 2 + 1];
    const std::uint32_t low = lower_halves(left, right);
    const std::uint32_t luma_02 = even_bytes(luma), luma_13 = odd_bytes(luma);
    std::uint32_t even = luma_02 + low;
    std::uint32_t odd = luma_13 + low;
    if constexpr (Bounded) {
      const std::uint32_t high = upper_halves(left, right);
      even &= high - luma_02;
      odd &= high - luma_13;
    }
    bits = bits >> 4U | four_bits(even, odd);
  }
  return bits;
}

/// 64 pixels, of which `used` may be read.
template <bool Bounded>
inline std::uint64_t whole_word(const std::uint8_t* y, int used, std::uint64_t wanted, const Bands& band) {
  std::uint8_t copy[bands::word_px];
  if (used < bands::word_px) {
    for (std::uint8_t& pixel : copy) pixel = 0;
    __builtin_memcpy(copy, y, static_cast<std::size_t>(used));
    y = copy;
  }
  std::uint32_t low = 0, high = 0;
  if ((wanted & 0xFFFFFFFFU) != 0) low = half_word<Bounded>(y, band.band);
  if (wanted >> half_px != 0) {
    high = half_word<Bounded>(y + half_px, band.band + half_px / 2);
  }
  return (low | std::uint64_t{high} << half_px) & wanted;
}

/// make(first, count, bands): those of some chroma samples of the row; false when they are empty.
template <bool Bounded, typename Make>
inline void in_rows(const BandRows& rows, Make make) {
  Bands band;
  for (int first = 0, i = 0; first < rows.width; first += bands::word_px, ++i) {
    const std::uint64_t wanted[2] = {rows.region[0][i], rows.region[1][i]};
    const int used = bands::least(rows.width - first, bands::word_px);
    if ((wanted[0] | wanted[1]) == 0 || !make(first / 2, (used + 1) / 2, band)) {
      rows.out[0][i] = rows.out[1][i] = 0;
      continue;
    }
    for (int v = 0; v < 2; ++v) {
      rows.out[v][i] = wanted[v] == 0 ? 0 : whole_word<Bounded>(rows.y[v] + first, used, wanted[v], band);
    }
  }
}

inline void hsv_rows(const HsvBandPlan& plan, const BandRows& rows) {
  const HsvBandPlan f = plan;
  in_rows<true>(rows, [&](int first, int count, Bands& out) {
    return hsv_samples(f, rows.cb + first, rows.cr + first, count, out, rows.memo);
  });
}

inline void white_rows(const CarpetLimits& limits, const BandRows& rows) {
  const CarpetLimits f = limits;
  in_rows<false>(rows, [&](int first, int count, Bands& out) {
    return white_samples(f, rows.cb + first, rows.cr + first, count, out, rows.memo);
  });
}

}  // namespace band_words
}  // namespace
}  // namespace touchline
