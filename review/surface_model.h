// A part's surface, prepared for FCL, and the distance of two such surfaces.
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

// Immutable. All instances of a mesh share one. Thread: any.
class SurfaceModel {
 public:
  // The mesh must have triangles. It may be open or cross itself, and triangles may have no area.
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

// Two surfaces at their poses. FCL only chooses which triangles are measured: a pair that it says meets, or
// those that its trees don't rule out as too far. The measuring is done here. a_from_b is worked out in long
// double, between frames whose origins are the middles of the meshes: parts that stand 10 km from the world's
// origin, or whose files place them there, lose no digits of the gap between them. The models must outlive
// it. Points are in world.
class SurfacePair {
 public:
  SurfacePair(const SurfaceModel& a, const core::RigidTransform& world_from_a, const SurfaceModel& b,
              const core::RigidTransform& world_from_b);

  // Lower bound of the surfaces' distance: how far the meshes' oriented boxes are apart along the best of the
  // fifteen axes that can separate two boxes. 0 where none separates them.
  [[nodiscard]] double BoundsGapMm() const;

  // The measured gap of two triangles that FCL says meet. Nothing if FCL finds none. The distance needn't be
  // 0: FCL also says it of some needles that are apart.
  [[nodiscard]] std::optional<SurfaceGap> FindIntersection() const;

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
