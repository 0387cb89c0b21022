// The plane sweep's shaders, written for the cameras at hand. For the .cc files of this folder.
#pragma once

#include <span>
#include <string>

#include "recon/sweep_space.h"

namespace elbowroom::recon::gl {

// What a pass of a plane keeps; the rest is discarded.
enum class SweepPass {
  kHull,    // points in the hull: all cameras in one pass
  kObject,  // points that every camera of the group says (or doesn't deny) are object
  kSeen,    // points that some camera of the group sees
  kPlane,   // everything
};

struct SweepShader {
  SweepPass pass = SweepPass::kHull;
  std::span<const SweepCamera> group;
  bool exterior_is_object = false;
  bool tests_workspace = false;
  bool has_ray_texture = false;  // the view's lens isn't ideal

  [[nodiscard]] std::string FragmentSource() const;
};

// One triangle over the picture at window depth `plane_depth`.
[[nodiscard]] std::string SweepVertexSource();

}  // namespace elbowroom::recon::gl
