// A camera program (docs/capture.md), started.
#pragma once

#include "core/system/child_process.h"
#include "recon/capture/shared_slots.h"

namespace elbowroom::recon {

// It waits for its order at the other end of the socket. Thread: the one that made it, with which it dies.
struct CameraProgram {
  // Without `slots` it shares no memory. Throws: Error{kFile} if it can't be started.
  explicit CameraProgram(const SharedSlots* slots = nullptr);

  core::Descriptor socket;
  core::Child child;

 private:
  CameraProgram(const SharedSlots* slots, core::Pipe ends);
};

}  // namespace elbowroom::recon
