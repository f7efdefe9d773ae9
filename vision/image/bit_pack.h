// SPDX-License-Identifier: Apache-2.0
// From a flag a byte, as vectorised comparisons leave it, to a flag a bit.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "vision/image/bit_image.h"

namespace touchline {

/// flags: 64 bytes of value 0 or 1; byte i becomes bit i. Eight bytes at a time: the multiplication moves flag i, at
/// bit 8 i of the word, to bit 56 + i, and no two of the other products meet there.
inline BitWord pack_flags(const std::uint8_t* flags) {
  static_assert(std::endian::native == std::endian::little, "byte i has to be bits 8 i and up of the word");
  BitWord word = 0;
  for (int i = 0; i < 8; ++i) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, flags + 8 * i, sizeof eight);
    word |= ((eight * 0x0102040810204080U) >> 56) << (8 * i);
  }
  return word;
}

}  // namespace touchline
