// A contour's edges as a view's rays meet them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "core/camera_model.h"
#include "recon/contour_map.h"
#include "recon/view_rays.h"

namespace elbowroom::recon {

// value(u, v) = u * du + v * dv + at_origin.
struct AffineForm {
  double du = 0.0;
  double dv = 0.0;
  double at_origin = 0.0;

  [[nodiscard]] double At(const Eigen::Vector2d& uv) const { return uv.x() * du + uv.y() * dv + at_origin; }
};

// The surface that one edge sweeps, from the camera's centre outwards. The ray (u, v) meets it where its
// `key` is key.At(u, v), provided that the ends' sides agree with the kind: entering the object, from > 0 and
// not to > 0; leaving it, not from > 0 and to > 0. Derivation: docs/exact_view.md.
struct PencilEdge {
  AffineForm from;  // side of the epipolar plane that the edge's ends are on
  AffineForm to;
  AffineForm key;
  bool enters = false;
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

  [[nodiscard]] bool HasEdges(const BinRange& range) const;

  // Calls visit(index of edge, edge) once for each edge with a bin in the range.
  template <typename Visit>
  void VisitEdges(const BinRange& range, const Visit& visit) const {
    for (std::uint32_t i = 0; i < range.count; ++i) {
      const std::uint32_t bin = (range.first + i) % kBins;
      for (std::uint32_t j = first_[bin]; j < first_[bin + 1]; ++j) {
        const Entry& entry = entries_[j];
        // An edge of several bins is visited in the first of them that the range has.
        if (entry.is_first_bin || i == 0) visit(entry.edge, edges_[entry.edge]);
      }
    }
  }

  static constexpr std::uint32_t kBins = 2048;

 private:
  struct Entry {
    std::uint32_t edge : 31;
    std::uint32_t is_first_bin : 1;
  };

  void TurnOffContour(const Eigen::Vector3d& start_in_view);
  void MakeEdges(const Contour& contour, const Eigen::Matrix3d& view_from_cam);
  void SortIntoBins(const Contour& contour, const Eigen::Matrix3d& view_from_cam);
  [[nodiscard]] Eigen::Vector3d InView(const Eigen::Matrix3d& view_from_cam, const Eigen::Vector2d& v) const {
    return view_from_cam * Eigen::Vector3d(v.x(), v.y(), focal_px_);
  }

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
  std::vector<PencilEdge> edges_;
  std::vector<std::uint32_t> first_;
  std::vector<Entry> entries_;
};

}  // namespace elbowroom::recon
