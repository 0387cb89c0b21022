// One camera's picture without its lens: where silhouettes become straight-edged and projection a division.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/bit_mask.h"
#include "core/camera_model.h"
#include "core/rig.h"

namespace elbowroom::recon {

class ContourMap;

// The plane of a camera at z = focal_px(): a point X, Y, Z in cam falls on focal_px() * (X, Y) / Z, the
// principal axis on (0, 0). Isotropic and free of distortion; a pixel is about one unit wide (its finer side,
// if they differ). The lens is applied once, to the silhouette's vertices. Immutable. Thread: any.
class UndistortedPlane {
 public:
  explicit UndistortedPlane(const core::CameraModel& camera);
  ~UndistortedPlane();

  [[nodiscard]] const core::CameraModel& camera() const { return camera_; }
  [[nodiscard]] double focal_px() const { return focal_px_; }

  // Where a position of the picture, its border included, falls in the plane, to 1e-5 units
  // (undistorted_plane_test); nothing where the lens's domain doesn't reach.
  [[nodiscard]] std::optional<Eigen::Vector2d> FromPixel(const Eigen::Vector2d& pixel) const;

  // The pixels whose centres the lens's domain doesn't reach; nothing if there are none, as is usual.
  [[nodiscard]] const std::optional<core::BitMask>& unseen_pixels() const { return unseen_pixels_; }

  // What the camera sees, as object, for whom that matters: made when first asked for.
  [[nodiscard]] const ContourMap& outline() const;

 private:
  void FillTable(int step_px);
  [[nodiscard]] Eigen::Vector2d NodesAt(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] Eigen::Vector2d FromTable(const Eigen::Vector2d& at_nodes) const;
  // `nearby`: a place in the plane that isn't far off; NaN: none is known.
  [[nodiscard]] std::optional<Eigen::Vector2d> Exactly(const Eigen::Vector2d& pixel,
                                                       const Eigen::Vector2d& nearby) const;
  void FindBentCells();
  [[nodiscard]] core::BitMask FindUnseenPixels() const;
  [[nodiscard]] Eigen::Vector2i CellOf(const Eigen::Vector2d& at_nodes) const;

  core::CameraModel camera_;
  double focal_px_ = 1.0;
  bool is_ideal_ = false;                                           // no lens to speak of
  Eigen::Matrix2d plane_from_pixel_ = Eigen::Matrix2d::Identity();  // of an ideal lens, about
  Eigen::Vector2d principal_px_ = Eigen::Vector2d::Zero();          // this pixel
  // Nodes over the picture, each on its place in the plane, NaN where there is none; between them cubic.
  Eigen::Vector2i nodes_{0, 0};
  Eigen::Vector2d pixels_per_node_{0.0, 0.0};
  Eigen::Vector2d nodes_per_pixel_{0.0, 0.0};
  std::vector<Eigen::Vector2d> table_;
  core::BitMask bent_cells_;  // between nodes: the cubic doesn't follow the lens there
  std::optional<core::BitMask> unseen_pixels_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<const ContourMap> outline_;
};

// One a camera, in the rig's order. Worked out once a rig: a lens costs about a millisecond.
using UndistortedPlanes = std::vector<std::shared_ptr<const UndistortedPlane>>;
[[nodiscard]] UndistortedPlanes MakeUndistortedPlanes(const core::Rig& rig);

}  // namespace elbowroom::recon
