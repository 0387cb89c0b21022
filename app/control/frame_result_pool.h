// Frame results whose memory is used again.
#pragma once

#include <memory>

#include "app/control/frame_result.h"

namespace elbowroom::control {

// A result goes back when nobody holds it any more, on the thread of its last holder. It gives up all that it
// shares, such as pictures, masks and hull, and keeps the memory of its contacts' points. Thread: any.
class FrameResultPool {
 public:
  FrameResultPool();

  // A result like a new one, but for the memory in record.contacts. It may outlive the pool.
  [[nodiscard]] std::shared_ptr<FrameResult> Take();

 private:
  class Shelf;
  std::shared_ptr<Shelf> shelf_;
};

}  // namespace elbowroom::control
