// Memory that this program shares with a child.
#pragma once

#include <cstddef>
#include <span>

#include "core/system/child_process.h"

namespace elbowroom::core {

// It is zero at the beginning, and sealed: a child can't shrink it while this program uses it. Thread: any;
// who may write where is the callers' agreement.
class SharedMemory {
 public:
  // Throws: Error{kFile} saying what to do when there isn't so much; PreconditionError for 0 bytes.
  SharedMemory(const char* name, std::size_t bytes);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  // What a child is given, and maps.
  [[nodiscard]] const Descriptor& file() const { return file_; }
  [[nodiscard]] std::span<std::byte> bytes() const { return bytes_; }

 private:
  Descriptor file_;
  std::span<std::byte> bytes_;
};

}  // namespace elbowroom::core
