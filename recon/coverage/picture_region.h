// What a camera has in its picture: a cone of rays from its centre.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/camera_model.h"
#include "recon/coverage/ray_stretches.h"

namespace elbowroom::recon {

// Points start + t along, t >= 0, in a camera's frame.
struct RayInCam {
  Eigen::Vector3d start;
  Eigen::Vector3d along;

  [[nodiscard]] Eigen::Vector3d At(double t) const { return start + t * along; }
};

// The picture's border as a polygon of rays; the lens bends its sides, so that each is several edges long
// (one, of a lens without distortion). The border of a strong lens ends where the lens has no ray. Off by
// less than two pixels from core::CameraModel::Project (picture_region_test). Immutable. Thread: any.
class PictureRegion {
 public:
  explicit PictureRegion(const core::CameraModel& camera);

  // The point, in the camera's frame, is before the camera and in its picture.
  [[nodiscard]] bool Holds(const Eigen::Vector3d& x_in_cam) const;
  // True only if the whole ball, in the camera's frame, is in the picture; may be false beside a side that
  // the lens bends inwards.
  [[nodiscard]] bool SurelyHoldsBall(const Eigen::Vector3d& center_in_cam, double radius_mm) const;
  // Sets `seen` to the stretches of the ray within `within` that are in the picture.
  void Cut(const RayInCam& ray, const Stretch& within, RayStretches* seen) const;

 private:
  struct Edge {
    Eigen::Vector3d begin;        // ray (x, y, 1)
    Eigen::Vector3d inward;       // unit normal of the plane through the centre and the edge
    Eigen::Vector3d after_begin;  // x . after_begin >= 0 and x . before_end >= 0 for the plane's points
    Eigen::Vector3d before_end;   // between the rays of the edge's ends
  };
  [[nodiscard]] Stretch CutConvex(const RayInCam& ray, Stretch within) const;

  std::vector<Edge> edges_;
  bool is_convex_ = true;
};

}  // namespace elbowroom::recon
