// The bundle adjustment's equations against slow and obvious ones.
#include "recon/calibration/bundle.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/error.h"
#include "recon/calibration/rotation.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

core::RigidTransform RandomBoardPose(Random* random) {
  return {RotationFromVector(Eigen::Vector3d(std::numbers::pi, 0.0, 0.0)) *
              RotationFromVector(0.3 * random->Direction()),
          Eigen::Vector3d(random->Uniform(-100.0, 100.0), random->Uniform(-100.0, 100.0),
                          random->Uniform(900.0, 1200.0))};
}

// Two cameras with different lenses, five boards of which three follow each other, and points off by a
// little.
Adjustment SmallAdjustment(const BoardSurface& surface, Random* random) {
  Adjustment a;
  a.surface = &surface;
  a.flatness_mm = {0.3, -0.2, 0.5};
  a.is_flatness_fixed = false;
  for (int i = 0; i < 2; ++i) {
    AdjustedCamera camera;
    camera.lens.model = i == 0 ? core::DistortionModel::kRationalPolynomial : core::DistortionModel::kFisheye;
    camera.lens.values = VectorXd::Zero(i == 0 ? 12 : 8);
    for (Eigen::Index j = 4; j < camera.lens.values.size(); ++j)
      camera.lens.values[j] = random->Uniform(-0.02, 0.02);
    camera.lens.values.head<4>() << 600.0, 602.0, 320.0, 240.0;
    camera.cam_from_rig = {RotationFromVector(0.2 * i * random->Direction()),
                           Eigen::Vector3d(-80.0 * i, 10.0 * i, 5.0)};
    camera.time_offset_s = 0.01 * i;
    camera.is_offset_fixed = i == 0;
    a.cameras.push_back(camera);
  }
  core::RigidTransform pose = RandomBoardPose(random);
  for (int k = 0; k < 5; ++k) {
    pose.rotation *= RotationFromVector(0.1 * random->Direction());
    pose.translation_mm += 20.0 * random->Direction();
    a.boards.push_back({pose, 0.04 * k, k == 0});
  }
  const std::array<std::array<int, 3>, 5> boards = {{{0, 1, 2}, {1, 0, 2}, {2, 1, 3}, {3, 2, 4}, {4, 3, 2}}};
  for (const auto& of_view : boards) {
    for (int camera = 0; camera < 2; ++camera) {
      AdjustedView view;
      view.camera = camera;
      view.boards = of_view;
      view.board_count = camera == 0 ? 1 : 3;
      view.time_s = a.boards[static_cast<std::size_t>(of_view[0])].time_s + 0.003 * camera;
      for (int i = 0; i < surface.points(); i += 2)
        view.points.push_back({i, Eigen::Vector2d::Zero(), 2.0, i != 4});
      const core::RigidTransform cam_from_board = CamFromBoardAt(a, view);
      for (AdjustedPoint& point : view.points)
        point.pixel = ProjectPoint(a.cameras[static_cast<std::size_t>(camera)].lens,
                                   cam_from_board * surface.Bent(point.point, a.flatness_mm))
                          .value() +
                      Eigen::Vector2d(random->Uniform(-0.5, 0.5), random->Uniform(-0.5, 0.5));
      a.views.push_back(view);
    }
  }
  return a;
}

