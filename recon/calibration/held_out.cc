#include "recon/calibration/held_out.h"

#include <cmath>
#include <map>
#include <vector>

#include "recon/calibration/triangulation.h"

namespace elbowroom::recon {
namespace {

using core::RigidTransform;
using Eigen::Vector3d;

constexpr int kEveryNth = 5;
constexpr std::size_t kLeastSets = 6;

struct SumOfSquares {
  double sum = 0.0;
  int count = 0;

  void Add(double squared) {
    sum += squared;
    ++count;
  }
  [[nodiscard]] std::optional<double> Rms() const {
    return count > 0 ? std::optional(std::sqrt(sum / count)) : std::nullopt;
  }
};

// Places of the sets that are kept out.
std::vector<std::size_t> KeptOutSets(const RigState& state) {
  std::vector<std::size_t> confirmed, kept_out;
  for (std::size_t k = 0; k < state.sets.size(); ++k)
    if (state.sets[k].adjusted >= 0 && static_cast<int>(k) != state.world_set &&
        state.UsedViewsOf(state.sets[k]) >= 2)
      confirmed.push_back(k);
  if (confirmed.size() < kLeastSets) return {};
  for (std::size_t i = kEveryNth / 2; i < confirmed.size(); i += kEveryNth) kept_out.push_back(confirmed[i]);
  return kept_out;
}

// The cameras as the other sets have them, with all views and boards of the first fit.
Adjustment SecondFit(const RigFit& fit, const std::vector<std::size_t>& kept_out,
                     const std::stop_token& stop) {
  constexpr int kSteps = 8;
  RigState others = fit.state;
  for (const std::size_t k : kept_out)
    for (const int v : others.sets[k].views) others.views[static_cast<std::size_t>(v)].is_used = false;
  (void)FitPlainly(&others, fit.noise_scale, kSteps, stop);
  for (std::size_t i = 0; i < others.views.size(); ++i) others.views[i].is_used = fit.state.views[i].is_used;
  return AdjustmentOf(&others);
}

// A board's pose by some of its views, and each view moved to its instant by the motion around that pose.
RigidTransform PlaceBoard(const std::vector<const AdjustedView*>& views, std::size_t board, Adjustment* a) {
  constexpr int kRounds = 2;  // the motion depends on the pose, a little
  for (int round = 0; round < kRounds; ++round) {
    std::vector<PosedView> posed;
    for (const AdjustedView* view : views) posed.push_back(PosedAtSetInstant(*a, *view));
    a->boards[board].rig_from_board =
        FitBoardPose(posed, a->boards[board].rig_from_board, 0.0).rig_from_board;
  }
  return a->boards[board].rig_from_board;
}

// Errors of a view's points where the board now is.
void AddErrorsOf(const AdjustedView& view, const Adjustment& a, SumOfSquares* errors) {
  const RigidTransform cam_from_board = CamFromBoardAt(a, view);
  for (const AdjustedPoint& point : view.points) {
    const auto residual = point.is_used ? ResidualOf(a, view, cam_from_board, point) : std::nullopt;
    if (residual) errors->Add(residual->squaredNorm());
  }
}

// Errors of each view where the others place the board.
void AddCrossErrors(const std::vector<const AdjustedView*>& views, std::size_t board, Adjustment* a,
                    SumOfSquares* errors) {
  const std::size_t least_others = a->cameras.size() > 2 ? 2 : 1;
  if (views.size() <= least_others) return;
  const RigidTransform before = a->boards[board].rig_from_board;
  for (const AdjustedView* view : views) {
    std::vector<const AdjustedView*> others;
    for (const AdjustedView* other : views)
      if (other != view) others.push_back(other);
    PlaceBoard(others, board, a);
    AddErrorsOf(*view, *a, errors);
    a->boards[board].rig_from_board = before;
  }
}

// Points of the board in space, by number.
std::map<int, Vector3d> TriangulateBoard(const std::vector<const AdjustedView*>& views, std::size_t board,
                                         const Adjustment& a) {
  std::map<int, std::vector<PointSight>> sights;
  for (const AdjustedView* view : views) {
    const AdjustedCamera& camera = a.cameras[static_cast<std::size_t>(view->camera)];
    const RigidTransform then = CamFromBoardAt(a, *view);
    const RigidTransform now = camera.cam_from_rig * a.boards[board].rig_from_board;
    for (const AdjustedPoint& point : view->points) {
      if (!point.is_used) continue;
      const Vector3d x_in_board = a.surface->Bent(point.point, a.flatness_mm);
      const auto seen_then = ProjectPoint(camera.lens, then * x_in_board);
      const auto seen_now = ProjectPoint(camera.lens, now * x_in_board);
      if (seen_then && seen_now)
        sights[point.point].push_back(
            {&camera.lens, camera.cam_from_rig, point.pixel + *seen_now - *seen_then});
    }
  }
  std::map<int, Vector3d> points;
  for (const auto& [number, of_point] : sights)
    if (const auto x = Triangulate(of_point)) points.emplace(number, *x);
  return points;
}

void AddLengths(const std::map<int, Vector3d>& points, const Adjustment& a, SumOfSquares* lengths) {
  const auto on_board = [&](int number) { return a.surface->Bent(number, a.flatness_mm); };
  for (const auto& [number, x] : points) {
    int farthest = number;
    double longest_mm = 0.0;
    for (const auto& [other, y] : points) {
      const double length_mm = (on_board(other) - on_board(number)).norm();
      if (length_mm <= longest_mm) continue;
      longest_mm = length_mm;
      farthest = other;
    }
    if (farthest != number) lengths->Add(std::pow((points.at(farthest) - x).norm() - longest_mm, 2));
  }
}

}  // namespace

HeldOutFigures MeasureHeldOut(const RigFit& fit, const std::stop_token& stop) {
  const std::vector<std::size_t> kept_out = KeptOutSets(fit.state);
  if (kept_out.empty()) return {};
  Adjustment a = SecondFit(fit, kept_out, stop);
  SumOfSquares errors, cross_errors, lengths;
  for (const std::size_t k : kept_out) {
    const auto board = static_cast<std::size_t>(fit.state.sets[k].adjusted);
    std::vector<const AdjustedView*> views;
    for (const AdjustedView& view : a.views)
      if (view.is_used && view.boards[0] == static_cast<int>(board)) views.push_back(&view);
    if (views.size() < 2) continue;
    AddCrossErrors(views, board, &a, &cross_errors);
    PlaceBoard(views, board, &a);
    for (const AdjustedView* view : views) AddErrorsOf(*view, a, &errors);
    AddLengths(TriangulateBoard(views, board, a), a, &lengths);
  }
  return {errors.Rms(), cross_errors.Rms(), lengths.Rms()};
}

}  // namespace elbowroom::recon
