#include "core/error.h"

namespace elbowroom::core {

void Require(bool condition, std::string_view what_must_hold) {
  if (!condition) throw PreconditionError("must hold: " + std::string(what_must_hold));
}

}  // namespace elbowroom::core
