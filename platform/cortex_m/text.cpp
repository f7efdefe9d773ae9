// SPDX-License-Identifier: Apache-2.0
#include "platform/cortex_m/text.h"

namespace touchline::board {

void Text::clear() {
  size_ = 0;
  characters_[0] = '\0';
}

void Text::put(char c) {
  if (size_ == capacity) return;
  characters_[size_++] = c;
  characters_[size_] = '\0';
}

Text& Text::add(const char* text) {
  for (; *text != '\0'; ++text) put(*text);
  return *this;
}

Text& Text::add_number(std::uint64_t value) {
  char digits[20];  // of 2^64 - 1
  int count = 0;
  do {
    digits[count++] = static_cast<char>('0' + value % 10U);
    value /= 10U;
  } while (value != 0);
  while (count > 0) put(digits[--count]);
  return *this;
}

Text& Text::add_signed(std::int64_t value) {
  if (value >= 0) return add_number(static_cast<std::uint64_t>(value));
  put('-');
  return add_number(0U - static_cast<std::uint64_t>(value));
}

Text& Text::add_hex(std::uint64_t value) {
  for (int shift = 60; shift >= 0; shift -= 4) put("0123456789abcdef"[(value >> shift) & 15U]);
  return *this;
}

Text& Text::add_decimal(float value, int decimals) {
  if (value < 0.0F) {
    put('-');
    value = -value;
  }
  std::uint64_t scale = 1;
  for (int i = 0; i < decimals; ++i) scale *= 10U;
  const std::uint64_t scaled =
      (static_cast<std::uint64_t>(2.0F * value * static_cast<float>(scale)) + 1U) / 2U;  // rounded
  add(scaled / scale);
  if (decimals == 0) return *this;
  put('.');
  for (std::uint64_t digit = scale / 10U; digit > 0; digit /= 10U) {
    put(static_cast<char>('0' + scaled / digit % 10U));
  }
  return *this;
}

Text& Text::to_column(std::size_t column) {
  while (size_ < column && size_ < capacity) put(' ');
  return *this;
}

}  // namespace touchline::board
