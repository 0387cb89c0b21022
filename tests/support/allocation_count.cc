#include "tests/support/allocation_count.h"

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>

// glibc lets a program replace malloc, and keeps its own under these names ("Replacing malloc" in its
// manual).
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);
}

namespace elbowroom::test_support {
namespace {

// Not on the heap, and there before any object's constructor runs.
constinit std::atomic<std::int64_t> allocation_count{0};
constinit std::atomic<std::int64_t> byte_count{0};

[[maybe_unused]] void Count(std::size_t bytes) {
  allocation_count.fetch_add(1, std::memory_order_relaxed);
  byte_count.fetch_add(static_cast<std::int64_t>(bytes), std::memory_order_relaxed);
}

}  // namespace

AllocationCount AllocationsSoFar() {
  return {allocation_count.load(std::memory_order_relaxed), byte_count.load(std::memory_order_relaxed)};
}

}  // namespace elbowroom::test_support

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

extern "C" {

void* malloc(std::size_t size) {
  elbowroom::test_support::Count(size);
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  elbowroom::test_support::Count(count * size);
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) {
  elbowroom::test_support::Count(size);
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  elbowroom::test_support::Count(size);
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }

int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  void* found = memalign(alignment, size);
  if (found == nullptr) return ENOMEM;
  *block = found;
  return 0;
}

void free(void* block) { __libc_free(block); }

}  // extern "C"

#endif
