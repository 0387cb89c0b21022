#include "recon/capture/device/picture_count.h"

namespace elbowroom::recon {

std::optional<std::uint64_t> PictureCount::Next(std::uint64_t number) {
  constexpr std::uint64_t kRound = 65'535;
  if (number == 0) return std::nullopt;
  if (!last_) {
    last_ = last_without_end_ = number;
    return number;
  }
  std::uint64_t step = number - *last_;
  if (number <= *last_) {
    if (*last_ > kRound) return std::nullopt;  // counts in 64 bits
    step = number + kRound - *last_;
  }
  if (number <= kRound && step > kRound / 2) return std::nullopt;
  last_ = number;
  last_without_end_ += step;
  return last_without_end_;
}

}  // namespace elbowroom::recon
