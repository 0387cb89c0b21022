#include "recon/consistency/rig_watch.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

bool IsPowerOfTwo(int value) { return value > 0 && (value & (value - 1)) == 0; }

double DistanceToWorkspaceMm(const EpipolarPairs& pairs, core::CameraIndex camera) {
  return (pairs.workspace_mm().center() - pairs.plane(camera).camera().center_in_world()).norm();
}

// x' pinv(information) x, and the rank: what an estimate's deviation tells of the noise.
std::pair<double, int> DeviationSquares(const MatrixXd& information, const VectorXd& score) {
  constexpr double kRankShare = 1e-6;  // entries are scaled to px, so smaller ones weren't seen
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(information);
  const double least = kRankShare * eigen.eigenvalues().maxCoeff();
  double squares = 0.0;
  int rank = 0;
  for (Eigen::Index i = 0; i < score.size(); ++i) {
    if (eigen.eigenvalues()[i] <= least) continue;
    const double part = eigen.eigenvectors().col(i).dot(score);
    squares += part * part / eigen.eigenvalues()[i];
    ++rank;
  }
  return {squares, rank};
}

}  // namespace

void WatchOptions::Validate() const {
  core::Require(block_s > 0.0, "block_s is positive");
  core::Require(learning_blocks >= 2, "learning_blocks is 2 or more");
  core::Require(IsPowerOfTwo(longest_window), "longest_window is a power of 2");
  core::Require(calibration_sigma_px > 0.0, "calibration_sigma_px is positive");
  core::Require(steady_sigma_px > 0.0 && wander_sigma_px > 0.0, "steady and wander sigmas are positive");
  core::Require(typical_change_px > 0.0, "typical_change_px is positive");
  core::Require(hours_per_false_alarm > 0.0, "hours_per_false_alarm is positive");
  core::Require(naming_odds >= 1.0, "naming_odds is 1 or more");
  core::Require(naming_share >= 0.0 && naming_share < 1.0, "naming_share is in [0, 1)");
  core::Require(unknowns.dilation_px > 0.0 && unknowns.skew_s > 0.0 && unknowns.stamp_jitter_s >= 0.0,
                "the block's unknowns are positive");
}

double ChiSquaredSix(double probability) {
  core::Require(probability > 0.0 && probability < 1.0, "a probability is between 0 and 1");
  // P(chi^2 > x) = exp(-x / 2) (1 + x / 2 + x^2 / 8): x by Newton's method on its logarithm.
  double x = -2.0 * std::log(probability);
  for (int i = 0; i < 50; ++i) {
    const double sum = 1.0 + x / 2.0 + x * x / 8.0;
    const double value = -x / 2.0 + std::log(sum) - std::log(probability);
    x -= value / (-0.5 + (0.5 + x / 4.0) / sum);
  }
  return x;
}

RigWatch::RigWatch(std::shared_ptr<const EpipolarPairs> pairs, const WatchOptions& options)
    : pairs_(std::move(pairs)),
      options_(options),
      layout_(pairs_->camera_count(), pairs_->pairs().size()),
      prior_(layout_.size()),
      learned_(Evidence::None(layout_)) {
  options_.Validate();
  const auto inverse_square = [](double sigma) { return 1.0 / (sigma * sigma); };
  for (core::CameraIndex i = 0; i < layout_.cameras(); ++i) {
    const UndistortedPlane& plane = pairs_->plane(i);
    const double distance_mm = DistanceToWorkspaceMm(*pairs_, i);
    const double sigma_rad = options_.calibration_sigma_px / plane.focal_px();
    prior_.segment<3>(layout_.Pose(i)).setConstant(inverse_square(sigma_rad));
    prior_.segment<3>(layout_.Pose(i) + 3).setConstant(inverse_square(sigma_rad * distance_mm));
    shift_squares_.push_back(ShiftSquares(plane.camera(), plane.focal_px(), distance_mm));
  }
  prior_.tail(layout_.size() - layout_.steady_begin()).setConstant(inverse_square(options_.steady_sigma_px));
  const double windows = 1.0 + std::log2(options_.longest_window);
  const double tests = options_.hours_per_false_alarm * 3600.0 / options_.block_s *
                       static_cast<double>(layout_.cameras()) * windows;
  state_.threshold = ChiSquaredSix(1.0 / tests);
}

void RigWatch::Add(double time_s, FrameTangencies frame) {
  if (!open_.empty() && time_s >= open_.front().time_s + options_.block_s) CloseBlock();
  if (!frame.found.empty()) open_.push_back({time_s, std::move(frame)});
}

void RigWatch::CloseBlock() {
  Block block{open_.front().time_s, EvidenceOf(*pairs_, layout_, open_, options_.unknowns)};
  open_.clear();
  if (block.evidence.residuals == 0) return;
  ++state_.blocks;
  recent_.push_back(std::move(block));
  if (state_.is_learning) {
    if (state_.blocks == options_.learning_blocks) FinishLearning();
    return;
  }
  if (recent_.size() > static_cast<std::size_t>(options_.longest_window)) {
    if (!state_.moved && !state_.has_changed) Learn(recent_.front().evidence);
    recent_.pop_front();
  }
  Judge();
}

MatrixXd RigWatch::LearnedInformation() const {
  MatrixXd information = learned_.information / (state_.noise_factor * state_.noise_factor);
  information.diagonal() += prior_;
  return information;
}

