// The hull of analytic solids as perfect cameras see them: no pixels, no masks.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "core/rig.h"
#include "recon/hull/ray.h"
#include "recon/synthetic/solids.h"
#include "tests/oracles/first_along.h"

namespace elbowroom::oracles {

// What one camera saw, and what the reconstruction takes it for. Where those differ (a wrong extrinsic
// calibration, a picture taken later than the others'), the hull differs from the true one by that alone.
struct Sight {
  core::CameraModel believed;
  core::RigidTransform true_cam_from_world;
  std::vector<recon::Solid> solids;  // when it looked
};

// The points of the workspace that every camera has in its picture (core::UnseenPolicy decides for those it
// hasn't) and whose sight ray, from the camera's centre through the point and on, hits a solid. Exact as
// recon::FirstHit is. Immutable. Thread: any.
class AnalyticHull {
 public:
  // As the rig itself saw the solids, all at once.
  AnalyticHull(const core::Rig& rig, std::span<const recon::Solid> solids);
  AnalyticHull(const Eigen::AlignedBox3d& workspace_mm, core::UnseenPolicy unseen, std::vector<Sight> sights);

  [[nodiscard]] bool Contains(const Eigen::Vector3d& x_in_world) const;

  // Distance to the first point inside; the march's begin if that is inside. Under `outside` a stretch is
  // passed over where, to some camera, the ball around it and every ball around the solids stand apart.
  [[nodiscard]] std::optional<double> FirstSurface(const recon::Ray& ray,
                                                   const MarchOptions& options = {.step_mm = 0.05}) const;

 private:
  // The cone from an eye around a ball; an eye inside the ball looks everywhere.
  struct Cone {
    Eigen::Vector3d axis_in_world = Eigen::Vector3d::UnitZ();
    double half_angle_rad = 0.0;
    double cos_half_angle = 1.0;
    double sin_half_angle = 0.0;
  };
  struct Eye {
    Sight sight;
    core::RigidTransform seen_from_world;  // from where a point is believed to where the camera sees it
    Eigen::Vector3d center_in_world;       // the true one
    std::vector<Cone> cones;               // around balls that cover the solids
  };

  [[nodiscard]] static Cone ConeAround(const Eigen::Vector3d& eye, const recon::BoundingSphere& ball);
  [[nodiscard]] static bool MayShareARay(const Cone& a, const Cone& b);
  [[nodiscard]] static std::vector<Sight> SightsOf(const core::Rig& rig,
                                                   std::span<const recon::Solid> solids);
  [[nodiscard]] bool IsEmpty(const Eigen::Vector3d& a_in_world, const Eigen::Vector3d& b_in_world) const;

  Eigen::AlignedBox3d workspace_mm_;
  core::UnseenPolicy unseen_;
  std::vector<Eye> eyes_;
};

// Balls that cover a solid: a row of them along a long one.
[[nodiscard]] std::vector<recon::BoundingSphere> CoveringBalls(const recon::Solid& solid);

}  // namespace elbowroom::oracles
