// A contour's edges, ordered so that the rays of a view find those that they can meet.
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

// A ray of the view and an edge of the camera's contour can meet only if one epipolar plane (through the
// view's centre and the camera's) holds the ray and cuts the edge. Both are therefore ordered by the angle of
// that plane, and rays of a range of angles look at the edges of that range alone. Edges that no ray of the
// view can meet are left out. A crossing's place on its ray is given as a key, which grows along the ray:
// -1 / depth_mm in a perspective view, depth_mm in an orthographic one. A key is linear in (u, v) over the
// rays that cross one edge. Derived in docs/exact_view.md.
class EpipolarEdges {
 public:
  EpipolarEdges(const ContourMap& labels, double focal_px, const core::CameraModel& camera,
                const ViewRays& rays);

  [[nodiscard]] const CastPencil& cast() const { return cast_; }

  // The label that the camera gives to where the rays start: the view's centre, or infinitely far behind.
  [[nodiscard]] bool starts_inside() const { return cast_.starts_inside; }

  // The view's centre is the camera's centre: then no ray crosses an edge, and a ray has one label all along.
  [[nodiscard]] bool is_concentric() const { return is_concentric_; }
  // That label. Only for a concentric view.
  [[nodiscard]] bool IsObjectAlong(const Eigen::Vector2d& uv) const;

  // Between which keys the rays of a box can be object to the camera. Empty: nowhere.
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
  double reach_ = 1.0;  // its distance from the view's centre; 1 for an orthographic view
  bool is_concentric_ = false;
  // Axes of a plane at right angles to the axis of the pencil. The first points to the middle of the view, so
  // that the angles of the view's rays are near 0 and far from the jump at pi.
  Eigen::Vector3d across_axes_[2];
  AffineForm across_[2];
  Eigen::Vector2d axis_uv_{0.0, 0.0};  // the ray that is the axis; not finite if there is none
  AngleRange view_angles_;
  CastPencil cast_;
  ObjectRangeTable orders_;
};

}  // namespace elbowroom::recon
