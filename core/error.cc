#include "core/error.h"

namespace elbowroom::core {

void ThrowPreconditionError(std::string_view what_must_hold) {
  throw PreconditionError("must hold: " + std::string(what_must_hold));
}

}  // namespace elbowroom::core
