// What the C library does with memory that is freed.
#pragma once

namespace elbowroom::core {

// From now on the C library keeps freed memory for what comes next. Otherwise it hands large blocks back to
// the system after each frame, and the next frame pays for new pages (docs/performance.md, "Freed memory").
// Thread: any; better before others begin.
void KeepFreedMemory();

}  // namespace elbowroom::core
