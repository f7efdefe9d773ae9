// SPDX-License-Identifier: Apache-2.0
// Numbers out of bytes whatever the byte order of the board. The caller has checked that offset + width fits.
#pragma once

#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace touchline {

constexpr std::uint32_t read_unsigned(std::span<const std::uint8_t> bytes, std::size_t offset, std::size_t width,
                                      bool big_endian = false) {
  assert(width <= 4 && offset + width <= bytes.size());
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < width; ++i) {
    value = (value << 8) | bytes[offset + (big_endian ? i : width - 1 - i)];
  }
  return value;
}
constexpr std::int32_t read_i16(std::span<const std::uint8_t> bytes, std::size_t offset, bool big_endian = false) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(read_unsigned(bytes, offset, 2, big_endian)));
}
constexpr std::int32_t read_i32(std::span<const std::uint8_t> bytes, std::size_t offset, bool big_endian = false) {
  return static_cast<std::int32_t>(read_unsigned(bytes, offset, 4, big_endian));
}
constexpr float read_f32(std::span<const std::uint8_t> bytes, std::size_t offset, bool big_endian = false) {
  return std::bit_cast<float>(read_unsigned(bytes, offset, 4, big_endian));
}

}  // namespace touchline
