// The camera and its source, as error messages name them.
#pragma once

#include <cstdint>
#include <string>

#include "core/error.h"
#include "core/ids.h"

namespace elbowroom::recon {

struct SourceSubject {
  std::string who;  // "camera 'cam01'"
  std::string location;
  int width_px = 0;
  int height_px = 0;
  // Who says so, for messages, and what to do about another size.
  std::string size_from = "the rig says";
  std::string size_remedy = "use footage of the calibrated size";

  [[noreturn]] void Fail(const std::string& what, core::ErrorKind kind = core::ErrorKind::kFile) const;
  void RequireSize(std::int64_t found_width_px, std::int64_t found_height_px, core::FrameIndex index) const;
  void RequireNotNegative(core::FrameIndex index) const;
};

}  // namespace elbowroom::recon
