#include "recon/footage/source_subject.h"

#include <fmt/format.h>

namespace elbowroom::recon {

void SourceSubject::Fail(const std::string& what, core::ErrorKind kind) const {
  throw core::Error(kind, fmt::format("{}: {}", who, what));
}

void SourceSubject::RequireSize(std::int64_t found_width_px, std::int64_t found_height_px,
                                core::FrameIndex index) const {
  if (found_width_px == width_px && found_height_px == height_px) return;
  Fail(fmt::format("frame {} of '{}' is {} x {} px, but {} {} x {}; {}", index, location, found_width_px,
                   found_height_px, size_from, width_px, height_px, size_remedy));
}

void SourceSubject::RequireNotNegative(core::FrameIndex index) const {
  if (index >= 0) return;
  Fail(fmt::format("frame {} of '{}' is out of range: frames count from 0", index, location),
       core::ErrorKind::kRange);
}

}  // namespace elbowroom::recon