// The score of what a block deviates from what is learned scatters as its information says, times the square
// of the noise factor.
void RigWatch::UpdateNoise(const Evidence& evidence, const VectorXd& learned) {
  const VectorXd scale = prior_.cwiseSqrt().cwiseInverse();
  const VectorXd score = evidence.score - evidence.information * learned;
  const auto [squares, rank] = DeviationSquares(
      scale.asDiagonal() * evidence.information * scale.asDiagonal(), scale.cwiseProduct(score));
  noise_squares_ += squares;
  noise_count_ += rank;
  state_.noise_factor = std::max(0.5, std::sqrt(noise_squares_ / std::max(1.0, noise_count_)));
}

void RigWatch::Learn(const Evidence& evidence) {
  learned_ += evidence;
  const double factor = state_.noise_factor;
  UpdateNoise(evidence, LearnedInformation().ldlt().solve(learned_.score / (factor * factor)));
}

void RigWatch::FinishLearning() {
  for (const Block& block : recent_) learned_ += block.evidence;
  const VectorXd learned = LearnedInformation().ldlt().solve(learned_.score);
  for (const Block& block : recent_) UpdateNoise(block.evidence, learned);
  recent_.clear();
  state_.is_learning = false;
}

// With Lambda x = h learned before, and A (x + change) = y in the window, x unknown: the change of one camera
// has the information A - A (Lambda + A)^-1 A and the score y - A (Lambda + A)^-1 (h + y) in its rows.
RigWatch::WindowTest RigWatch::Test(const Evidence& window) const {
  const double weight = 1.0 / (state_.noise_factor * state_.noise_factor);
  MatrixXd information = weight * window.information;
  VectorXd score = weight * window.score;
  // The steady residuals may be others at the place where the hands are now: an unknown of the window.
  const Eigen::Index steady = layout_.size() - layout_.steady_begin();
  MatrixXd inner = information.bottomRightCorner(steady, steady);
  inner.diagonal().array() += 1.0 / (options_.wander_sigma_px * options_.wander_sigma_px);
  const MatrixXd mixed = information.rightCols(steady);
  const Eigen::LDLT<MatrixXd> inner_solver(inner);
  const VectorXd inner_score = score.tail(steady);
  information -= mixed * inner_solver.solve(mixed.transpose());
  score -= mixed * inner_solver.solve(inner_score);

  const Eigen::LDLT<MatrixXd> solver(LearnedInformation() + information);
  WindowTest test;
  test.information = information - information * solver.solve(information);
  test.score = score - information * solver.solve(weight * learned_.score + score);
  return test;
}

Matrix6d RigWatch::Information(core::CameraIndex camera, int blocks) const {
  Evidence window = Evidence::None(layout_);
  const auto count = std::min(recent_.size(), static_cast<std::size_t>(std::max(blocks, 0)));
  for (std::size_t i = recent_.size() - count; i < recent_.size(); ++i) window += recent_[i].evidence;
  return Test(window).information.block<6, 6>(layout_.Pose(camera), layout_.Pose(camera));
}

// The change of one camera that explains a window best.
CameraMoved RigWatch::ChangeOf(core::CameraIndex camera, const WindowTest& test, double since_s) const {
  const Eigen::Index at = layout_.Pose(camera);
  const double ratio = options_.calibration_sigma_px / options_.typical_change_px;
  Matrix6d information = test.information.block<6, 6>(at, at);
  information.diagonal() += ratio * ratio * prior_.segment<6>(at);
  const Eigen::LDLT<Matrix6d> solver(information);
  const PoseChange score = test.score.segment<6>(at);
  CameraMoved moved;
  moved.camera = camera;
  moved.since_s = since_s;
  moved.change = solver.solve(score);
  moved.covariance = solver.solve(Matrix6d::Identity());
  moved.statistic = score.dot(moved.change);
  const PoseChange by_change = shift_squares_[camera] * moved.change;
  moved.shift_px = std::sqrt(std::max(0.0, moved.change.dot(by_change)));
  if (moved.shift_px > 0.0)
    moved.shift_sigma_px = std::sqrt(by_change.dot(moved.covariance * by_change)) / moved.shift_px;
  return moved;
}

void RigWatch::Judge() {
  state_.largest_statistic = 0.0;
  double most = state_.moved ? state_.moved->statistic : 0.0;
  Evidence window = Evidence::None(layout_);
  std::size_t blocks = 0;
  for (std::size_t length = 1; length <= recent_.size(); length *= 2) {
    for (; blocks < length; ++blocks) window += recent_[recent_.size() - 1 - blocks].evidence;
    const WindowTest test = Test(window);
    std::vector<CameraMoved> found;
    for (core::CameraIndex camera = 0; camera < layout_.cameras(); ++camera)
      found.push_back(ChangeOf(camera, test, recent_[recent_.size() - blocks].begin_s));
    std::ranges::sort(found, std::greater<>(), &CameraMoved::statistic);
    const double best = found.front().statistic;
    state_.largest_statistic = std::max(state_.largest_statistic, best);
    if (best < state_.threshold || best <= most) continue;
    state_.has_changed = true;
    const double least = best - std::max(2.0 * std::log(options_.naming_odds), options_.naming_share * best);
    const auto end = std::ranges::find_if(found, [&](const CameraMoved& m) { return m.statistic < least; });
    if (end - found.begin() == 1) {
      most = best;
      state_.moved = found.front();
    }
    if (state_.moved && end - found.begin() > 1) continue;
    state_.suspects.clear();
    for (auto suspect = found.begin(); suspect != end; ++suspect) state_.suspects.push_back(suspect->camera);
  }
}

}  // namespace elbowroom::recon
