// SPDX-License-Identifier: Apache-2.0
// CRC-32 of IEEE 802.3 (reflected, polynomial 0xEDB88320): finds every burst of errors up to 32 bits. Bit by bit,
// without a table: frames of 40 bytes at 100 Hz are not worth 1 KiB of memory.
#pragma once

#include <cstdint>
#include <span>

namespace touchline {

constexpr std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xEDB88320U & (0U - (crc & 1U)));
  }
  return crc ^ 0xFFFFFFFFU;
}

}  // namespace touchline
