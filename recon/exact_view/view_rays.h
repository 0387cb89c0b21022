// The rays of a picture to be made: one through each pixel's centre.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/camera_model.h"
#include "core/rigid_transform.h"
#include "recon/exact_view/half_space.h"

namespace elbowroom::recon {

enum class Projection { kPerspective, kOrthographic };

// Frames: view (x right, y down, z forward). A pixel's ray is given by two numbers (u, v): perspective, it
// goes from the origin through (u, v, 1); orthographic, from (u, v, 0) mm along z. The rays of a lens are
// worked out once, about 3 ms for 640 x 480: keep them while only the pose changes. Immutable. Thread: any.
class ViewRays {
 public:
  // Orthographic: camera_matrix holds pixels per mm and the lens must be ideal.
  // Throws: core::Error{kCamera} for an orthographic camera with distortion.
  explicit ViewRays(const core::CameraModel& view, Projection projection = Projection::kPerspective);

  // The same rays from elsewhere.
  [[nodiscard]] ViewRays From(const core::RigidTransform& view_from_world) const;
  // The same rays, looked along only within all of these half-spaces of world: a hull that they meet is cut
  // open, and closed by the planes.
  [[nodiscard]] ViewRays Within(std::vector<HalfSpace> half_spaces) const;

  // Whether both have the same rays, whatever their places and half-spaces. Rays through a lens count as the
  // same only if one object is a copy of the other.
  [[nodiscard]] bool HasSameRays(const ViewRays& other) const;

  [[nodiscard]] Projection projection() const { return projection_; }
  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }
  [[nodiscard]] const core::RigidTransform& view_from_world() const { return view_from_world_; }
  [[nodiscard]] const std::vector<HalfSpace>& half_spaces() const { return half_spaces_; }

  // NaN where the lens has no ray for the pixel.
  [[nodiscard]] Eigen::Vector2d At(int x, int y) const {
    if (lens_ == nullptr) return uv_from_pixel_ * Eigen::Vector2d(x, y) + uv_of_origin_;
    return lens_->by_pixel[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px_) +
                           static_cast<std::size_t>(x)];
  }

  // Writes the rays of the tile (kTilePx) whose first pixel is (x, y), row by row, as float32. NaN where
  // there is no ray, also outside of the picture.
  void FillTile(int x, int y, float* u, float* v) const;

  // The box around the rays (u, v) of pixels [x0, x1) x [y0, y1). All four are multiples of 8, or at the
  // picture's border.
  [[nodiscard]] Eigen::AlignedBox2d BoundsOf(int x0, int y0, int x1, int y1) const;

 private:
  struct Lens {
    std::vector<Eigen::Vector2d> by_pixel;
    std::vector<Eigen::AlignedBox2d> tile_boxes;  // of its 8 x 8 tiles
  };
  [[nodiscard]] static std::shared_ptr<const Lens> LensOf(const core::CameraModel& view);

  Projection projection_;
  int width_px_;
  int height_px_;
  core::RigidTransform view_from_world_;
  std::vector<HalfSpace> half_spaces_;
  Eigen::Matrix2d uv_from_pixel_ = Eigen::Matrix2d::Identity();
  Eigen::Vector2d uv_of_origin_ = Eigen::Vector2d::Zero();
  std::shared_ptr<const Lens> lens_;  // null: none
};

}  // namespace elbowroom::recon
