#include "recon/calibration/planar_pose.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "recon/calibration/rotation.h"

namespace elbowroom::recon {
namespace {

using core::RigidTransform;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kFarOffPx = 1000.0;  // what a point behind a camera counts as

double PoseWeight(double squared, double c) { return c > 0.0 ? 1.0 / (1.0 + squared / (c * c)) : 1.0; }

// The sum of losses of squared residuals: half of each, or Cauchy's c^2 / 2 * log(1 + squared / c^2). The
// logarithm is taken of products: one takes the time of ten multiplications.
class LossSum {
 public:
  explicit LossSum(double cauchy_scale) : c2_(cauchy_scale * cauchy_scale) {}

  void Add(double squared) {
    if (c2_ <= 0.0) {
      sum_ += squared;
      return;
    }
    product_ *= 1.0 + squared / c2_;
    if (product_ < kLarge) return;
    sum_ += c2_ * std::log(product_);
    product_ = 1.0;
  }
  [[nodiscard]] double Half() const { return 0.5 * (c2_ > 0.0 ? sum_ + c2_ * std::log(product_) : sum_); }

 private:
  static constexpr double kLarge = 1e150;  // times one more factor it is still a number

  double c2_;
  double product_ = 1.0;
  double sum_ = 0.0;
};

double PoseCost(std::span<const PosedView> views, const RigidTransform& rig_from_board, double cauchy_scale) {
  LossSum loss(cauchy_scale);
  for (const PosedView& view : views) {
    const RigidTransform cam_from_board = view.cam_from_rig * rig_from_board;
    for (const PosePoint& point : view.points) {
      const auto pixel = ProjectPoint(*view.lens, cam_from_board * point.x_in_board);
      const double px2 = pixel ? (*pixel - point.pixel).squaredNorm() : kFarOffPx * kFarOffPx;
      loss.Add(px2 * point.inverse_sigma * point.inverse_sigma);
    }
  }
  return loss.Half();
}

struct PoseEquations {
  Matrix6d matrix = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
};

// By a turn of the board about the camera's centre and a translation, both in the camera's frame.
PoseEquations EquationsInCamera(const PosedView& view, const RigidTransform& cam_from_board,
                                double cauchy_scale) {
  PoseEquations e;
  for (const PosePoint& point : view.points) {
    const Vector3d x = cam_from_board * point.x_in_board;
    const auto projected = ProjectWithPointDerivative(*view.lens, x);
    if (!projected) continue;
    const Vector2d residual = projected->pixel - point.pixel;
    const double inverse2 = point.inverse_sigma * point.inverse_sigma;
    const double weight = inverse2 * PoseWeight(residual.squaredNorm() * inverse2, cauchy_scale);
    for (Eigen::Index i = 0; i < 2; ++i) {
      const Vector3d by_x = projected->by_x_in_cam.row(i).transpose();
      Vector6d by_pose;  // a turn w moves x by w x x
      by_pose << x.cross(by_x), by_x;
      const Vector6d weighted = weight * by_pose;
      for (Eigen::Index column = 0; column < 6; ++column) e.matrix.col(column) += by_pose[column] * weighted;
      e.gradient -= residual[i] * weighted;
    }
  }
  return e;
}

// By a turn of the board from the right and its translation in the rig.
PoseEquations EquationsOfPose(std::span<const PosedView> views, const RigidTransform& rig_from_board,
                              double cauchy_scale) {
  PoseEquations e;
  for (const PosedView& view : views) {
    const RigidTransform cam_from_board = view.cam_from_rig * rig_from_board;
    const PoseEquations in_camera = EquationsInCamera(view, cam_from_board, cauchy_scale);
    // A turn from the right is about the board's origin.
    Matrix6d by_board = Matrix6d::Zero();
    by_board.topLeftCorner<3, 3>() = cam_from_board.rotation;
    by_board.bottomLeftCorner<3, 3>() = Hat(cam_from_board.translation_mm) * cam_from_board.rotation;
    by_board.bottomRightCorner<3, 3>() = view.cam_from_rig.rotation;
    e.matrix += by_board.transpose() * in_camera.matrix * by_board;
    e.gradient += by_board.transpose() * in_camera.gradient;
  }
  return e;
}

// Moves and scales points to mean 0 and mean distance sqrt(2), so that the equations below are well
// conditioned (Hartley, "In defense of the eight-point algorithm", 1997).
Eigen::Matrix3d Normalisation(std::span<const Vector2d> points) {
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d& point : points) mean += point / static_cast<double>(points.size());
  double distance = 0.0;
  for (const Vector2d& point : points) distance += (point - mean).norm() / static_cast<double>(points.size());
  const double scale = std::numbers::sqrt2 / std::max(distance, 1e-12);
  Eigen::Matrix3d normalisation;
  normalisation << scale, 0.0, -scale * mean.x(), 0.0, scale, -scale * mean.y(), 0.0, 0.0, 1.0;
  return normalisation;
}

// The homography from the board's plane to the normalised image plane, by its linear equations.
std::optional<Eigen::Matrix3d> HomographyOf(std::span<const Vector2d> in_board,
                                            std::span<const Vector2d> normalised) {
  const Eigen::Matrix3d from = Normalisation(in_board), to = Normalisation(normalised);
  Eigen::Matrix<double, 9, 9> sum = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t i = 0; i < in_board.size(); ++i) {
    const Vector3d x = from * in_board[i].homogeneous();
    const Vector2d u = (to * normalised[i].homogeneous()).head<2>();
    Eigen::Matrix<double, 2, 9> rows = Eigen::Matrix<double, 2, 9>::Zero();
    rows.block<1, 3>(0, 0) = x.transpose();
    rows.block<1, 3>(0, 6) = -u.x() * x.transpose();
    rows.block<1, 3>(1, 3) = x.transpose();
    rows.block<1, 3>(1, 6) = -u.y() * x.transpose();
    sum += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(sum);
  // Two small eigenvalues: the points are on one line.
  constexpr double kOnALine = 1e-9;
  if (!(solver.eigenvalues()[1] > kOnALine * solver.eigenvalues()[8])) return std::nullopt;
  const Eigen::Matrix3d h =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(solver.eigenvectors().col(0).data());
  return Eigen::Matrix3d(to.inverse() * h * from);
}

// The pose nearest to a homography (Zhang, "A flexible new technique for camera calibration", 2000).
std::optional<RigidTransform> PoseFromHomography(std::span<const PosePoint> points,
                                                 std::span<const Vector2d> normalised) {
  std::vector<Vector2d> in_board;
  Vector2d mean = Vector2d::Zero();
  for (const PosePoint& point : points) {
    in_board.push_back(point.x_in_board.head<2>());
    mean += in_board.back() / static_cast<double>(points.size());
  }
  const std::optional<Eigen::Matrix3d> h = HomographyOf(in_board, normalised);
  if (!h) return std::nullopt;
  const double length = 0.5 * (h->col(0).norm() + h->col(1).norm());
  if (!(length > 0.0)) return std::nullopt;
  const double sign = (*h * mean.homogeneous()).z() > 0.0 ? 1.0 : -1.0;  // the points are before the camera
  const Eigen::Matrix3d scaled = *h * (sign / length);
  Eigen::Matrix3d axes;
  axes << scaled.col(0), scaled.col(1), scaled.col(0).cross(scaled.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const RigidTransform pose{svd.matrixU() * svd.matrixV().transpose(), scaled.col(2)};
  if (!pose.rotation.allFinite() || pose.rotation.determinant() < 0.0) return std::nullopt;
  return pose;
}

}  // namespace

PoseFit FitBoardPose(std::span<const PosedView> views, const RigidTransform& start, double cauchy_scale,
                     int most_steps) {
  PoseFit fit{start, PoseCost(views, start, cauchy_scale)};
  double damping = 1e-4;
  for (int step = 0; step < most_steps; ++step) {
    const PoseEquations e = EquationsOfPose(views, fit.rig_from_board, cauchy_scale);
    bool is_better = false;
    double gain = 0.0;
    for (int attempt = 0; attempt < 8 && !is_better; ++attempt) {
      Matrix6d matrix = e.matrix;
      matrix.diagonal() *= 1.0 + damping;
      const Vector6d change = matrix.ldlt().solve(e.gradient);
      if (!change.allFinite()) break;
      RigidTransform moved = fit.rig_from_board;
      moved.rotation *= RotationFromVector(change.head<3>());
      moved.translation_mm += change.tail<3>();
      const double cost = PoseCost(views, moved, cauchy_scale);
      is_better = cost < fit.cost;
      damping *= is_better ? 0.1 : 10.0;
      if (!is_better) continue;
      gain = fit.cost - cost;
      fit = {moved, cost};
    }
    constexpr double kSettled = 1e-7;
    if (!is_better || gain < kSettled * fit.cost) break;
  }
  return fit;
}

ViewError ErrorOf(const PosedView& view, const RigidTransform& rig_from_board) {
  const RigidTransform cam_from_board = view.cam_from_rig * rig_from_board;
  std::vector<double> lengths;
  double sum = 0.0;
  for (const PosePoint& point : view.points) {
    const auto pixel = ProjectPoint(*view.lens, cam_from_board * point.x_in_board);
    lengths.push_back(pixel ? (*pixel - point.pixel).norm() : kFarOffPx);
    sum += lengths.back() * lengths.back();
  }
  if (lengths.empty()) return {};
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return {std::sqrt(sum / static_cast<double>(lengths.size())), *middle};
}

std::vector<PlanarPose> PlanarPosesOf(const LensParameters& lens, std::span<const PosePoint> points,
                                      std::span<const Vector2d> normalised, int most_steps) {
  if (points.size() < 4) return {};
  constexpr double kCauchyScale = 10.0;
  PosedView view{&lens, {}, {points.begin(), points.end()}};
  Vector3d center = Vector3d::Zero();
  for (const PosePoint& point : points) center += point.x_in_board / static_cast<double>(points.size());
  std::vector<PlanarPose> poses;
  const std::optional<RigidTransform> start = PoseFromHomography(points, normalised);
  if (!start) return {};
  const PoseFit one = FitBoardPose({&view, 1}, *start, kCauchyScale, most_steps);
  const PoseFit other =
      FitBoardPose({&view, 1}, Flipped(one.rig_from_board, center), kCauchyScale, most_steps);
  for (const PoseFit& fit : {one, other}) {
    if (!ShowsPrintedSide(fit.rig_from_board, center)) continue;
    if (!poses.empty() && AreOnePose(poses.front().cam_from_board, fit.rig_from_board)) continue;
    poses.push_back({fit.rig_from_board, ErrorOf(view, fit.rig_from_board)});
  }
  std::ranges::stable_sort(poses, {}, [](const PlanarPose& pose) { return pose.error.rms_px; });
  return poses;
}

bool AreOnePose(const RigidTransform& a, const RigidTransform& b) {
  constexpr double kSameTurnRad = 1e-3;
  return VectorFromRotation(a.rotation.transpose() * b.rotation).norm() < kSameTurnRad;
}

bool ShowsPrintedSide(const RigidTransform& cam_from_board, const Vector3d& center_in_board) {
  const Vector3d center_in_cam = cam_from_board * center_in_board;
  return center_in_cam.z() > 0.0 && cam_from_board.rotation.col(2).dot(center_in_cam) < 0.0;
}

RigidTransform Flipped(const RigidTransform& cam_from_board, const Vector3d& center_in_board) {
  const Vector3d center_in_cam = cam_from_board * center_in_board;
  const Vector3d sight = center_in_cam.normalized(), normal = cam_from_board.rotation.col(2);
  const Vector3d mirrored = 2.0 * normal.dot(sight) * sight - normal;
  const Eigen::Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(normal, mirrored).toRotationMatrix();
  RigidTransform flipped{turn * cam_from_board.rotation, Vector3d::Zero()};
  flipped.translation_mm = center_in_cam - flipped.rotation * center_in_board;
  return flipped;
}

}  // namespace elbowroom::recon
