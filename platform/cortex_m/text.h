// SPDX-License-Identifier: Apache-2.0
// Numbers as text in a fixed buffer: printf would bring the allocator along.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>

namespace touchline::board {

/// A line of text; what does not fit is left out.
class Text {
 public:
  Text& add(const char* text);
  Text& add(std::unsigned_integral auto value) { return add_number(std::uint64_t{value}); }
  Text& add(std::signed_integral auto value) { return add_signed(std::int64_t{value}); }
  Text& add_hex(std::uint64_t value);
  /// With `decimals` digits after the point, rounded half up; for people, not for comparison.
  Text& add_decimal(float value, int decimals);
  /// Fills with spaces up to a column.
  Text& to_column(std::size_t column);
  /// Zero-terminated.
  [[nodiscard]] const char* c_str() const { return characters_; }
  void clear();

 private:
  Text& add_number(std::uint64_t value);
  Text& add_signed(std::int64_t value);
  void put(char c);

  static constexpr std::size_t capacity = 160;  // the longest line printed has some 100
  char characters_[capacity + 1] = {};
  std::size_t size_ = 0;
};

}  // namespace touchline::board
