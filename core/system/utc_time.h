// The present time in UTC, as text.
#pragma once

#include <string>

namespace elbowroom::core {

[[nodiscard]] std::string NowUtc();  // ISO 8601, whole seconds, "Z"

}  // namespace elbowroom::core
