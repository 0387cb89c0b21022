// A surface as one camera sees it, dense enough to measure distances to.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "core/camera_model.h"
#include "recon/hull/ray.h"
#include "recon/images/depth_map.h"

namespace elbowroom::accuracy {

// Distance along the ray of the first surface point; nothing on a miss.
using FirstSurfaceOf = std::function<std::optional<double>(const recon::Ray&)>;

// The ray through a pixel's centre. Throws: PreconditionError where the lens has none.
[[nodiscard]] recon::Ray RayThrough(const core::CameraModel& view, int x, int y);

// Depth along the z axis at every `stride`-th pixel in both directions, 0 at all others. Parallel over rows.
[[nodiscard]] recon::DepthMap PictureOf(const core::CameraModel& view, const FirstSurfaceOf& first_surface,
                                        int stride = 1);

// A depth map as a surface in space: a point a pixel, and triangles between neighbours, none across a jump in
// depth.
class SurfacePicture {
 public:
  // `view` has no distortion.
  SurfacePicture(core::CameraModel view, recon::DepthMap depth);

  [[nodiscard]] const core::CameraModel& view() const { return view_; }
  [[nodiscard]] const recon::DepthMap& depth() const { return depth_; }
  [[nodiscard]] double DepthAt(int x, int y) const;

  // World position of a depth in a pixel.
  [[nodiscard]] Eigen::Vector3d PointAt(int x, int y, double depth_mm) const;

  // Distance from a point to the surface, looked for within kReachPx of pixel (x, y); nothing where the
  // surface has no point there.
  static constexpr int kReachPx = 24;
  [[nodiscard]] std::optional<double> DistanceMm(const Eigen::Vector3d& point_in_world, int x, int y) const;

 private:
  void TakeNearer(const Eigen::Vector3d& point_in_world, int x, int y, double* nearest_mm) const;

  core::CameraModel view_;
  recon::DepthMap depth_;
};

// Distance from a point to a triangle.
[[nodiscard]] double DistanceToTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                        const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace elbowroom::accuracy
