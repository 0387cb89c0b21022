// The hull of the paper's volume query: a point's label is read from the silhouettes as textures.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "recon/paper_methods/sweep_cameras.h"

namespace elbowroom::recon {

// A snapshot of one frame's textures: the yardsticks' hull. VisualHull's polygons run up to 0.06 px beside
// the edges between texels (docs/plane_sweep.md, "Labels"). Immutable. Thread: any.
class CoverageHull {
 public:
  // Throws: as MakeSweepCameras.
  CoverageHull(const core::Rig& rig, std::span<const core::SoftMask> masks);

  // In the order of MakeSweepCameras; their view frame is the world.
  [[nodiscard]] std::span<const SweepCamera> cameras() const { return cameras_; }
  [[nodiscard]] bool exterior_is_object() const { return exterior_is_object_; }
  [[nodiscard]] const Eigen::AlignedBox3d& workspace_mm() const { return workspace_mm_; }

  // In the workspace and object to every camera, by the rig's `unseen` policy; in double precision.
  [[nodiscard]] bool Contains(const Eigen::Vector3d& x_in_world) const;

  // True if rounding in OpenGL may give the point either label: some camera's coverage is within 4/256 and a
  // few roundings of one half there (docs/plane_sweep.md, "Rounding"), or the point is at the border of its
  // picture or of the workspace. For rigs at ordinary distances: positions are taken to be good to 0.01 px.
  [[nodiscard]] bool IsMatterOfRounding(const Eigen::Vector3d& x_in_world) const;

  // True if the point is within 0.01 mm of a face of the workspace.
  [[nodiscard]] bool IsAtFace(const Eigen::Vector3d& x_in_world) const;

 private:
  std::vector<SweepCamera> cameras_;
  Eigen::AlignedBox3d workspace_mm_;
  bool exterior_is_object_ = false;
};

}  // namespace elbowroom::recon
