#include "recon/footage/frame_set.h"

#include <fmt/format.h>

#include <utility>

#include "core/error.h"

namespace elbowroom::recon {

FrameSet FrameSetSource::Read(core::FrameIndex index, std::stop_token stop) {
  if (std::optional<FrameSet> set = TryRead(index, std::move(stop))) return std::move(*set);
  throw core::Error(core::ErrorKind::kRange,
                    fmt::format("frame {} is out of range: the footage ends with {}", index, WhatEndsIt()));
}

}  // namespace elbowroom::recon