// All weighted residuals in one column, to be differentiated.
VectorXd AllResiduals(const Adjustment& a) {
  std::vector<double> values;
  for (const AdjustedView& view : a.views) {
    const core::RigidTransform cam_from_board = CamFromBoardAt(a, view);
    for (const AdjustedPoint& point : view.points) {
      if (!point.is_used) continue;
      const Eigen::Vector2d residual =
          point.inverse_sigma * ResidualOf(a, view, cam_from_board, point).value();
      values.push_back(residual.x());
      values.push_back(residual.y());
    }
  }
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

bool IsIntrinsic(const Adjustment& a, int parameter) {
  for (int i = 0; i < static_cast<int>(a.cameras.size()); ++i) {
    const ParameterBlock block = a.BlockOf(i);
    if (parameter >= block.first && parameter < block.first + block.intrinsics) return true;
  }
  return false;
}

// By central differences, step by step of every parameter.
MatrixXd NumericJacobian(const Adjustment& a) {
  const int count = a.camera_parameters() + 6 * static_cast<int>(a.boards.size());
  MatrixXd jacobian(AllResiduals(a).size(), count);
  for (int j = 0; j < count; ++j) {
    const double size = IsIntrinsic(a, j) ? 1e-4 : 1e-6;  // pixels are nearly linear in a lens's values
    VectorXd step = VectorXd::Zero(count);
    step[j] = size;
    jacobian.col(j) = (AllResiduals(Moved(a, step)) - AllResiduals(Moved(a, -step))) / (2.0 * size);
  }
  return jacobian;
}

// What NormalEquations hold, in one matrix.
MatrixXd DenseMatrix(const NormalEquations& e) {
  const Eigen::Index cameras = e.camera_gradient.size(), boards = static_cast<Eigen::Index>(e.band.size());
  MatrixXd dense = MatrixXd::Zero(cameras + 6 * boards, cameras + 6 * boards);
  dense.topLeftCorner(cameras, cameras) = e.cameras.selfadjointView<Eigen::Lower>();
  for (Eigen::Index k = 0; k < boards; ++k) {
    const auto at = static_cast<std::size_t>(k);
    dense.block(cameras + 6 * k, 0, 6, cameras) = e.mixed[at];
    dense.block(0, cameras + 6 * k, cameras, 6) = e.mixed[at].transpose();
    for (Eigen::Index d = 0; d <= 2 && k + d < boards; ++d) {
      const auto& block = e.band[at][static_cast<std::size_t>(d)];
      dense.block(cameras + 6 * (k + d), cameras + 6 * k, 6, 6) = block;
      dense.block(cameras + 6 * k, cameras + 6 * (k + d), 6, 6) = block.transpose();
    }
  }
  return dense;
}

VectorXd DenseGradient(const NormalEquations& e) {
  const Eigen::Index cameras = e.camera_gradient.size();
  VectorXd gradient(cameras + 6 * static_cast<Eigen::Index>(e.band.size()));
  gradient.head(cameras) = e.camera_gradient;
  for (std::size_t k = 0; k < e.band.size(); ++k)
    gradient.segment<6>(cameras + 6 * static_cast<Eigen::Index>(k)) = e.board_gradient[k];
  return gradient;
}

const Board kBundleBoard{BoardKind::kCharuco, 6, 5, 40.0, 25.0, "DICT_5X5_100"};

TEST(Bundle, EquationsAreThoseOfNumericDerivatives) {
  // Of the largest entry of the row and column: central differences of residuals of some hundred px.
  constexpr double kTolerance = 1e-6;
  const BoardSurface surface(kBundleBoard);
  Random random(3);
  const Adjustment a = SmallAdjustment(surface, &random);
  const NormalEquations equations = EquationsOf(a, {});
  const MatrixXd matrix = DenseMatrix(equations);
  MatrixXd jacobian = NumericJacobian(a);
  const int board_0 = a.camera_parameters(), offset_0 = a.BlockOf(0).time_offset();
  jacobian.middleCols(board_0, 6).setZero();
  jacobian.col(offset_0).setZero();
  MatrixXd expected = jacobian.transpose() * jacobian;
  for (int i = 0; i < 6; ++i) expected(board_0 + i, board_0 + i) = 1.0;
  expected(offset_0, offset_0) = 1.0;
  VectorXd gradient = -jacobian.transpose() * AllResiduals(a);
  const VectorXd found = DenseGradient(equations);
  // The weak knowledge: distortion 0 +- 1, flatness 0 +- 5 mm.
  for (int i = 0; i < 2; ++i) {
    const ParameterBlock block = a.BlockOf(i);
    for (int j = 4; j < block.intrinsics; ++j) {
      expected(block.first + j, block.first + j) += 1.0;
      gradient[block.first + j] -= a.cameras[static_cast<std::size_t>(i)].lens.values[j];
    }
  }
  for (int j = 0; j < kFlatnessTerms; ++j) {
    expected(board_0 - kFlatnessTerms + j, board_0 - kFlatnessTerms + j) += 0.04;
    gradient[board_0 - kFlatnessTerms + j] -= 0.04 * a.flatness_mm[j];
  }
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    EXPECT_NEAR(found[i], gradient[i], 1e-5 * std::sqrt(expected(i, i)) * 10.0) << i;
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      EXPECT_NEAR(matrix(i, j), expected(i, j), kTolerance * std::sqrt(expected(i, i) * expected(j, j)))
          << i << ' ' << j;
  }
}

