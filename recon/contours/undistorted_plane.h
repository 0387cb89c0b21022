// One camera's picture plane without the distortion of its lens. Straight edges in space are straight in it,
// and projection is one division.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/bit_mask.h"
#include "core/camera_model.h"
#include "core/rig.h"

namespace elbowroom::recon {

class ContourMap;
struct NodeTable;

// The plane z = focal_px() in the camera's frame. A point (X, Y, Z) of that frame falls on
// focal_px() * (X, Y) / Z; the principal axis falls on (0, 0). One unit is about one pixel; where pixels
// aren't square, it is their shorter side. Only the vertices of a contour go through the lens, once.
// Immutable. Thread: any.
class UndistortedPlane {
 public:
  explicit UndistortedPlane(const core::CameraModel& camera);
  ~UndistortedPlane();

  [[nodiscard]] const core::CameraModel& camera() const { return camera_; }
  [[nodiscard]] double focal_px() const { return focal_px_; }

  // From a position in the picture, its border included, to one in the plane, to 1e-5 units
  // (undistorted_plane_test). Nothing where the lens model has no ray for that position.
  [[nodiscard]] std::optional<Eigen::Vector2d> FromPixel(const Eigen::Vector2d& pixel) const;
  // The same for many at once, to the last bit; NaN in place of nothing. `positions` has room for one a
  // pixel.
  void FromPixels(std::span<const Eigen::Vector2d> pixels, Eigen::Vector2d* positions) const;

  // The pixels for whose centres the lens model has no ray. Nothing if there are none, as is usual.
  [[nodiscard]] const std::optional<core::BitMask>& unseen_pixels() const { return unseen_pixels_; }

  // A contour around all that the camera sees, which is labelled object. Made at the first call; only the
  // policy `abstain` needs it.
  [[nodiscard]] const ContourMap& outline() const;

 private:
  void FillTable(int step_px);
  [[nodiscard]] Eigen::Vector2d NodesAt(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] NodeTable Table() const;
  [[nodiscard]] Eigen::Vector2d FromTable(const Eigen::Vector2d& at_nodes) const;
  // `nearby`: a position in the plane near the result; NaN if none is known.
  [[nodiscard]] std::optional<Eigen::Vector2d> Exactly(const Eigen::Vector2d& pixel,
                                                       const Eigen::Vector2d& nearby) const;
  void FindBentCells();
  [[nodiscard]] core::BitMask FindUnseenPixels() const;
  [[nodiscard]] Eigen::Vector2i CellOf(const Eigen::Vector2d& at_nodes) const;

  core::CameraModel camera_;
  double focal_px_ = 1.0;
  bool is_ideal_ = false;                                           // the camera has no distortion
  Eigen::Matrix2d plane_from_pixel_ = Eigen::Matrix2d::Identity();  // used if it is ideal
  Eigen::Vector2d principal_px_ = Eigen::Vector2d::Zero();          // where the principal axis falls
  // A grid of nodes over the picture. For each its position in the plane, or NaN where the lens has no ray;
  // positions between nodes are interpolated by a cubic.
  Eigen::Vector2i nodes_{0, 0};
  Eigen::Vector2d pixels_per_node_{0.0, 0.0};
  Eigen::Vector2d nodes_per_pixel_{0.0, 0.0};
  std::vector<Eigen::Vector2d> table_;
  core::BitMask bent_cells_;  // cells between nodes in which the cubic isn't exact enough
  std::optional<core::BitMask> unseen_pixels_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<const ContourMap> outline_;
};

// One a camera, in the rig's order. Worked out once a rig: a lens costs about a millisecond.
using UndistortedPlanes = std::vector<std::shared_ptr<const UndistortedPlane>>;
[[nodiscard]] UndistortedPlanes MakeUndistortedPlanes(const core::Rig& rig);

}  // namespace elbowroom::recon
