#include "recon/head_pose/cap_pose.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "recon/head_pose/cap_fit.h"

namespace elbowroom::recon {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kLeastAgreeingShare = 0.75;
constexpr int kLeastAgreeingCorners = 4;

std::optional<Matrix6d> CovarianceOf(const CapEvidence& evidence, double place_sigma_mm,
                                     double edge_sigma_px) {
  // Turns in units of 100 mm at the head's size, so that both halves are alike.
  Matrix6d scale = Matrix6d::Identity();
  scale.topLeftCorner<3, 3>() *= 0.01;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(Matrix6d(scale * evidence.information * scale));
  if (!(solver.eigenvalues()[0] > 1e-9)) return std::nullopt;
  const Matrix6d inverse = solver.eigenvectors() * solver.eigenvalues().cwiseInverse().asDiagonal() *
                           solver.eigenvectors().transpose();
  // Corners that fit worse than their sigmas say make the pose less certain, never more.
  const int freedom = std::max(1, 2 * evidence.corners - 6);
  const double spread = std::max(1.0, evidence.unexplained / freedom);
  const Matrix6d own = scale * inverse * scale;
  // What is common to corners moves the pose by (J^T W J)^-1 J^T W K.
  Matrix6d common = edge_sigma_px * edge_sigma_px * evidence.by_edges * evidence.by_edges.transpose();
  for (const auto& by_shift : evidence.by_marker)
    common += place_sigma_mm * place_sigma_mm * by_shift * by_shift.transpose();
  return Matrix6d(spread * own + own * common * own);
}

// Whether a second minimum explains the corners nearly as well.
bool IsAmbiguous(std::span<const PoseFit> minima, const CapEvidence& evidence, double least_lead) {
  if (minima.size() < 2) return false;
  const int freedom = std::max(1, 2 * evidence.corners - 6);
  const double spread = std::max(1.0, evidence.squared_sigmas / freedom);
  return minima[1].cost - minima[0].cost < least_lead * spread;
}

}  // namespace

double CapPose::sigma_mm() const { return std::sqrt(covariance.bottomRightCorner<3, 3>().trace()); }
double CapPose::sigma_rad() const { return std::sqrt(covariance.topLeftCorner<3, 3>().trace()); }

std::string_view ToString(NoCapPose why) {
  switch (why) {
    case NoCapPose::kNotSeen:
      return "no marker of the cap is seen";
    case NoCapPose::kAmbiguous:
      return "the markers that are seen fit two poses";
    case NoCapPose::kUncertain:
      return "too few markers are seen to be certain";
    case NoCapPose::kDisagreement:
      return "the markers don't fit the cap file";
  }
  return "";
}

CapCamera::CapCamera(const core::CameraModel& camera)
    : lens(LensParametersOf(camera.calibration())), cam_from_world(camera.cam_from_world()) {}

std::variant<CapPose, NoCapPose> FindCapPose(const Cap& cap, std::span<const CapCamera> cameras,
                                             std::span<const CapSighting> sightings,
                                             const CapPoseOptions& options) {
  core::Require(cameras.size() == sightings.size(), "each camera has a sighting");
  const CapProblem problem = ProblemOf(cap, cameras, sightings, options.least_sigma_px);
  if (problem.views.empty()) return NoCapPose::kNotSeen;
  const std::vector<PoseFit> minima = MinimaOf(problem, StartsOf(cap, cameras, sightings));
  if (minima.empty()) return NoCapPose::kUncertain;
  const core::RigidTransform& world_from_head = minima.front().rig_from_board;
  const CapEvidence evidence = EvidenceFor(cap, problem, world_from_head);
  if (evidence.corners < kLeastAgreeingCorners ||
      evidence.corners < kLeastAgreeingShare * evidence.corners_in_all)
    return NoCapPose::kDisagreement;
  if (IsAmbiguous(minima, evidence, options.least_lead)) return NoCapPose::kAmbiguous;
  const auto covariance = CovarianceOf(evidence, cap.place_sigma_mm, options.edge_sigma_px);
  if (!covariance) return NoCapPose::kUncertain;
  const CapPose pose{world_from_head,
                     *covariance,
                     std::sqrt(evidence.squared_px2 / evidence.corners),
                     static_cast<int>(problem.views.size()),
                     problem.markers,
                     evidence.corners};
  const bool is_certain =
      pose.sigma_mm() <= options.most_sigma_mm && pose.sigma_rad() <= options.most_sigma_rad;
  if (!is_certain) return NoCapPose::kUncertain;
  return pose;
}

}  // namespace elbowroom::recon
