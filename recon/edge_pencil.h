// A contour's edges as a view's rays meet them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "core/camera_model.h"
#include "recon/contour_map.h"
#include "recon/tile_cast.h"
#include "recon/view_rays.h"

namespace elbowroom::recon {

// value(u, v) = u * du + v * dv + at_origin.
struct AffineForm {
  double du = 0.0;
  double dv = 0.0;
  double at_origin = 0.0;

  [[nodiscard]] double At(const Eigen::Vector2d& uv) const { return uv.x() * du + uv.y() * dv + at_origin; }
};

// All rays of a view and all edges of one camera, ordered by the angle of the epipolar plane they are in, so
// that a bundle of rays finds the edges it can meet at once. Key: grows along the ray; perspective
// -1 / depth_mm, orthographic depth_mm.
class EdgePencil {
 public:
  EdgePencil(const ContourMap& labels, double focal_px, const core::CameraModel& camera,
             const ViewRays& rays);

  // The rays all start at, or run away from, a point that the camera labels so.
  [[nodiscard]] bool starts_inside() const { return starts_inside_; }

  // The view's centre is the camera's: no ray crosses an edge, each keeps the label of its direction.
  [[nodiscard]] bool is_concentric() const { return is_concentric_; }
  // Then: that label.
  [[nodiscard]] bool IsObjectAlong(const Eigen::Vector2d& uv) const;

  // Angular bins that rays of the box can lie in.
  struct BinRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  [[nodiscard]] BinRange BinsOf(const Eigen::AlignedBox2d& uv_box) const;

  // The edges that may cross rays of the bins.
  [[nodiscard]] CastEdges EntriesIn(const BinRange& range) const { return entries_.In(range); }
  [[nodiscard]] CastEdges ExitsIn(const BinRange& range) const { return exits_.In(range); }

  static constexpr std::uint32_t kBins = 4096;

 private:
  // Edges by the bin where they begin, and of each bin those that began before it.
  struct SortedEdges {
    std::vector<CastEdge> edges;
    std::vector<std::uint32_t> first;          // in `edges`, by bin; one more at the end
    std::vector<std::uint32_t> carried;        // numbers in `edges`
    std::vector<std::uint32_t> first_carried;  // in `carried`, by bin; one more at the end

    [[nodiscard]] CastEdges In(const BinRange& range) const;
  };
  struct UnsortedEdge {
    CastEdge edge;
    BinRange bins;
  };

  void SortEdges(const Contour& contour, const Eigen::Matrix3d& view_from_cam);
  static SortedEdges Sorted(const std::vector<UnsortedEdge>& edges);
  [[nodiscard]] bool MakeEdge(const Eigen::Vector3d& from, const Eigen::Vector3d& along, CastForm* key) const;

  const ContourMap& labels_;
  double focal_px_;
  Projection projection_;
  Eigen::Matrix3d cam_from_view_;
  Eigen::Vector3d centre_in_view_;
  bool starts_inside_ = false;
  bool is_concentric_ = false;
  // Of the plane across the pencil's axis: the coordinates in which angles are taken, by (u, v) and by
  // vector.
  AffineForm across_[2];
  Eigen::Vector3d across_axes_[2];
  Eigen::Vector2d axis_uv_{0.0, 0.0};  // the ray that is the axis; not finite if there is none
  SortedEdges entries_;
  SortedEdges exits_;
};

}  // namespace elbowroom::recon
