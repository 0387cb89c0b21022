// The hull of given masks by marching every ray in steps of 0.02 mm: what the fast views are held to.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/hull/ray.h"
#include "tests/oracles/first_along.h"
#include "tests/oracles/picture_labels.h"

namespace elbowroom::oracles {

// Labels straight from the masks (PictureLabels), projection in long double (camera_projection.h), the rig's
// `unseen` policy (what a camera sees ends at its picture's outline, by the same convention as silhouettes),
// the workspace's closed box. Shares no code with recon's hull. Immutable. Thread: any.
class MaskHullOracle {
 public:
  // Throws: PreconditionError unless there is one mask a camera, of its picture's size.
  MaskHullOracle(core::Rig rig, std::span<const core::SoftMask> masks, BoundaryConvention convention);

  // `grow_px` moves every silhouette's boundary outwards: a ray whose answers for -0.02 and +0.02 px lie far
  // apart grazes.
  [[nodiscard]] bool Contains(const Vector3L& x_in_world, double grow_px = 0.0) const;

  // Distance to the first point inside; the march's begin if that is inside. Under `outside` a stretch is
  // passed over where the box around its (straight) image in some camera's normalised plane holds no object
  // pixel's surroundings of two pixels; under `abstain` nothing is.
  [[nodiscard]] std::optional<double> FirstSurface(const recon::Ray& ray, double grow_px = 0.0,
                                                   const MarchOptions& options = {}) const;

 private:
  // Where in a camera's normalised plane object pixels lie, on a grid of kTilesASide^2; sums over rectangles.
  class ObjectTiles {
   public:
    ObjectTiles(const core::CameraModel& camera, const core::BitMask& mask);
    [[nodiscard]] bool AnyIn(const Eigen::AlignedBox2d& normalised) const;

   private:
    [[nodiscard]] Eigen::Vector2i TileOf(const Eigen::Vector2d& normalised) const;
    bool is_everywhere_ = false;  // part of the silhouette lies beyond the lens's domain
    Eigen::AlignedBox2d bounds_;
    std::vector<std::int32_t> sums_;
  };

  [[nodiscard]] bool IsEmpty(const Vector3L& a_in_world, const Vector3L& b_in_world) const;

  core::Rig rig_;
  std::vector<PictureLabels> labels_;
  std::vector<PictureLabels> outlines_;  // under `abstain`: what each camera sees
  std::vector<ObjectTiles> tiles_;
};

}  // namespace elbowroom::oracles
