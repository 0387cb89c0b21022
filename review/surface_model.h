// A part's surface as FCL searches it.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "core/bvh.h"
#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"
#include "review/triangle_gap.h"

namespace elbowroom::review {

// Immutable; one for all instances of a mesh. Thread: any.
class SurfaceModel {
 public:
  // The mesh has triangles; they may be open, crossing, without area.
  explicit SurfaceModel(core::SharedMesh mesh);
  ~SurfaceModel();
  SurfaceModel(SurfaceModel&&) noexcept;
  SurfaceModel& operator=(SurfaceModel&&) noexcept;

  [[nodiscard]] const core::TriangleTree& tree() const { return tree_; }
  // One point of each connected piece of the surface, in the part's frame.
  [[nodiscard]] const std::vector<Eigen::Vector3d>& piece_points() const { return piece_points_; }

 private:
  friend class SurfacePair;
  struct FclModel;

  core::TriangleTree tree_;
  std::vector<Eigen::Vector3d> piece_points_;
  std::unique_ptr<const FclModel> fcl_;
};

// Two surfaces where they stand. FCL only chooses which triangles to look at: it says that two meet, and
// those are measured here; or its trees rule out the far ones, and the rest are measured here. Frames are
// joined relative to a, about the middles of both meshes, in long double: parts that stand 10 km from the
// world's origin, or whose files have them there, lose no digits of the gap between them.
// The models must outlive it. Points are in world.
class SurfacePair {
 public:
  SurfacePair(const SurfaceModel& a, const core::RigidTransform& world_from_a, const SurfaceModel& b,
              const core::RigidTransform& world_from_b);

  // The surfaces are no nearer than this: how far apart the meshes' own boxes are, turned as the parts are,
  // along the best of the fifteen axes that can separate two boxes. 0 where none does.
  [[nodiscard]] double BoundsGapMm() const;

  // Two triangles that FCL says meet, measured; nothing if it finds none. The distance needn't be 0: FCL says
  // so of some needles that are apart.
  [[nodiscard]] std::optional<SurfaceGap> FindHullPartIntersection() const;

  // The least distance over all triangles.
  [[nodiscard]] SurfaceGap Measure() const;

 private:
  [[nodiscard]] SurfaceGap InWorld(const SurfaceGap& gap_in_a) const;

  const SurfaceModel& a_;
  const SurfaceModel& b_;
  core::RigidTransform world_from_a_;
  core::RigidTransform a_from_b_;  // between the models' own frames, whose origins are the meshes' middles
};

}  // namespace elbowroom::review
