// What the plane sweeps on the CPU and in OpenGL share: cameras, planes, and which regions can't hold any
// hull.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "recon/paper_methods/plane_sweep.h"
#include "recon/paper_methods/sweep_cameras.h"

namespace elbowroom::recon {

// Pixels [x0, x1) x [y0, y1) of the view (lower ends multiples of kSweepTilePx) on planes [first, end).
struct SweepRegion {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int first_plane = 0, end_plane = 0;
};

// What is still to be asked of a region's points.
struct OpenQuestions {
  std::uint64_t cameras = 0;  // bit i: SweepSpace::cameras()[i]
  bool is_seen = false;       // some camera is known to see all of the points
  bool in_workspace = false;  // all are known to be in the workspace
  [[nodiscard]] bool IsSettled() const { return cameras == 0 && is_seen && in_workspace; }
};

// Frames: view (the view camera's), cam, world. Immutable. Thread: any.
class SweepSpace {
 public:
  // Keeps references to view and rays. Throws: as SweepPlanes.
  SweepSpace(const core::Rig& rig, std::span<const core::SoftMask> masks, const core::CameraModel& view,
             const SweepRays& rays, const PlaneSweepOptions& options);

  [[nodiscard]] const SweepRays& rays() const { return rays_; }
  // In the order of MakeSweepCameras.
  [[nodiscard]] std::span<const SweepCamera> cameras() const { return cameras_; }
  [[nodiscard]] bool exterior_is_object() const { return exterior_is_object_; }
  [[nodiscard]] const core::RigidTransform& world_from_view() const { return world_from_view_; }
  [[nodiscard]] const Eigen::AlignedBox3d& workspace_mm() const { return workspace_mm_; }

  [[nodiscard]] int plane_count() const { return plane_count_; }
  [[nodiscard]] double DepthMmOf(int plane) const {
    return static_cast<double>(first_multiple_ + plane) * spacing_mm_;
  }

  [[nodiscard]] OpenQuestions AllQuestions() const;

  // What is still to be asked of a region, given what is `open` of a region around it. Nothing if no point of
  // the region is in the hull.
  [[nodiscard]] std::optional<OpenQuestions> Narrow(const SweepRegion& region,
                                                    const OpenQuestions& open) const;

  // True if the region is deeper than wide, so that halving its planes tells more than quartering its pixels.
  [[nodiscard]] bool IsDeep(const SweepRegion& region) const;

 private:
  void PlacePlanes(const PlaneSweepOptions& options);

  const SweepRays& rays_;
  core::RigidTransform world_from_view_;
  Eigen::AlignedBox3d workspace_mm_;
  bool exterior_is_object_ = false;
  std::vector<SweepCamera> cameras_;
  double spacing_mm_;
  std::int64_t first_multiple_ = 1;
  int plane_count_ = 0;
};

}  // namespace elbowroom::recon
