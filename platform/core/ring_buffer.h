// SPDX-License-Identifier: Apache-2.0
// First in, first out, of fixed size: the newest pushes the oldest out.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>

namespace touchline {

template <typename T, std::size_t N>
class RingBuffer {
  static_assert(N > 0);

 public:
  static constexpr std::size_t max_elements = N;

  void push(const T& value) {
    items_[(first_ + size_) % N] = value;
    if (size_ < N) {
      ++size_;
    } else {
      first_ = (first_ + 1) % N;
    }
  }
  void clear() {
    first_ = 0;
    size_ = 0;
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// 0 is the oldest.
  [[nodiscard]] const T& operator[](std::size_t i) const {
    assert(i < size_);
    return items_[(first_ + i) % N];
  }
  [[nodiscard]] const T& newest() const { return (*this)[size_ - 1]; }
  [[nodiscard]] const T& oldest() const { return (*this)[0]; }

 private:
  std::array<T, N> items_{};
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace touchline
