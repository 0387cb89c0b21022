// The source of the volume query's shaders for given cameras, and the stencil buffer's settings for counting
// cameras. For the .cc files of this folder: it includes OpenGL.
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
  kObject,  // points that are object to all cameras of the group, by the unseen policy
  kSeen,    // points that some camera of the group sees
  kPlane,   // everything
};

// Where a fragment's ray comes from.
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
  // Picture positions come from the vertices, for a group of one camera, instead of from the lens.
  bool has_grid_positions = false;

  [[nodiscard]] std::string FragmentSource() const;
};

// One triangle over the picture at window depth `plane_depth`.
[[nodiscard]] std::string SweepVertexSource();

// Triangles of recon::PlaneGrid at window depth `plane_depth`. Attributes: position in the view's picture, 0
// to 1; then that in the camera's, homogeneous (recon::GridTriangle), counted from its coverage's first
// texel; zero where there is none.
[[nodiscard]] std::string GridVertexSource();

// Triangles in viewports of a page of `page_px`. Attributes: position on the page and its viewport's lower
// left corner, px; then origin, along x, along y of recon::TriangleViewport in the world. The camera of the
// pass is in the uniforms `rotation` and `translation`: they lead to picture positions for an ideal camera,
// else to cam.
[[nodiscard]] std::string ViewportVertexSource();

// From the normalised plane to positions that count from the coverage's first texel.
[[nodiscard]] Eigen::Matrix3d PictureFromNormalised(const SweepCamera& camera);

// Sets the uniforms of camera `index` of the program's group, except those that map rays to it.
void SetCamera(const ShaderProgram& program, const SweepCamera& camera, std::size_t index);
void SetWorkspace(const ShaderProgram& program, const Eigen::AlignedBox3d& workspace_mm);

// The lower bits of the stencil count the groups of cameras that label the point object. kSeenBit is set if
// one of the cameras sees it.
inline constexpr GLuint kSeenBit = 0x80;
void SetStencil(SweepPass kind, GLuint wanted_count);

}  // namespace elbowroom::recon::gl
