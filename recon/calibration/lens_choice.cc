#include "recon/calibration/lens_choice.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "recon/calibration/bundle.h"

namespace elbowroom::recon {
namespace {

using core::DistortionModel;

// The camera's used views, each with a board of its own where the rig has it.
Adjustment ViewsOf(const Adjustment& rig, int camera) {
  Adjustment alone;
  alone.surface = rig.surface;
  alone.flatness_mm = rig.flatness_mm;
  alone.cameras.emplace_back().lens = rig.cameras[static_cast<std::size_t>(camera)].lens;
  alone.cameras.front().is_pose_fixed = true;
  for (const AdjustedView& seen : rig.views) {
    if (seen.camera != camera || !seen.is_used) continue;
    AdjustedView view;
    view.boards[0] = static_cast<int>(alone.boards.size());
    view.points = seen.points;
    alone.boards.emplace_back().rig_from_board = CamFromBoardAt(rig, seen);
    alone.views.push_back(std::move(view));
  }
  return alone;
}

struct JudgedModel {
  DistortionModel model;
  Adjustment fit;
  // Chi squared of each view's points, by lenses and poses that don't know them.
  std::vector<double> held_out;
};

// Which fifth of the points each point of each view is in. They are drawn: every fifth would be a column of
// some boards. Whole views aren't left out: one alone may show a corner of the picture, of which the others
// then say nothing.
constexpr unsigned kFolds = 5;
using Folds = std::vector<std::vector<unsigned>>;

Folds DrawFolds(const Adjustment& a) {
  std::minstd_rand random(1);
  Folds folds;
  for (const AdjustedView& view : a.views) {
    std::vector<unsigned>& of_points = folds.emplace_back();
    for (std::size_t i = 0; i < view.points.size(); ++i)
      of_points.push_back(static_cast<unsigned>(random() / 7) % kFolds);
  }
  return folds;
}

std::vector<double> HeldOutChi2(const Adjustment& all, const Folds& folds, const BundleOptions& options,
                                const std::stop_token& stop) {
  constexpr double kMostSigmas = 10.0;  // a rational lens may have a pole just where a point is left out
  std::vector<double> chi2(all.views.size(), 0.0);
  for (unsigned fold = 0; fold < kFolds; ++fold) {
    Adjustment others = all;
    for (std::size_t v = 0; v < all.views.size(); ++v)
      for (std::size_t i = 0; i < all.views[v].points.size(); ++i)
        if (folds[v][i] == fold) others.views[v].points[i].is_used = false;
    others = AdjustBundle(std::move(others), options, stop);
    for (std::size_t v = 0; v < all.views.size(); ++v) {
      const core::RigidTransform cam_from_board = CamFromBoardAt(others, others.views[v]);
      for (std::size_t i = 0; i < all.views[v].points.size(); ++i) {
        const AdjustedPoint& point = all.views[v].points[i];
        if (!point.is_used || folds[v][i] != fold) continue;
        const auto residual = ResidualOf(others, others.views[v], cam_from_board, point);
        const double sigmas =
            residual ? residual->norm() * point.inverse_sigma / options.noise_scale : kMostSigmas;
        chi2[v] += std::pow(std::min(sigmas, kMostSigmas), 2);
      }
    }
  }
  return chi2;
}

JudgedModel Judge(Adjustment fit, DistortionModel model, const Folds& folds, const BundleOptions& options,
                  const std::stop_token& stop) {
  LensParameters& lens = fit.cameras.front().lens;
  if (lens.model != model) {
    lens = WithModel(lens, model);
    const auto fix_boards = [&](bool are_fixed) {
      for (AdjustedBoard& board : fit.boards) board.is_fixed = are_fixed;
    };
    fix_boards(true);  // their poses are known better than the new model's lens
    fit = AdjustBundle(std::move(fit), options, stop);
    fix_boards(false);
  }
  fit = AdjustBundle(std::move(fit), options, stop);
  std::vector<double> held_out = HeldOutChi2(fit, folds, options, stop);
  return {model, std::move(fit), std::move(held_out)};
}

// Whether the error on points left out is clearly less, by at least `least` of chi squared. Residuals of one
// view may be off together, as those of a rolling shutter are, so the standard error is that of the views'
// differences.
bool IsClearlyBetter(const JudgedModel& model, const JudgedModel& than, double least) {
  constexpr double kStandardErrors = 2.0;
  const auto count = static_cast<double>(model.held_out.size());
  double gain = 0.0, squares = 0.0;
  for (std::size_t v = 0; v < model.held_out.size(); ++v) gain += than.held_out[v] - model.held_out[v];
  for (std::size_t v = 0; v < model.held_out.size(); ++v)
    squares += std::pow(than.held_out[v] - model.held_out[v] - gain / count, 2);
  const double standard_error = std::sqrt(squares * count / std::max(1.0, count - 1.0));
  return gain > std::max(least, kStandardErrors * standard_error);
}

}  // namespace

LensParameters ChooseLens(const Adjustment& rig, int camera, double noise_scale,
                          const std::stop_token& stop) {
  constexpr double kLeastForFisheye = 9.0;  // of chi squared
  BundleOptions options;
  options.noise_scale = noise_scale;
  options.most_steps = 15;
  options.settled = 1e-6;
  const Adjustment alone = ViewsOf(rig, camera);
  const Folds folds = DrawFolds(alone);
  const DistortionModel present = alone.cameras.front().lens.model;
  JudgedModel best = Judge(alone, DistortionModel::kPlumbBob, folds, options, stop);
  JudgedModel rational = Judge(present == DistortionModel::kPlumbBob ? best.fit : alone,
                               DistortionModel::kRationalPolynomial, folds, options, stop);
  if (IsClearlyBetter(rational, best, 0.0)) best = std::move(rational);
  if (best.model != DistortionModel::kPlumbBob || present == DistortionModel::kFisheye) {
    JudgedModel fisheye = Judge(alone, DistortionModel::kFisheye, folds, options, stop);
    if (IsClearlyBetter(fisheye, best, kLeastForFisheye)) best = std::move(fisheye);
  }
  return best.model == present ? alone.cameras.front().lens : best.fit.cameras.front().lens;
}

}  // namespace elbowroom::recon
