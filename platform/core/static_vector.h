// SPDX-License-Identifier: Apache-2.0
// A vector with its storage inside. What does not fit is counted, never cut off in silence.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace touchline {

template <typename T, std::size_t N>
class StaticVector {
  static_assert(std::is_trivially_destructible_v<T>, "elements are dropped without running a destructor");

 public:
  using value_type = T;
  static constexpr std::size_t max_elements = N;

  /// Appends; false when full, and then dropped() grows by one.
  bool push_back(const T& value) {
    if (size_ == N) {
      ++dropped_;
      return false;
    }
    items_[size_++] = value;
    return true;
  }
  void pop_back() {
    assert(size_ > 0);
    --size_;
  }
  void clear() {
    size_ = 0;
    dropped_ = 0;
  }
  /// Keeps the first `count` elements; `count` <= size().
  void truncate(std::size_t count) {
    assert(count <= size_);
    size_ = count;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool full() const { return size_ == N; }
  /// How many push_back() calls found no room since the last clear().
  [[nodiscard]] std::uint32_t dropped() const { return dropped_; }

  [[nodiscard]] T& operator[](std::size_t i) {
    assert(i < size_);
    return items_[i];
  }
  [[nodiscard]] const T& operator[](std::size_t i) const {
    assert(i < size_);
    return items_[i];
  }
  [[nodiscard]] T& back() { return (*this)[size_ - 1]; }
  [[nodiscard]] const T& back() const { return (*this)[size_ - 1]; }
  [[nodiscard]] T* begin() { return items_.data(); }
  [[nodiscard]] T* end() { return items_.data() + size_; }
  [[nodiscard]] const T* begin() const { return items_.data(); }
  [[nodiscard]] const T* end() const { return items_.data() + size_; }
  [[nodiscard]] std::span<T> span() { return {items_.data(), size_}; }
  [[nodiscard]] std::span<const T> span() const { return {items_.data(), size_}; }

 private:
  std::array<T, N> items_{};
  std::size_t size_ = 0;
  std::uint32_t dropped_ = 0;
};

}  // namespace touchline
