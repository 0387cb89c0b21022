#include "core/system/kept_memory.h"

#include <malloc.h>

namespace elbowroom::core {

void KeepFreedMemory() {
  // A frame's grids and pictures are smaller; a block that is larger is mapped, and goes back at once.
  constexpr int kLargestKept = 32 << 20;
  constexpr int kMostKept = 1 << 30;
  ::mallopt(M_MMAP_THRESHOLD, kLargestKept);
  ::mallopt(M_TRIM_THRESHOLD, kMostKept);
}

}  // namespace elbowroom::core
