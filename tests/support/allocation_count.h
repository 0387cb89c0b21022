// How much memory a program asks the heap for. Whoever links this library has its malloc counted, unless a
// sanitizer brings a malloc of its own: then nothing is counted.
#pragma once

#include <cstdint>

namespace elbowroom::test_support {

// Since the program began, on all threads, through malloc and its relatives: what operator new, Eigen,
// OpenCV, SQLite and TBB take. A realloc counts as an allocation of its new size.
struct AllocationCount {
  std::int64_t allocations = 0;
  std::int64_t bytes = 0;

  [[nodiscard]] AllocationCount operator-(const AllocationCount& other) const {
    return {allocations - other.allocations, bytes - other.bytes};
  }
  AllocationCount& operator+=(const AllocationCount& other) {
    allocations += other.allocations;
    bytes += other.bytes;
    return *this;
  }
};

[[nodiscard]] AllocationCount AllocationsSoFar();

}  // namespace elbowroom::test_support
