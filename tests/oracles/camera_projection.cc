#include "tests/oracles/camera_projection.h"

#include <array>
#include <cmath>

namespace elbowroom::oracles {
namespace {

Vector2L DistortFisheye(const std::vector<double>& k, const Vector2L& n) {
  const long double r = n.norm();
  if (r == 0.0L) return n;
  const long double theta = std::atan(r), t2 = theta * theta;
  long double series = 0.0L;
  for (std::size_t i = k.size(); i-- > 0;) series = (series + k[i]) * t2;
  return n * (theta * (1.0L + series) / r);
}

// k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4]]]
Vector2L DistortBrown(const std::vector<double>& coefficients, const Vector2L& n) {
  std::array<long double, 12> c{};
  for (std::size_t i = 0; i < std::min(coefficients.size(), c.size()); ++i) c[i] = coefficients[i];
  const long double x = n.x(), y = n.y(), r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  const long double radial =
      (1.0L + c[0] * r2 + c[1] * r4 + c[4] * r6) / (1.0L + c[5] * r2 + c[6] * r4 + c[7] * r6);
  return {x * radial + 2.0L * c[2] * x * y + c[3] * (r2 + 2.0L * x * x) + c[8] * r2 + c[9] * r4,
          y * radial + c[2] * (r2 + 2.0L * y * y) + 2.0L * c[3] * x * y + c[10] * r2 + c[11] * r4};
}

}  // namespace

Vector3L InCam(const core::CameraModel& camera, const Vector3L& x_in_world) {
  return camera.cam_from_world().rotation.cast<long double>() * x_in_world +
         camera.cam_from_world().translation_mm.cast<long double>();
}

std::optional<Vector2L> Project(const core::CameraModel& camera, const Vector3L& x_in_world) {
  const Vector3L x_in_cam = InCam(camera, x_in_world);
  if (!(x_in_cam.z() > 0.0L)) return std::nullopt;
  const Vector2L normalised = x_in_cam.head<2>() / x_in_cam.z();
  if (!(normalised.norm() <= static_cast<long double>(camera.max_radius()))) return std::nullopt;
  const core::CameraCalibration& c = camera.calibration();
  const Vector2L d = c.distortion_model == core::DistortionModel::kFisheye
                         ? DistortFisheye(c.distortion_coefficients, normalised)
                         : DistortBrown(c.distortion_coefficients, normalised);
  const Eigen::Matrix<long double, 3, 3> k = c.camera_matrix.cast<long double>();
  return Vector2L(k(0, 0) * d.x() + k(0, 1) * d.y() + k(0, 2), k(1, 1) * d.y() + k(1, 2));
}

}  // namespace elbowroom::oracles
