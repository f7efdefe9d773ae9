// SPDX-License-Identifier: Apache-2.0
// The program's own malloc family stands before the C library's and passes each call on. AddressSanitizer has a malloc
// of its own and tells about each call by a hook instead.
#include "tests/support/heap_guard.h"

#include <atomic>
#include <cerrno>
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#define TOUCHLINE_ASAN 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TOUCHLINE_ASAN 1
#endif
#endif

namespace touchline::test {
namespace {
std::atomic<std::uint64_t> count{0};
}
std::uint64_t heap_allocations() { return count.load(); }
}  // namespace touchline::test

#ifdef TOUCHLINE_ASAN
// From sanitizer/allocator_interface.h, which Debian's g++ comes without.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*, std::size_t),
                                                         void (*free_hook)(const volatile void*));

namespace {
void count_allocation(const volatile void*, std::size_t) { ++touchline::test::count; }
void ignore_free(const volatile void*) {}
[[maybe_unused]] const int installed = __sanitizer_install_malloc_and_free_hooks(count_allocation, ignore_free);
}  // namespace

#else
extern "C" {
// glibc's own entry points, made for this use.
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  ++touchline::test::count;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++touchline::test::count;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  ++touchline::test::count;
  return __libc_realloc(block, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  ++touchline::test::count;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++touchline::test::count;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  ++touchline::test::count;
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}
}
#endif
