// How much memory a program takes, and the processes that it starts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace elbowroom::accuracy {

// The most at any time of its life, resident, as Linux keeps count of it (VmHWM).
struct PeakMemory {
  std::int64_t program_bytes = 0;
  std::int64_t child_bytes = 0;  // of the largest of its children; 0: it had none
};

// Runs it to its end, looking every half a millisecond. Throws: std::system_error when it can't be started;
// core::Error{kFile} unless it exits with 0.
[[nodiscard]] PeakMemory PeakMemoryOf(const std::filesystem::path& program,
                                      const std::vector<std::string>& arguments);

}  // namespace elbowroom::accuracy
