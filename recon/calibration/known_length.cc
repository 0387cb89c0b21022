#include "recon/calibration/known_length.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <span>

#include "core/error.h"
#include "recon/calibration/point_response.h"
#include "recon/calibration/rotation.h"
#include "recon/calibration/triangulation.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// An end of the length, and how it moves with parameters and noise.
struct LengthEnd {
  Vector3d x_in_world;
  Eigen::Matrix3Xd by_parameters;
  Eigen::Matrix3d noise_mm2 = Eigen::Matrix3d::Zero();
};

const CalibratedCamera& EndCamera(const CalibrationResult& result, int camera) {
  core::Require(camera >= 0 && camera < static_cast<int>(result.cameras.size()),
                "a known length's camera is one of the rig's");
  return result.cameras[static_cast<std::size_t>(camera)];
}

LengthEnd EndAtCamera(const CalibrationResult& result, int number) {
  const CalibratedCamera& camera = EndCamera(result, number);
  const core::RigidTransform& cam_from_world = camera.calibration.cam_from_world;
  const Eigen::Matrix3d world_from_cam = cam_from_world.rotation.transpose();
  LengthEnd end;
  end.x_in_world = cam_from_world.Inverse().translation_mm;
  end.by_parameters = Eigen::Matrix3Xd::Zero(3, result.covariance.cols());
  end.by_parameters.middleCols<3>(camera.parameters.rotation()) =
      -world_from_cam * Hat(cam_from_world.translation_mm);
  end.by_parameters.middleCols<3>(camera.parameters.translation()) = -world_from_cam;
  return end;
}

[[noreturn]] void FailAtPoint(const KnownLength& known, const std::string& why) {
  throw core::Error(
      core::ErrorKind::kCamera,
      fmt::format("known length '{}': {}; give the pixels of each of its two points in two pictures or more "
                  "that see it from different sides",
                  known.name, why));
}

LengthEnd EndAtPoint(const CalibrationResult& result, const KnownLength& known,
                     std::span<const KnownLength::Sight> sights) {
  std::vector<LensParameters> lenses;
  std::set<int> cameras;
  for (const KnownLength::Sight& sight : sights) {
    lenses.push_back(LensParametersOf(EndCamera(result, sight.camera).calibration));
    cameras.insert(sight.camera);
  }
  if (cameras.size() < 2) FailAtPoint(known, "a point of it is seen in fewer than two pictures");
  std::vector<PointSight> rays;
  double variance_px2 = 0.0;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    rays.push_back(
        {&lenses[i], EndCamera(result, sights[i].camera).calibration.cam_from_world, sights[i].pixel});
    variance_px2 += sights[i].sigma_px * sights[i].sigma_px / static_cast<double>(sights.size());
  }
  const std::optional<Vector3d> x = Triangulate(rays);
  if (!x) FailAtPoint(known, "a point of it can't be found from its pixels");
  PointResponse response(static_cast<int>(result.covariance.cols()));
  for (std::size_t i = 0; i < sights.size(); ++i)
    response.Add(lenses[i], rays[i].cam_from_world, EndCamera(result, sights[i].camera).parameters, *x);
  if (!response.Solve()) FailAtPoint(known, "a point of it is seen from one direction alone");
  return {*x, response.by_parameters(), variance_px2 * response.by_noise()};
}

std::string MessageOf(const KnownLength& known, const LengthCheck& check) {
  const std::string measured =
      fmt::format("known length '{}': {:.2f} mm (sigma {:.2f} mm) measured, {:.2f} mm stated", known.name,
                  check.measured_mm, check.sigma_mm, known.length_mm);
  switch (check.verdict) {
    case LengthVerdict::kAgrees:
      return fmt::format("{}: they agree", measured);
    case LengthVerdict::kCannotTell:
      return fmt::format(
          "{}: too uncertain to tell a wrong scale of 2 %; take a longer length, or more pictures", measured);
    case LengthVerdict::kMismatch:
      break;
  }
  // A board that is larger than stated makes the world smaller than it is.
  const double larger = 100.0 * (known.length_mm / check.measured_mm - 1.0);
  return fmt::format(
      "{}: mismatch; if the stated length is right, the board's squares are {:.2f} % {} than given: measure "
      "them again",
      measured, std::abs(larger), larger > 0.0 ? "larger" : "smaller");
}

}  // namespace

LengthCheck CheckLength(const CalibrationResult& result, const KnownLength& known) {
  core::Require(known.length_mm > 0.0 && known.tolerance_mm >= 0.0, "a known length is positive");
  constexpr double kSigmas = 3.0, kScale = 0.02;
  const LengthEnd a =
      known.cameras ? EndAtCamera(result, known.cameras->first) : EndAtPoint(result, known, known.first);
  const LengthEnd b =
      known.cameras ? EndAtCamera(result, known.cameras->second) : EndAtPoint(result, known, known.second);
  const Vector3d between = a.x_in_world - b.x_in_world;
  LengthCheck check;
  check.measured_mm = between.norm();
  if (!(check.measured_mm > 0.0)) FailAtPoint(known, "its two ends are one point");
  const Vector3d along = between / check.measured_mm;
  const Eigen::RowVectorXd by_parameters = along.transpose() * (a.by_parameters - b.by_parameters);
  check.sigma_mm = std::sqrt((by_parameters * result.covariance * by_parameters.transpose())(0, 0) +
                             along.dot((a.noise_mm2 + b.noise_mm2) * along));
  const double margin_mm = known.tolerance_mm + kSigmas * check.sigma_mm;
  if (std::abs(check.measured_mm - known.length_mm) > margin_mm)
    check.verdict = LengthVerdict::kMismatch;
  else
    check.verdict =
        margin_mm <= kScale * known.length_mm ? LengthVerdict::kAgrees : LengthVerdict::kCannotTell;
  check.message = MessageOf(known, check);
  return check;
}

}  // namespace elbowroom::recon
