// SPDX-License-Identifier: Apache-2.0
// FNV-1a, 64 bit: the fingerprint of the golden outputs. Not for security.
#pragma once

#include <cstddef>
#include <cstdint>

namespace touchline {

inline constexpr std::uint64_t hash_seed = 0xcbf29ce484222325ULL;

inline std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t hash = hash_seed) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3ULL;
  return hash;
}

}  // namespace touchline
