// The cap in the pictures of a rig.
#pragma once

#include <variant>
#include <vector>

#include "core/rig.h"
#include "recon/footage/frame_set.h"
#include "recon/head_pose/cap_finder.h"
#include "recon/head_pose/cap_pose.h"

namespace elbowroom::control {

// Thread: any.
class CapWatch {
 public:
  // Throws: Error{kRange} for a cap that CapFinder refuses.
  CapWatch(const recon::Cap& cap, const core::Rig& rig);

  // The head at the instant of the pictures. A camera without a picture sees nothing.
  [[nodiscard]] std::variant<recon::CapPose, recon::NoCapPose> Find(const recon::FrameSet& frames) const;

 private:
  recon::CapFinder finder_;
  std::vector<recon::CapCamera> cameras_;
};

}  // namespace elbowroom::control
