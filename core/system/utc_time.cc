#include "core/system/utc_time.h"

#include <fmt/chrono.h>

#include <chrono>

namespace elbowroom::core {

std::string NowUtc() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

}  // namespace elbowroom::core
