// A contour's edges as a view's rays meet them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/camera_model.h"
#include "recon/contours/contour_map.h"
#include "recon/exact_view/cast_intervals.h"
#include "recon/exact_view/object_range_table.h"
#include "recon/exact_view/tile_cast.h"
#include "recon/exact_view/view_rays.h"

namespace elbowroom::recon {

// value(u, v) = u * du + v * dv + at_origin.
struct AffineForm {
  double du = 0.0;
  double dv = 0.0;
  double at_origin = 0.0;

  [[nodiscard]] double At(const Eigen::Vector2d& uv) const { return uv.x() * du + uv.y() * dv + at_origin; }
  [[nodiscard]] CastForm Narrow() const {
    return {static_cast<float>(du), static_cast<float>(dv), static_cast<float>(at_origin)};
  }
};

// All rays of a view and all edges of one camera, ordered by the angle of the epipolar plane they are in, so
// that a bundle of rays finds the edges it can meet at once. Key: grows along the ray; perspective
// -1 / depth_mm, orthographic depth_mm. Edges that no ray of the view can meet are left out.
class EpipolarEdges {
 public:
  EpipolarEdges(const ContourMap& labels, double focal_px, const core::CameraModel& camera,
                const ViewRays& rays);

  [[nodiscard]] const CastPencil& cast() const { return cast_; }

  // The rays all start at, or come from, a point that the camera labels so.
  [[nodiscard]] bool starts_inside() const { return cast_.starts_inside; }

  // The view's centre is the camera's: no ray crosses an edge, each keeps the label of its direction.
  [[nodiscard]] bool is_concentric() const { return is_concentric_; }
  // Then: that label.
  [[nodiscard]] bool IsObjectAlong(const Eigen::Vector2d& uv) const;

  // Rays of the box can be in the camera's object between these keys only; nowhere: least > most.
  struct KeyRange {
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
    [[nodiscard]] bool is_empty() const { return least > most; }
  };
  static constexpr KeyRange kNoKeys{std::numeric_limits<double>::infinity(),
                                    -std::numeric_limits<double>::infinity()};
  [[nodiscard]] KeyRange ObjectKeys(const Eigen::AlignedBox2d& uv_box) const;

 private:
  struct AngleRange {
    double least = 0.0;
    double most = 0.0;
  };
  void TurnOffContour(const Eigen::Vector3d& start_in_view);
  void ChooseAxes(const Eigen::AlignedBox2d& view_box);
  [[nodiscard]] AngleRange AnglesOf(const Eigen::AlignedBox2d& uv_box) const;
  void AddEdges(const Contour& contour, const Eigen::Matrix3d& view_from_cam);
  struct EdgePlane {
    CastForm key;
    EdgeOrder order;
  };
  [[nodiscard]] EdgePlane PlaneAlong(const Eigen::Vector3d& from, const Eigen::Vector3d& along,
                                     bool enters) const;

  const ContourMap& labels_;
  double focal_px_;
  Projection projection_;
  Eigen::Matrix3d cam_from_view_;
  Eigen::Vector3d centre_in_view_;
  double reach_ = 1.0;  // its distance, perspective
  bool is_concentric_ = false;
  // Of the plane across the pencil's axis, the view's middle along the first: angles there are near 0.
  Eigen::Vector3d across_axes_[2];
  AffineForm across_[2];
  Eigen::Vector2d axis_uv_{0.0, 0.0};  // the ray that is the axis; not finite if there is none
  AngleRange view_angles_;
  CastPencil cast_;
  ObjectRangeTable orders_;
};

}  // namespace elbowroom::recon
