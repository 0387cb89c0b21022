#include "app/cli/repeated_timing.h"

#include <malloc.h>

namespace elbowroom::cli {

void KeepFreedMemory() {
  ::mallopt(M_MMAP_THRESHOLD, 32 << 20);
  ::mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

}  // namespace elbowroom::cli