TEST(Bundle, EliminationSolvesWhatADenseSolverSolves) {
  const BoardSurface surface(kBundleBoard);
  Random random(4);
  const Adjustment a = SmallAdjustment(surface, &random);
  const NormalEquations equations = EquationsOf(a, {});
  const MatrixXd matrix = DenseMatrix(equations);
  const VectorXd expected = matrix.fullPivLu().solve(DenseGradient(equations));
  const VectorXd found = SolveNormalEquations(equations, 0.0).value();
  // Both lose as many digits as the matrix is ill-conditioned; a residual is compared, not the solution.
  EXPECT_LE((matrix * (found - expected)).norm(), 1e-7 * DenseGradient(equations).norm());
  const MatrixXd inverse =
      matrix.fullPivLu().inverse().topLeftCorner(a.camera_parameters(), a.camera_parameters());
  const MatrixXd reduced = InverseOfCameras(equations).value();
  for (Eigen::Index i = 0; i < inverse.rows(); ++i)
    for (Eigen::Index j = 0; j < inverse.cols(); ++j)
      EXPECT_NEAR(reduced(i, j), inverse(i, j), 1e-4 * std::sqrt(inverse(i, i) * inverse(j, j)))
          << i << ' ' << j;
}

TEST(Bundle, ReachesAMinimum) {
  const BoardSurface surface(kBundleBoard);
  Random random(5);
  const Adjustment start = SmallAdjustment(surface, &random);
  BundleOptions options;
  options.settled = 0.0;
  options.most_steps = 1000;  // a lens of twelve values by ten views of thirty points is nearly undetermined
  const Adjustment end = AdjustBundle(start, options, {});
  EXPECT_LT(CostOf(end, options), CostOf(start, options));
  const NormalEquations equations = EquationsOf(end, options);
  const VectorXd gradient = DenseGradient(equations), diagonal = DenseMatrix(equations).diagonal();
  for (Eigen::Index i = 0; i < gradient.size(); ++i)
    EXPECT_LE(std::abs(gradient[i]), 1e-3 * std::sqrt(diagonal[i])) << i;
}

TEST(Bundle, StopsWhenAsked) {
  const BoardSurface surface(kBundleBoard);
  Random random(6);
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW((void)AdjustBundle(SmallAdjustment(surface, &random), {}, source.get_token()), core::Error);
}

TEST(Rotation, VectorsAndTheirDerivativesFit) {
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d w = random.LogUniform(1e-6, 3.0) * random.Direction();
    EXPECT_LE((VectorFromRotation(RotationFromVector(w)) - w).norm(), 1e-9);
    EXPECT_LE((RightJacobian(w) * InverseRightJacobian(w) - Eigen::Matrix3d::Identity()).norm(), 1e-7);
    const Eigen::Vector3d d = 1e-6 * random.Direction();
    const Eigen::Matrix3d expected = RotationFromVector(w) * RotationFromVector(RightJacobian(w) * d);
    EXPECT_LE((RotationFromVector(w + d) - expected).norm(), 1e-10);
  }
}

}  // namespace
}  // namespace elbowroom::recon
