// The viewing ray of every pixel of a camera, and small tiles of pixels with the cone that holds their rays.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/camera_model.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::recon {

// A square of pixels [x0, x1) x [y0, y1), and the cone from the camera's centre around all rays through them.
struct PixelTile {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  Eigen::Vector3d axis_in_world = Eigen::Vector3d::UnitZ();
  double cos_half_angle = 1.0;
  double sin_half_angle = 0.0;
};

// Undistorts every pixel centre once. Immutable. Rays are kept in single precision: 1e-4 px.
class PixelRays {
 public:
  // Throws: Error{kCamera} naming the camera when its lens has no ray for some pixel.
  explicit PixelRays(const core::CameraModel& camera);

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }
  [[nodiscard]] const std::vector<PixelTile>& tiles() const { return tiles_; }
  [[nodiscard]] const Eigen::Vector3d& center_in_world() const { return center_in_world_; }

  [[nodiscard]] Ray At(int x, int y) const;

  // The ray through a point within the pixel, at most half a pixel from its centre: linear between centres.
  [[nodiscard]] Ray At(int x, int y, const Eigen::Vector2d& from_center_px) const;

  // False only if no ray through a point of the tile's pixels meets the sphere.
  [[nodiscard]] bool MayMeet(const PixelTile& tile, const BoundingSphere& sphere) const;

 private:
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px_) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] PixelTile Tile(int x0, int y0) const;

  int width_px_ = 0;
  int height_px_ = 0;
  Eigen::Vector3d center_in_world_;
  Eigen::Matrix3d world_from_cam_;
  std::vector<Eigen::Vector2f> normalised_;  // row-major
  std::vector<PixelTile> tiles_;
};

}  // namespace elbowroom::recon
