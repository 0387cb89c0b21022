// The volume query's shaders, written for the cameras at hand, and the counting of cameras. For the .cc files
// of this folder: it includes OpenGL.
#pragma once

#include <epoxy/gl.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <string>

#include "recon/gl/objects/shader_program.h"
#include "recon/paper_methods/sweep_cameras.h"

namespace elbowroom::recon::gl {

// What a pass over a plane, or over triangles, keeps; the rest is discarded.
enum class SweepPass {
  kHull,    // points in the hull: all cameras in one pass
  kObject,  // points that every camera of the group says (or doesn't deny) are object
  kSeen,    // points that some camera of the group sees
  kPlane,   // everything
};

// Where a fragment's ray and what maps it come from.
enum class SweepRaySource {
  kIdealView,   // the pixel, by a uniform matrix
  kRayTexture,  // a texel for each pixel: the view's lens isn't ideal
  kViewport,    // the position in a triangle's viewport; matrices come with the triangle, for one camera
};

struct SweepShader {
  SweepPass pass = SweepPass::kHull;
  std::span<const SweepCamera> group;
  bool exterior_is_object = false;
  bool tests_workspace = false;
  SweepRaySource ray_source = SweepRaySource::kIdealView;

  [[nodiscard]] std::string FragmentSource() const;
};

// One triangle over the picture at window depth `plane_depth`.
[[nodiscard]] std::string SweepVertexSource();

// Triangles in viewports of a page of `page_px`. Attributes: position on the page and its viewport's lower
// left corner, px; then origin, along x, along y of recon::TriangleViewport in the world. The camera of the
// pass is `rotation` and `translation`, to picture positions for an ideal one, else to cam.
[[nodiscard]] std::string ViewportVertexSource();

// From the normalised plane to positions that count from the coverage's first texel.
[[nodiscard]] Eigen::Matrix3d PictureFromNormalised(const SweepCamera& camera);

// The uniforms of camera `index` of the program's group, less what maps rays to it.
void SetCamera(const ShaderProgram& program, const SweepCamera& camera, std::size_t index);
void SetWorkspace(const ShaderProgram& program, const Eigen::AlignedBox3d& workspace_mm);

// The stencil counts the groups of cameras that have said object in its lower bits; kSeenBit: one of them
// sees the point.
inline constexpr GLuint kSeenBit = 0x80;
void SetStencil(SweepPass kind, GLuint wanted_count);

}  // namespace elbowroom::recon::gl
