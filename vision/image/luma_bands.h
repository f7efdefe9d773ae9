// SPDX-License-Identifier: Apache-2.0
// Which luma a chroma sample leaves to a range of colours, and the pixels of two rows whose luma it is: the numbers
// that the loops of hsv.h and green.h need.
#pragma once

#include <cstdint>

namespace touchline {

/// The luma that a chroma sample leaves to a range; empty when low > high.
struct LumaBand {
  std::uint8_t low = 255;
  std::uint8_t high = 0;
};

/// Sign of a * cb + b * cr, chroma as differences from 128: on which side of a hue the chroma lies.
struct ChromaHalfPlane {
  std::int32_t a = 0, b = 0;
};

/// A range in HSV made ready (hsv.h).
struct HsvBandPlan {
  ChromaHalfPlane from;  // >= 0: at or past the range's first hue, as far as half a turn goes
  ChromaHalfPlane to;    // < 0: before the end of its last hue
  bool wide = false;     // more than half a turn: one of both is enough
  bool any_hue = false;
  std::int32_t divisor_low = 0, divisor_high = 0;  // 2 S - 1 and 2 S + 1; 0: no bound
  std::uint32_t reciprocal_low = 0, reciprocal_high = 0;
  std::int32_t value_low = 0, value_high = 0;
  LumaBand neutral;   // for gray, which has no hue
  bool rare = false;  // no gray, and a sixth of the hues at the most: it pays to look whether any sample has one
  std::int32_t least_chroma = 0;  // of |cb| and |cr| the larger is at least this, whatever the luma; at least 1 if rare
};

/// What white must have more of than the carpet (green.h): the least luma for a chroma sample; there is no largest.
struct CarpetLimits {
  std::int32_t axis_cb = 0, axis_cr = 0;  // chroma direction of the carpet, 2^-8
  std::int32_t per_green = 0;             // luma a unit of chroma along the axis, 2^-8
  std::int32_t per_chroma = 0;            // luma a unit of |cb| + |cr|, 2^-8
  std::int32_t shadow_luma = 0;
};

/// What was found out about chroma samples, for processors whose every instruction counts: a field has few colours.
struct BandMemo {
  static constexpr std::uint32_t slots = 512;
  static constexpr std::uint32_t nobody = ~std::uint32_t{0};
  struct Entry {
    std::uint32_t sample;  // cb + 256 cr
    std::uint32_t band;
  };
  Entry entries[slots];

  void clear() {
    for (Entry& entry : entries) entry.sample = nobody;
  }
  /// Neighbouring colours have different slots.
  static std::uint32_t slot_of(std::uint32_t sample) { return (sample + (sample >> 4U)) % slots; }
};

/// Two rows of luma that share a row of chroma, and their rows of masks. At an odd bottom both are the same row.
struct BandRows {
  const std::uint8_t* cb = nullptr;  // (width + 1) / 2
  const std::uint8_t* cr = nullptr;
  const std::uint8_t* y[2] = {};
  const std::uint64_t* region[2] = {};
  std::uint64_t* out[2] = {};  // set to the pixels of the region whose luma lies in the band
  int width = 0;
  BandMemo* memo = nullptr;  // of one plan, cleared before its first rows; never null
};

}  // namespace touchline
