#include "recon/calibration/bundle.h"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/progress.h"
#include "recon/calibration/rotation.h"

namespace elbowroom::recon {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// What is known of lenses and boards before any picture: distortion coefficients are of the order of 1, and a
// board is flat to this many mm. It only matters for what the pictures don't tell, as the three last
// coefficients of a rational lens.
constexpr double kDistortionSigma = 1.0;
constexpr double kFlatnessSigmaMm = 5.0;
// A point that the model puts behind a camera counts as this many px off and pulls nowhere.
constexpr double kBehindPx = 1000.0;

double LossOf(double squared, const BundleOptions& options) {
  if (options.cauchy_scale <= 0.0) return 0.5 * squared;
  const double c2 = std::pow(options.cauchy_scale * options.noise_scale, 2);
  return 0.5 * c2 * std::log1p(squared / c2);
}

double WeightOf(double squared, const BundleOptions& options) {
  if (options.cauchy_scale <= 0.0) return 1.0;
  return 1.0 / (1.0 + squared / std::pow(options.cauchy_scale * options.noise_scale, 2));
}

double CostOfView(const Adjustment& a, const AdjustedView& view, const BundleOptions& options) {
  const core::RigidTransform cam_from_board = CamFromBoardAt(a, view);
  double cost = 0.0;
  for (const AdjustedPoint& point : view.points) {
    if (!point.is_used) continue;
    const auto residual = ResidualOf(a, view, cam_from_board, point);
    const double px2 = residual ? residual->squaredNorm() : kBehindPx * kBehindPx;
    cost += LossOf(px2 * point.inverse_sigma * point.inverse_sigma, options);
  }
  return cost;
}

double PriorWeight(double sigma, const BundleOptions& options) {
  constexpr double kLeastNoise =
      1e-3;  // points without noise would make it nothing, and the equations singular
  return std::pow(std::max(options.noise_scale, kLeastNoise) / sigma, 2);
}

// One view's equations: its camera's block, the flatness, and its boards, in this order.
struct ViewEquations {
  MatrixXd matrix;  // lower triangle
  VectorXd gradient;
};

// The derivatives of the view's residuals by what is near to them: intrinsics, (turn, translation) of the
// board in the camera's frame, flatness. Rows are weighted; the last column is minus the residual.
MatrixXd WeightedRows(const Adjustment& a, const AdjustedView& view,
                      const core::RigidTransform& cam_from_board, const BundleOptions& options) {
  const AdjustedCamera& camera = a.cameras[static_cast<std::size_t>(view.camera)];
  const int intrinsics = camera.lens.count(), columns = intrinsics + 6 + kFlatnessTerms;
  MatrixXd rows(2 * static_cast<Eigen::Index>(view.points.size()), columns + 1);
  Eigen::Index at = 0;
  for (const AdjustedPoint& point : view.points) {
    if (!point.is_used) continue;
    const Eigen::Vector3d x = cam_from_board * a.surface->Bent(point.point, a.flatness_mm);
    const auto projected = ProjectWithDerivatives(camera.lens, x);
    if (!projected) continue;
    const Vector2d residual = projected->pixel - point.pixel;
    const double weight =
        point.inverse_sigma *
        std::sqrt(WeightOf(residual.squaredNorm() * std::pow(point.inverse_sigma, 2), options));
    auto two = rows.middleRows<2>(at);
    two.leftCols(intrinsics) = weight * projected->by_values;
    const Eigen::Matrix<double, 2, 3> by_x = weight * projected->by_x_in_cam;
    two.middleCols<3>(intrinsics) = -by_x * Hat(x);
    two.middleCols<3>(intrinsics + 3) = by_x;
    two.middleCols<kFlatnessTerms>(intrinsics + 6) =
        (by_x * cam_from_board.rotation.col(2)) * a.surface->Bending(point.point).transpose();
    two.col(columns) = -weight * residual;
    at += 2;
  }
  rows.conservativeResize(at, Eigen::NoChange);
  return rows;
}

ViewEquations EquationsOfView(const Adjustment& a, const AdjustedView& view, const BundleOptions& options) {
  const int intrinsics = a.cameras[static_cast<std::size_t>(view.camera)].lens.count();
  const int near = intrinsics + 6 + kFlatnessTerms,
            all = intrinsics + 7 + kFlatnessTerms + 6 * view.board_count;
  const MovedBoard moved = DifferentiateMotion(a, view);
  const MatrixXd rows = WeightedRows(a, view, moved.cam_from_board, options);
  MatrixXd inner = MatrixXd::Zero(near + 1, near + 1);
  inner.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  const MatrixXd full = inner.selfadjointView<Eigen::Lower>();
  // From what is near to all parameters of the view, by the chain rule.
  MatrixXd chain = MatrixXd::Zero(near, all);
  chain.topLeftCorner(intrinsics, intrinsics).setIdentity();
  chain.block<6, 6>(intrinsics, intrinsics) = moved.by_camera;
  chain.block<6, 1>(intrinsics, intrinsics + 6) = moved.by_time_s;
  chain.block<kFlatnessTerms, kFlatnessTerms>(intrinsics + 6, intrinsics + 7).setIdentity();
  for (int i = 0; i < view.board_count; ++i)
    chain.block<6, 6>(intrinsics, intrinsics + 7 + kFlatnessTerms + 6 * i) =
        moved.by_board[static_cast<std::size_t>(i)];
  return {chain.transpose() * (full.topLeftCorner(near, near) * chain),
          chain.transpose() * full.col(near).head(near)};
}

// Adds a view's equations at their places.
void AddView(const Adjustment& a, const AdjustedView& view, const ViewEquations& add, NormalEquations* sum) {
  const ParameterBlock block = a.BlockOf(view.camera);
  const int size = block.size(), flatness = a.camera_parameters() - kFlatnessTerms,
            cameras = size + kFlatnessTerms;
  const auto& m = add.matrix;
  sum->cameras.block(block.first, block.first, size, size) += m.topLeftCorner(size, size);
  sum->cameras.block(flatness, block.first, kFlatnessTerms, size) += m.block(size, 0, kFlatnessTerms, size);
  sum->cameras.bottomRightCorner<kFlatnessTerms, kFlatnessTerms>() +=
      m.block<kFlatnessTerms, kFlatnessTerms>(size, size);
  sum->camera_gradient.segment(block.first, size) += add.gradient.head(size);
  sum->camera_gradient.tail<kFlatnessTerms>() += add.gradient.segment<kFlatnessTerms>(size);
  for (int i = 0; i < view.board_count; ++i) {
    const auto k = static_cast<std::size_t>(view.boards[static_cast<std::size_t>(i)]);
    const int row = cameras + 6 * i;
    sum->mixed[k].middleCols(block.first, size) += m.block(row, 0, 6, size);
    sum->mixed[k].rightCols<kFlatnessTerms>() += m.block<6, kFlatnessTerms>(row, size);
    sum->board_gradient[k] += add.gradient.segment<6>(row);
  }
  sum->AddToBand(BoardsOf(view), m.bottomRightCorner(6 * view.board_count, 6 * view.board_count));
}

void AddPriors(const Adjustment& a, const BundleOptions& options, NormalEquations* e) {
  const double distortion = PriorWeight(kDistortionSigma, options),
               flatness = PriorWeight(kFlatnessSigmaMm, options);
  for (int i = 0; i < static_cast<int>(a.cameras.size()); ++i) {
    const ParameterBlock block = a.BlockOf(i);
    const VectorXd& values = a.cameras[static_cast<std::size_t>(i)].lens.values;
    for (int j = 4; j < block.intrinsics; ++j) {
      e->cameras(block.first + j, block.first + j) += distortion;
      e->camera_gradient[block.first + j] -= distortion * values[j];
    }
  }
  e->cameras.bottomRightCorner<kFlatnessTerms, kFlatnessTerms>().diagonal().array() += flatness;
  e->camera_gradient.tail<kFlatnessTerms>() -= flatness * a.flatness_mm;
}

// Takes parameters out that stay as they are: their step becomes 0.
void FixCameraParameters(const ParameterRange& range, NormalEquations* e) {
  const auto [first, count] = range;
  e->cameras.middleRows(first, count).setZero();
  e->cameras.middleCols(first, count).setZero();
  e->cameras.diagonal().segment(first, count).setOnes();
  e->camera_gradient.segment(first, count).setZero();
  for (auto& mixed : e->mixed) mixed.middleCols(first, count).setZero();
}

void FixBoard(std::size_t k, NormalEquations* e) {
  for (std::size_t d = 0; d <= 2; ++d) {
    e->band[k][d].setZero();
    if (d <= k) e->band[k - d][d].setZero();
  }
  e->band[k][0].setIdentity();
  e->mixed[k].setZero();
  e->board_gradient[k].setZero();
}

bool IsSeen(const NormalEquations& e, std::size_t k) { return e.band[k][0].diagonal().minCoeff() > 0.0; }

void FixWhatStays(const Adjustment& a, NormalEquations* e) {
  for (const ParameterRange& range : a.kept_parameters()) FixCameraParameters(range, e);
  for (std::size_t k = 0; k < a.boards.size(); ++k)
    if (a.boards[k].is_fixed || !IsSeen(*e, k)) FixBoard(k, e);
}

// A view's share of the gradient, 0 for what stays.
GradientPart PullOf(const Adjustment& a, const AdjustedView& view, const std::vector<ParameterRange>& kept) {
  const VectorXd gradient = EquationsOfView(a, view, {}).gradient;
  const ParameterBlock block = a.BlockOf(view.camera);
  GradientPart pull{VectorXd::Zero(a.camera_parameters()), {}};
  pull.cameras.segment(block.first, block.size()) = gradient.head(block.size());
  pull.cameras.tail<kFlatnessTerms>() = gradient.segment<kFlatnessTerms>(block.size());
  for (const auto& [first, count] : kept) pull.cameras.segment(first, count).setZero();
  for (int i = 0; i < view.board_count; ++i) {
    const int board = view.boards[static_cast<std::size_t>(i)];
    if (!a.boards[static_cast<std::size_t>(board)].is_fixed)
      pull.boards.emplace_back(board, gradient.segment<6>(block.size() + kFlatnessTerms + 6 * i));
  }
  return pull;
}

// A square picture's pixel is as wide as high to a few percent: lenses whose values say else, or whose focal
// length isn't positive, are no step to take.
bool IsPossible(const Adjustment& a) {
  return std::ranges::all_of(a.cameras, [](const AdjustedCamera& camera) {
    return camera.lens.values.allFinite() && camera.lens.values[0] > 1.0 && camera.lens.values[1] > 1.0;
  });
}

int FreeParameters(const Adjustment& a) {
  std::vector<bool> is_seen(a.boards.size(), false);
  for (const AdjustedView& view : a.views)
    if (view.is_used && std::ranges::any_of(view.points, &AdjustedPoint::is_used))
      for (int i = 0; i < view.board_count; ++i)
        is_seen[static_cast<std::size_t>(view.boards[static_cast<std::size_t>(i)])] = true;
  int count = a.is_flatness_fixed ? 0 : kFlatnessTerms;
  for (const AdjustedCamera& camera : a.cameras)
    count += (camera.is_lens_fixed ? 0 : camera.lens.count()) + (camera.is_pose_fixed ? 0 : 6) +
             (camera.is_offset_fixed ? 0 : 1);
  for (std::size_t k = 0; k < a.boards.size(); ++k)
    if (!a.boards[k].is_fixed && is_seen[k]) count += 6;
  return count;
}

// Squared residuals over the sightings' variances of all used points.
std::vector<double> SquaredResiduals(const Adjustment& a) {
  std::vector<double> squared;
  for (const AdjustedView& view : a.views) {
    if (!view.is_used) continue;
    const core::RigidTransform cam_from_board = CamFromBoardAt(a, view);
    for (const AdjustedPoint& point : view.points) {
      if (!point.is_used) continue;
      const auto residual = ResidualOf(a, view, cam_from_board, point);
      squared.push_back((residual ? residual->squaredNorm() : kBehindPx * kBehindPx) * point.inverse_sigma *
                        point.inverse_sigma);
    }
  }
  return squared;
}

}  // namespace

