#include "core/progress.h"

#include "core/error.h"

namespace elbowroom::core {

void ThrowIfStopped(const std::stop_token& stop, const std::string& what) {
  if (stop.stop_requested()) throw Error(ErrorKind::kCancelled, what + " was cancelled");
}

}  // namespace elbowroom::core
