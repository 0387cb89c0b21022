#include "recon/calibration/flips.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace elbowroom::recon {
namespace {

using core::RigidTransform;

// A squared residual of one point is twice the noise's square in the mean, so half of it is one of these.
bool FitsLikeNoise(const PosedView& view, const RigidTransform& rig_from_board,
                   const BundleOptions& options) {
  constexpr double kLikeNoise = 1.5;
  const double cost =
      FitBoardPose({&view, 1}, rig_from_board, options.cauchy_scale * options.noise_scale, 0).cost;
  return cost <= kLikeNoise * std::pow(options.noise_scale, 2) * static_cast<double>(view.points.size());
}

// Whether a mirrored pose may be the better one. Not where two cameras confirm the pose that see the board
// from directions far apart: they don't agree on a mirrored one. Misfits are boards of which no two views do.
bool IsDoubtful(FlipsTried tried, const std::vector<PosedView>& views, const RigidTransform& rig_from_board,
                const Eigen::Vector3d& center, const BundleOptions& options) {
  constexpr double kFarApartRad = 0.3;
  std::vector<Eigen::Vector3d> sights;  // of views that fit
  for (const PosedView& view : views)
    if (FitsLikeNoise(view, rig_from_board, options))
      sights.push_back((rig_from_board * center - view.cam_from_rig.Inverse().translation_mm).normalized());
  if (tried == FlipsTried::kOfMisfits && sights.size() == views.size()) return false;
  return std::ranges::none_of(sights, [&](const Eigen::Vector3d& sight) {
    return sight.dot(sights.front()) < std::cos(kFarApartRad);
  });
}

// Exchanges poses whose mirror image fits better; returns whether there were any. A flip of the world's board
// moves the world.
bool TakeBetterBoards(FlipsTried tried, const BundleOptions& options, Adjustment* a,
                      std::optional<RigidTransform>* new_world) {
  constexpr double kClearlyBetter = 0.999;  // both ways may end in one minimum
  const double cauchy_scale = options.cauchy_scale * options.noise_scale;
  const std::vector<std::vector<PosedView>> views = ViewsOfBoards(*a);
  bool has_changed = false;
  for (std::size_t k = 0; k < a->boards.size(); ++k) {
    if (views[k].empty()) continue;
    AdjustedBoard& board = a->boards[k];
    const PoseFit kept = FitBoardPose(views[k], board.rig_from_board, cauchy_scale);
    if (!IsDoubtful(tried, views[k], kept.rig_from_board, a->surface->center(), options)) continue;
    const PoseFit other = BestFlip(views[k], kept, a->surface->center(), cauchy_scale);
    if (!(other.cost < kClearlyBetter * kept.cost)) continue;
    has_changed = true;
    if (board.is_fixed)
      *new_world = other.rig_from_board;
    else
      board.rig_from_board = other.rig_from_board;
  }
  return has_changed;
}

}  // namespace

std::vector<std::vector<PosedView>> ViewsOfBoards(const Adjustment& a) {
  std::vector<std::vector<PosedView>> views(a.boards.size());
  for (const AdjustedView& view : a.views)
    if (view.is_used) views[static_cast<std::size_t>(view.boards[0])].push_back(PosedAtSetInstant(a, view));
  return views;
}

PoseFit BestFlip(const std::vector<PosedView>& views, const PoseFit& kept, const Eigen::Vector3d& center,
                 double cauchy_scale) {
  PoseFit best{kept.rig_from_board, std::numeric_limits<double>::infinity()};
  for (const PosedView& view : views) {
    const RigidTransform start =
        view.cam_from_rig.Inverse() * Flipped(view.cam_from_rig * kept.rig_from_board, center);
    const PoseFit fit = FitBoardPose(views, start, cauchy_scale);
    if (fit.cost < best.cost) best = fit;
  }
  return best;
}

bool ExchangeFlips(FlipsTried tried, const BundleOptions& options, Adjustment* a, RigState* state) {
  std::optional<RigidTransform> new_world;
  const bool has_changed = TakeBetterBoards(tried, options, a, &new_world);
  TakeOver(*a, state);
  if (!new_world) return has_changed;
  RigSet& world = state->sets[static_cast<std::size_t>(state->world_set)];
  world.rig_from_board = *new_world;
  ChangeFrame(new_world->Inverse(), state);
  world.rig_from_board = {};
  return true;
}

}  // namespace elbowroom::recon