double CostOf(const Adjustment& a, const BundleOptions& options) {
  std::vector<double> costs(a.views.size(), 0.0);
  tbb::parallel_for(std::size_t{0}, a.views.size(), [&](std::size_t i) {
    if (a.views[i].is_used) costs[i] = CostOfView(a, a.views[i], options);
  });
  double sum = 0.0;
  for (const double cost : costs) sum += cost;
  const double distortion = PriorWeight(kDistortionSigma, options);
  for (const AdjustedCamera& camera : a.cameras)
    sum += 0.5 * distortion * camera.lens.values.tail(camera.lens.count() - 4).squaredNorm();
  return sum + 0.5 * PriorWeight(kFlatnessSigmaMm, options) * a.flatness_mm.squaredNorm();
}

NormalEquations EquationsOf(const Adjustment& a, const BundleOptions& options) {
  std::vector<ViewEquations> parts(a.views.size());
  tbb::parallel_for(std::size_t{0}, a.views.size(), [&](std::size_t i) {
    if (a.views[i].is_used) parts[i] = EquationsOfView(a, a.views[i], options);
  });
  NormalEquations sum(a.camera_parameters(), static_cast<int>(a.boards.size()));
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (a.views[i].is_used) AddView(a, a.views[i], parts[i], &sum);
  AddPriors(a, options, &sum);
  FixWhatStays(a, &sum);
  return sum;
}

