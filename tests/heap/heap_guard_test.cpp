// SPDX-License-Identifier: Apache-2.0
// The control of the heap guard: it sees every way to the heap, and nothing where there is none.
#include "tests/support/heap_guard.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace {

using touchline::test::HeapGuard;

// What is written here the compiler has to produce: it may not drop the allocation.
void* volatile sink = nullptr;

struct alignas(64) Wide {
  char bytes[64];
};

std::uint64_t allocations_of(void (*work)()) {
  const HeapGuard guard;
  work();
  return guard.allocations();
}

}  // namespace

TEST_CASE("the guard counts nothing where nothing is allocated") {
  CHECK(allocations_of([] {
          int numbers[64] = {};
          for (int& n : numbers) n = 1;
          sink = numbers;
          sink = nullptr;
        }) == 0);
}

TEST_CASE("the guard counts each C allocation") {
  CHECK(allocations_of([] {
          sink = std::malloc(10);
          std::free(sink);
        }) == 1);
  CHECK(allocations_of([] {
          sink = std::calloc(10, 10);
          std::free(sink);
        }) == 1);
  CHECK(allocations_of([] {
          sink = std::realloc(nullptr, 10);
          std::free(sink);
        }) >= 1);
  CHECK(allocations_of([] {
          sink = std::aligned_alloc(64, 128);
          std::free(sink);
        }) == 1);
  CHECK(allocations_of([] {
          void* block = nullptr;
          if (posix_memalign(&block, 64, 128) == 0) sink = block;
          std::free(block);
        }) == 1);
}

TEST_CASE("the guard counts each C++ allocation") {
  CHECK(allocations_of([] {
          int* one = new int(1);
          sink = one;
          delete one;
        }) == 1);
  CHECK(allocations_of([] {
          int* many = new int[10];
          sink = many;
          delete[] many;
        }) == 1);
  CHECK(allocations_of([] {
          Wide* wide = new Wide;
          sink = wide;
          delete wide;
        }) == 1);
  CHECK(allocations_of([] {
          std::vector<int> numbers(100);
          sink = numbers.data();
        }) == 1);
  CHECK(allocations_of([] {
          std::string text(100, 'x');
          sink = text.data();
        }) == 1);
}
