// How much memory a process has resident, as Linux counts it.
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace elbowroom::test_support {

// Now, and the most at any time of its life. 0: it has ended.
[[nodiscard]] std::int64_t ResidentBytes(pid_t process);
[[nodiscard]] std::int64_t PeakResidentBytes(pid_t process);

}  // namespace elbowroom::test_support
