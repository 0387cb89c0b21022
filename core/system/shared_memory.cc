#include "core/system/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

#include "core/error.h"

namespace elbowroom::core {

SharedMemory::SharedMemory(const char* name, std::size_t bytes) : file_(MakeMemoryFile(name)) {
  Require(bytes > 0, "shared memory has a byte");
  const bool has_memory = ::ftruncate(file_.number(), static_cast<off_t>(bytes)) == 0 &&
                          ::fcntl(file_.number(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) == 0;
  void* memory =
      has_memory ? ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_.number(), 0) : MAP_FAILED;
  if (memory == MAP_FAILED) {
    // The limit on files holds for those in memory, too.
    throw Error(ErrorKind::kFile,
                errno == EFBIG
                    ? "the limit on the size of files (ulimit -f) is too small for pictures; raise it"
                    : "there is no memory for pictures; close other programs");
  }
  bytes_ = {static_cast<std::byte*>(memory), bytes};
}

SharedMemory::~SharedMemory() { ::munmap(bytes_.data(), bytes_.size()); }

}  // namespace elbowroom::core
