#include "tests/support/resident_memory.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace elbowroom::test_support {
namespace {

std::int64_t BytesInStatus(pid_t process, std::string_view key) {
  std::ifstream status(std::filesystem::path("/proc") / std::to_string(process) / "status");
  for (std::string word; status >> word;) {
    if (word != key) continue;
    std::int64_t kib = 0;
    status >> kib;
    return kib * 1024;
  }
  return 0;
}

}  // namespace

std::int64_t ResidentBytes(pid_t process) { return BytesInStatus(process, "VmRSS:"); }
std::int64_t PeakResidentBytes(pid_t process) { return BytesInStatus(process, "VmHWM:"); }

}  // namespace elbowroom::test_support
