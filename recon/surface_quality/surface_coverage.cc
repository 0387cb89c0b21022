#include "recon/surface_quality/surface_coverage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "recon/calibration/rig_uncertainty.h"
#include "recon/hull/visual_hull.h"
#include "recon/surface_quality/bounding_edges.h"

namespace elbowroom::recon {
namespace {

// In footprints of a pixel from pixel to pixel: the slope at which a surface is hardly seen any more (76
// degrees), as of CameraTexture.
constexpr double kSteepest = 4.0;

// The same camera with fewer pixels, if it has more than `most_px` a side. Pixel centres are at integers.
core::CameraModel Shrunk(const core::CameraModel& camera, int most_px) {
  core::CameraCalibration calibration = camera.calibration();
  const double share = static_cast<double>(most_px) / std::max(camera.width_px(), camera.height_px());
  if (share >= 1.0) return camera;
  const auto shrink = [&](int* size_px, Eigen::Index axis) {
    const int fewer_px = std::max(1, static_cast<int>(std::lround(share * *size_px)));
    const double scale = static_cast<double>(fewer_px) / *size_px;
    calibration.camera_matrix.row(axis) *= scale;
    calibration.camera_matrix(axis, 2) += 0.5 * scale - 0.5;
    *size_px = fewer_px;
  };
  shrink(&calibration.image_width_px, 0);
  shrink(&calibration.image_height_px, 1);
  return core::CameraModel(std::move(calibration));
}

}  // namespace

SurfaceCoverage::SurfaceCoverage(const core::Rig& rig) {
  for (const core::CameraModel& camera : rig.cameras) {
    const core::CameraModel model = Shrunk(camera, kMostPx);
    const Eigen::Matrix3d& matrix = model.calibration().camera_matrix;
    cameras_.push_back({model, ViewRays(model), std::min(matrix(0, 0), matrix(1, 1)), {}});
  }
}

void SurfaceCoverage::LookAt(const VisualHull& hull) {
  core::Require(hull.rig().cameras.size() == cameras_.size(), "a hull of the rig whose cameras look at it");
  for (Camera& camera : cameras_)
    camera.view = ViewHull(hull, camera.rays, {.surfaces = false, .normals = false}, std::move(camera.view));
}

// A place is on the hull, so that its line of sight meets the hull there at the latest. The picture has the
// depths at which lines through pixel centres do so first. Each of the four around the place is compared with
// the depth that the place's own surface has there, taken as a plane.
bool SurfaceCoverage::Sees(core::CameraIndex index, const Eigen::Vector3d& x_in_world,
                           const Eigen::Vector3d& normal_in_world) const {
  const Camera& camera = cameras_[index];
  if (!IsInPicture(camera.model, x_in_world) || camera.view.width_px == 0) return false;
  const Eigen::Vector3d x_in_cam = camera.model.cam_from_world() * x_in_world;
  const Eigen::Vector3d normal_in_cam = camera.model.cam_from_world().rotation * normal_in_world;
  const Eigen::Vector2d pixel = *camera.model.ProjectInCam(x_in_cam);
  const auto x = static_cast<int>(std::floor(pixel.x())), y = static_cast<int>(std::floor(pixel.y()));
  const double right = pixel.x() - x, low = pixel.y() - y;
  const double footprint_mm = x_in_cam.z() / camera.focal_px;
  double sees = 0.0;
  for (int k = 0; k < 4; ++k) {
    const int dx = k % 2, dy = k / 2;
    const double weight = (dx == 1 ? right : 1.0 - right) * (dy == 1 ? low : 1.0 - low);
    const int u = std::clamp(x + dx, 0, camera.view.width_px - 1);
    const int v = std::clamp(y + dy, 0, camera.view.height_px - 1);
    const double first_mm = camera.view.depth_mm[static_cast<std::size_t>(v * camera.view.width_px + u)];
    const Eigen::Vector2d ray = camera.rays.At(u, v);
    const double plane_mm = normal_in_cam.dot(x_in_cam) / normal_in_cam.dot(ray.homogeneous());
    const double behind_mm =
        std::isfinite(plane_mm)
            ? std::clamp(plane_mm - x_in_cam.z(), -kSteepest * footprint_mm, kSteepest * footprint_mm)
            : 0.0;
    if (first_mm <= 0.0 || x_in_cam.z() + behind_mm <= first_mm + footprint_mm) sees += weight;
  }
  return sees >= 0.5;
}

SurfaceValues SurfaceCoverage::Of(const VisualHull& shown, const HullView& picture,
                                  const ViewRays& rays) const {
  return ValuesOf(shown, picture, rays,
                  [this](core::CameraIndex bounding, const auto& x_in_world, const auto& normal_in_world) {
                    int seeing = 0;
                    // The camera whose silhouette ends here looks along the surface.
                    for (core::CameraIndex i = 0; i < cameras_.size(); ++i)
                      seeing += i == bounding || Sees(i, x_in_world, normal_in_world) ? 1 : 0;
                    return static_cast<float>(seeing);
                  });
}

}  // namespace elbowroom::recon
