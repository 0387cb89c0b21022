// The clock that people and other programs share.
#pragma once

#include <string>

namespace elbowroom::core {

[[nodiscard]] std::string NowUtc();  // ISO 8601, whole seconds, "Z"

}  // namespace elbowroom::core
