// SPDX-License-Identifier: Apache-2.0
// Counts what a stretch of code takes from the heap, in a test program that links touchline_heap_guard: every call of
// malloc, calloc, realloc, aligned_alloc, posix_memalign, memalign, and with them operator new in all its forms.
#pragma once

#include <cstdint>

namespace touchline::test {

/// Allocations of the whole process since its start, all threads.
std::uint64_t heap_allocations();

class HeapGuard {
 public:
  HeapGuard() : before_(heap_allocations()) {}
  /// Since the guard was made.
  [[nodiscard]] std::uint64_t allocations() const { return heap_allocations() - before_; }

 private:
  std::uint64_t before_;
};

}  // namespace touchline::test
