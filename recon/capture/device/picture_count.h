// A camera's count of its pictures that begins again after some bits, as one that doesn't.
#pragma once

#include <cstdint>
#include <optional>

namespace elbowroom::recon {

// GigE Vision counts 1 to 65,535 and then from 1 again; its later form, and USB3 Vision, count on in 64 bits.
// Thread: one.
class PictureCount {
 public:
  // The count that goes on. Nothing: the picture has no number of its own, as where the packet that carries
  // it was lost. That is 0, or the number of an earlier picture: less than half a round before the last one.
  [[nodiscard]] std::optional<std::uint64_t> Next(std::uint64_t number);

 private:
  std::optional<std::uint64_t> last_;   // as the camera counts
  std::uint64_t last_without_end_ = 0;  // the same, going on
};

}  // namespace elbowroom::recon
