#include "recon/rig_files/foreign_rig.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;
using core::RigidTransform;
using Eigen::Matrix3d;

constexpr std::array<std::pair<ForeignFormat, std::string_view>, 6> kForeignFormats = {
    {{ForeignFormat::kOpenCv, "opencv"},
     {ForeignFormat::kRos, "ros"},
     {ForeignFormat::kKalibr, "kalibr"},
     {ForeignFormat::kAnipose, "anipose"},
     {ForeignFormat::kCaliscope, "caliscope"},
     {ForeignFormat::kProjection, "projection"}}};

// The nearest rotation; files round. Nothing: it is none at all.
std::optional<Matrix3d> NearestRotation(const Matrix3d& stated) {
  constexpr double kMostRounding = 5e-3;
  if (!stated.allFinite() || !core::IsRotation(stated, kMostRounding)) return std::nullopt;
  const Eigen::JacobiSVD<Matrix3d> svd(stated, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

RigidTransform Stated(const ForeignCamera& camera, const StatedPose& stated, double unit_mm) {
  const std::optional<Matrix3d> rotation = NearestRotation(stated.rotation);
  if (!rotation) {
    throw Error(ErrorKind::kCamera, fmt::format("camera '{}': its rotation isn't one (rows of length 1, at "
                                                "right angles, determinant +1); correct the file",
                                                camera.name));
  }
  return {*rotation, unit_mm * stated.translation};
}

// A projection matrix for pixels whose rows are counted from above.
Eigen::Matrix<double, 3, 4> WithRowsFromAbove(const Eigen::Matrix<double, 3, 4>& projection, int height_px) {
  Eigen::Matrix<double, 3, 4> turned = projection;
  turned.row(1) = (height_px - 1) * projection.row(2) - projection.row(1);
  return turned;
}

core::CameraCalibration OfProjection(const ForeignCamera& camera, const RigConvention& convention,
                                     double unit_mm) {
  const bool is_from_below = convention.axes == RigConvention::Axes::kOpenGl;
  const auto split =
      SplitOf(is_from_below ? WithRowsFromAbove(*camera.projection, camera.lens.image_height_px)
                            : *camera.projection);
  if (!split) {
    throw Error(ErrorKind::kCamera, fmt::format("camera '{}': its 3 x 4 matrix is no projection (its left "
                                                "3 x 3 part is singular); correct the file",
                                                camera.name));
  }
  core::CameraCalibration calibration = camera.known.value_or(camera.lens);
  if (!camera.known) calibration.camera_matrix = split->camera_matrix;
  calibration.cam_from_world = Stated(camera, split->cam_from_world, unit_mm);
  return calibration;
}

}  // namespace

std::optional<ForeignFormat> ParseForeignFormat(std::string_view text) {
  const auto found =
      std::ranges::find(kForeignFormats, text, &std::pair<ForeignFormat, std::string_view>::second);
  return found == kForeignFormats.end() ? std::nullopt : std::optional(found->first);
}

std::string_view ToString(ForeignFormat format) {
  return std::ranges::find(kForeignFormats, format, &std::pair<ForeignFormat, std::string_view>::first)
      ->second;
}

std::string ToString(const RigConvention& convention) {
  return fmt::format(
      "{}, {} axes",
      convention.pose == RigConvention::Pose::kCamFromWorld ? "cam_from_world" : "world_from_cam",
      convention.axes == RigConvention::Axes::kOpenCv ? "OpenCV" : "OpenGL");
}

RigConvention DocumentedConvention(ForeignFormat format) {
  switch (format) {
    case ForeignFormat::kOpenCv:      // calib3d: x_cam = R x_world + t
    case ForeignFormat::kRos:         // REP 104
    case ForeignFormat::kKalibr:      // T_cn_cnm1 takes cam n-1 to cam n
    case ForeignFormat::kAnipose:     // rvec and tvec of OpenCV
    case ForeignFormat::kCaliscope:   // the same
    case ForeignFormat::kProjection:  // by what such a matrix is
      return {};
  }
  return {};
}

std::optional<core::LengthUnit> DocumentedUnit(ForeignFormat format) {
  switch (format) {
    case ForeignFormat::kRos:
    case ForeignFormat::kKalibr:
    case ForeignFormat::kCaliscope:
      return core::LengthUnit::kMetre;
    case ForeignFormat::kOpenCv:
    case ForeignFormat::kAnipose:  // the unit of its board's squares
    case ForeignFormat::kProjection:
      return std::nullopt;
  }
  return std::nullopt;
}

std::vector<RigConvention> PossibleConventions(ForeignFormat format) {
  using enum RigConvention::Pose;
  using enum RigConvention::Axes;
  switch (format) {
    case ForeignFormat::kRos:  // its poses come from a projection matrix and a rectification
      return {{kCamFromWorld, kOpenCv}};
    case ForeignFormat::kProjection:
      return {{kCamFromWorld, kOpenCv}, {kCamFromWorld, kOpenGl}};
    case ForeignFormat::kOpenCv:
    case ForeignFormat::kKalibr:
    case ForeignFormat::kAnipose:
    case ForeignFormat::kCaliscope:
      return {{kCamFromWorld, kOpenCv},
              {kWorldFromCam, kOpenCv},
              {kCamFromWorld, kOpenGl},
              {kWorldFromCam, kOpenGl}};
  }
  return {};
}

std::vector<core::CameraCalibration> CalibrationsOf(const ForeignRig& rig, const RigConvention& convention,
                                                    double unit_mm) {
  const RigidTransform opencv_from_opengl{Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal().toDenseMatrix(),
                                          Eigen::Vector3d::Zero()};
  std::vector<core::CameraCalibration> calibrations;
  RigidTransform before_from_world;  // of a chain: the camera before, in the file's axes
  for (const ForeignCamera& camera : rig.cameras) {
    core::Require(camera.lens.image_width_px > 0 && camera.lens.image_height_px > 0,
                  "every camera's size is known");
    core::Require(camera.stated.has_value() || camera.projection.has_value(), "every camera has a pose");
    if (camera.projection) {
      calibrations.push_back(OfProjection(camera, convention, unit_mm));
    } else {
      RigidTransform cam_from_world = Stated(camera, *camera.stated, unit_mm);
      if (convention.pose == RigConvention::Pose::kWorldFromCam) cam_from_world = cam_from_world.Inverse();
      if (rig.is_chain) cam_from_world = before_from_world = cam_from_world * before_from_world;
      if (convention.axes == RigConvention::Axes::kOpenGl)
        cam_from_world = opencv_from_opengl * cam_from_world;
      calibrations.push_back(camera.lens);
      calibrations.back().cam_from_world = cam_from_world;
    }
    calibrations.back().name = camera.name;
  }
  return calibrations;
}

std::optional<SplitProjection> SplitOf(const Eigen::Matrix<double, 3, 4>& projection) {
  constexpr double kLeastCondition = 1e-12;
  Matrix3d left = projection.leftCols<3>();
  if (!projection.allFinite()) return std::nullopt;
  const double determinant = left.determinant();
  if (!(std::abs(determinant) > kLeastCondition * std::pow(left.norm(), 3.0))) return std::nullopt;
  const double sign = determinant < 0.0 ? -1.0 : 1.0;
  left *= sign;
  // With J the exchange of rows 0 and 2: (J left)^T = Q U, so left = (J U^T J) (J Q^T), upper triangular and
  // orthogonal.
  const Eigen::HouseholderQR<Matrix3d> qr(left.colwise().reverse().transpose());
  const Matrix3d q = qr.householderQ();
  const Matrix3d u = qr.matrixQR().triangularView<Eigen::Upper>();
  Matrix3d camera_matrix = u.transpose().colwise().reverse().rowwise().reverse();
  Matrix3d rotation = q.transpose().colwise().reverse();
  for (int i = 0; i < 3; ++i) {
    if (camera_matrix(i, i) > 0.0) continue;
    camera_matrix.col(i) *= -1.0;
    rotation.row(i) *= -1.0;
  }
  SplitProjection split;
  split.cam_from_world = {rotation, camera_matrix.inverse() * (sign * projection.col(3))};
  split.camera_matrix = camera_matrix / camera_matrix(2, 2);
  split.camera_matrix(1, 0) = split.camera_matrix(2, 0) = split.camera_matrix(2, 1) = 0.0;
  return split;
}

bool IsSameCamera(std::string_view a, std::string_view b) {
  const auto simple = [](std::string_view name) {
    std::string text;
    for (std::size_t i = 0; i < name.size(); ++i) {
      const auto c = static_cast<unsigned char>(name[i]);
      const bool follows_digit = !text.empty() && std::isdigit(static_cast<unsigned char>(text.back())) != 0;
      const bool is_leading_zero = c == '0' && !follows_digit && i + 1 < name.size() &&
                                   std::isdigit(static_cast<unsigned char>(name[i + 1])) != 0;
      if (std::isalnum(c) != 0 && !is_leading_zero) text += static_cast<char>(std::tolower(c));
    }
    return text;
  };
  return a == b || (!simple(a).empty() && simple(a) == simple(b));
}

ForeignRig Joined(std::vector<ForeignRig> rigs) {
  ForeignRig joined;
  const auto fail = [](const std::string& what) { throw Error(ErrorKind::kFormat, what); };
  if (rigs.empty()) fail("no file was given");
  joined.format = rigs.front().format;
  joined.is_chain = rigs.front().is_chain;
  if (joined.is_chain && rigs.size() > 1) fail("a chain of cameras is one file; give it alone");
  for (ForeignRig& rig : rigs) {
    if (rig.format != joined.format)
      fail(fmt::format("the files are of several formats ({} and {}); give files of one",
                       ToString(joined.format), ToString(rig.format)));
    for (ForeignCamera& camera : rig.cameras) joined.cameras.push_back(std::move(camera));
    if (rig.second_from_first) joined.second_from_first = rig.second_from_first;
    joined.warnings.insert(joined.warnings.end(), rig.warnings.begin(), rig.warnings.end());
  }
  if (joined.second_from_first) {
    if (joined.cameras.size() != 2)
      fail(
          fmt::format("R and T lie between two cameras, but the files have {}; add the file with both lenses",
                      joined.cameras.size()));
    joined.cameras[0].stated = StatedPose{};
    joined.cameras[1].stated = joined.second_from_first;
  }
  return joined;
}

}  // namespace elbowroom::recon