std::optional<LensEvidence> LensEvidenceOf(const Adjustment& a, const AdjustedView& view) {
  core::Require(view.board_count == 1, "a view by itself has one board");
  const ViewEquations e = EquationsOfView(a, view, {});
  const int intrinsics = a.cameras[static_cast<std::size_t>(view.camera)].lens.count();
  const Eigen::LLT<MatrixXd> board(e.matrix.bottomRightCorner(6, 6));
  if (board.info() != Eigen::Success) return std::nullopt;
  const MatrixXd mixed = e.matrix.bottomLeftCorner(6, intrinsics), solved = board.solve(mixed);
  return LensEvidence{e.matrix.topLeftCorner(intrinsics, intrinsics) - mixed.transpose() * solved,
                      e.gradient.head(intrinsics) - solved.transpose() * e.gradient.tail(6)};
}

std::optional<double> SpreadOfPulls(const Adjustment& a, double noise_scale) {
  BundleOptions options;
  options.noise_scale = noise_scale;
  const std::vector<ParameterRange> kept = a.kept_parameters();
  std::vector<GradientPart> pulls;
  for (const AdjustedView& view : a.views)
    if (view.is_used) pulls.push_back(PullOf(a, view, kept));
  const std::optional<double> spread = SpreadOfParts(EquationsOf(a, options), pulls);
  return spread ? std::optional(*spread / (noise_scale * noise_scale)) : std::nullopt;
}

MatrixXd BoardInformation(const Adjustment& a, const AdjustedView& view) {
  return EquationsOfView(a, view, {}).matrix.bottomRightCorner(6 * view.board_count, 6 * view.board_count);
}

Adjustment AdjustBundle(Adjustment start, const BundleOptions& options, const std::stop_token& stop) {
  constexpr double kMostDamping = 1e12, kLeastDamping = 1e-10;
  double damping = 1e-5, cost = CostOf(start, options);
  for (int step = 0; step < options.most_steps; ++step) {
    core::ThrowIfStopped(stop, "calibration");
    const NormalEquations equations = EquationsOf(start, options);
    bool is_better = false;
    double gain = 0.0;
    for (; !is_better && damping < kMostDamping; damping *= is_better ? 0.1 : 10.0) {
      const std::optional<VectorXd> change = SolveNormalEquations(equations, damping);
      if (!change) continue;
      Adjustment moved = Moved(start, *change);
      const double moved_cost =
          IsPossible(moved) ? CostOf(moved, options) : std::numeric_limits<double>::infinity();
      if (!(moved_cost <= cost)) continue;
      gain = cost - moved_cost;
      start = std::move(moved);
      cost = moved_cost;
      is_better = true;
    }
    if (!is_better || gain <= options.settled * cost) break;
    damping = std::max(damping, kLeastDamping);
  }
  return start;
}

double RobustNoiseScale(const Adjustment& adjustment) {
  std::vector<double> squared = SquaredResiduals(adjustment);
  if (squared.empty()) return 1.0;
  const auto middle = squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 2);
  std::nth_element(squared.begin(), middle, squared.end());
  // The median of x^2 + y^2 of standard normal x and y is 2 ln 2.
  return std::max(1e-6, std::sqrt(*middle / (2.0 * std::log(2.0))));
}

std::optional<double> NoiseScale(const Adjustment& adjustment) {
  const std::vector<double> squared = SquaredResiduals(adjustment);
  const int freedom = 2 * static_cast<int>(squared.size()) - FreeParameters(adjustment);
  if (freedom <= 0) return std::nullopt;
  double sum = 0.0;
  for (const double s : squared) sum += s;
  return std::max(1e-6, std::sqrt(sum / freedom));
}

}  // namespace elbowroom::recon
