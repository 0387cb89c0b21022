#include "recon/calibration/rig_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "core/error.h"
#include "recon/calibration/lens_fit.h"

namespace elbowroom::recon {
namespace {

constexpr double kMostPeriods = 3.5;   // between neighbours by which the board moves
constexpr double kLeastPeriods = 0.2;  // nearer ones are one instant
constexpr double kSameInstantS = 1e-9;

using Neighbours = std::array<int, 3>;  // places in a list of sets, the own one first

// Of places in `confirmed`; nothing where three in a row are too far apart.
std::optional<Neighbours> NeighboursOf(const RigState& state, const std::vector<int>& confirmed, int own) {
  const int count = static_cast<int>(confirmed.size());
  const auto are_near = [&](int a, int b) {
    if (a < 0 || b >= count) return false;
    const double span_s =
        state.sets[static_cast<std::size_t>(confirmed[static_cast<std::size_t>(b)])].time_s -
        state.sets[static_cast<std::size_t>(confirmed[static_cast<std::size_t>(a)])].time_s;
    const double period_s = state.input->frame_period_s;
    return span_s >= kLeastPeriods * period_s && span_s <= kMostPeriods * period_s;
  };
  const bool has_before = are_near(own - 1, own), has_after = are_near(own, own + 1);
  if (has_before && has_after) return Neighbours{own, own - 1, own + 1};
  if (has_after && are_near(own + 1, own + 2)) return Neighbours{own, own + 1, own + 2};
  if (has_before && are_near(own - 2, own - 1)) return Neighbours{own, own - 1, own - 2};
  return std::nullopt;
}

// Sets whose board several cameras confirm, or that are the world.
std::vector<int> ConfirmedSets(const RigState& state) {
  std::vector<int> confirmed;
  for (int k = 0; k < static_cast<int>(state.sets.size()); ++k) {
    const RigSet& set = state.sets[static_cast<std::size_t>(k)];
    const int used = state.UsedViewsOf(set);
    if (set.has_pose && (used >= 2 || (k == state.world_set && used >= 1))) confirmed.push_back(k);
  }
  return confirmed;
}

bool IsAtSetInstant(const RigState& state, const RigView& view) {
  const AdjustedCamera& camera = state.cameras[static_cast<std::size_t>(view.camera)];
  const double time_s = state.sets[static_cast<std::size_t>(view.set)].time_s;
  return camera.is_offset_fixed && std::abs(view.time_s + camera.time_offset_s - time_s) < kSameInstantS;
}

// Beyond its ends a parabola through three poses is soon as far off as the noise: it is three times as far
// off half a step outside as anywhere inside.
bool IsWithin(const RigState& state, const std::vector<int>& confirmed, const Neighbours& neighbours,
              const RigView& view) {
  constexpr double kMostOutside = 0.15;  // of a frame period; as far off as inside
  const double t_s = view.time_s + state.cameras[static_cast<std::size_t>(view.camera)].time_offset_s;
  const auto time_of = [&](int k) {
    return state.sets[static_cast<std::size_t>(confirmed[static_cast<std::size_t>(k)])].time_s;
  };
  const auto [first, last] =
      std::minmax({time_of(neighbours[0]), time_of(neighbours[1]), time_of(neighbours[2])});
  const double outside_s = kMostOutside * state.input->frame_period_s;
  return t_s >= first - outside_s && t_s <= last + outside_s;
}

AdjustedView AdjustedViewOf(const RigView& view) {
  AdjustedView adjusted;
  adjusted.camera = view.camera;
  adjusted.time_s = view.time_s;
  adjusted.points = view.points;
  return adjusted;
}

int AddPrivateBoard(const RigState& state, const RigView& view, Adjustment* a) {
  AdjustedBoard board;
  board.rig_from_board =
      state.cameras[static_cast<std::size_t>(view.camera)].cam_from_rig.Inverse() * view.cam_from_board;
  a->boards.push_back(board);
  return static_cast<int>(a->boards.size()) - 1;
}

// Views of confirmed sets, each with the boards by which it moves.
void AddSharedViews(const std::vector<int>& confirmed, RigState* state, Adjustment* a) {
  for (int i = 0; i < static_cast<int>(confirmed.size()); ++i) {
    RigSet& set = state->sets[static_cast<std::size_t>(confirmed[static_cast<std::size_t>(i)])];
    const std::optional<Neighbours> neighbours = NeighboursOf(*state, confirmed, i);
    const bool is_world = confirmed[static_cast<std::size_t>(i)] == state->world_set;
    for (const int v : set.views) {
      RigView& view = state->views[static_cast<std::size_t>(v)];
      if (!view.is_used) continue;
      const bool moves = state->has_motion && !IsAtSetInstant(*state, view);
      if (moves && !is_world && !(neighbours && IsWithin(*state, confirmed, *neighbours, view))) continue;
      AdjustedView adjusted = AdjustedViewOf(view);
      adjusted.boards[0] = i;
      if (moves && neighbours) {
        adjusted.boards = *neighbours;
        adjusted.board_count = 3;
      }
      view.shares_board = true;
      view.adjusted = static_cast<int>(a->views.size());
      a->views.push_back(std::move(adjusted));
    }
  }
}

void PutStamps(RigSet* set, const std::vector<RigView>& views) {
  double sum_s = 0.0;
  for (const int v : set->views) {
    const RigView& view = views[static_cast<std::size_t>(v)];
    sum_s += view.time_s;
    if (view.camera != 0) continue;
    set->time_s = view.time_s;
    return;
  }
  set->time_s = sum_s / static_cast<double>(set->views.size());
}

}  // namespace

int RigState::UsedViewsOf(const RigSet& set) const {
  int used = 0;
  for (const int v : set.views) used += views[static_cast<std::size_t>(v)].is_used ? 1 : 0;
  return used;
}

RigState StateOf(const CalibrationInput& input, const BoardSurface& surface,
                 const std::vector<LensParameters>& lenses) {
  RigState state;
  state.input = &input;
  state.surface = &surface;
  for (std::size_t i = 0; i < input.cameras.size(); ++i) {
    AdjustedCamera camera;
    camera.lens = lenses[i];
    camera.is_lens_fixed = input.cameras[i].known.has_value();
    state.cameras.push_back(camera);
  }
  std::map<int, int> place_of;  // of a set by its number
  for (const CalibrationView& seen : input.views)
    if (seen.set) place_of.emplace(*seen.set, 0);
  for (auto& [number, place] : place_of) {
    place = static_cast<int>(state.sets.size());
    state.sets.emplace_back().number = number;
  }
  for (const CalibrationView& seen : input.views) {
    RigView view;
    view.camera = seen.camera;
    view.time_s = seen.time_s;
    view.points = AdjustedPointsOf(seen.sighting);
    if (seen.set) {
      view.set = place_of[*seen.set];
      state.sets[static_cast<std::size_t>(view.set)].views.push_back(static_cast<int>(state.views.size()));
    }
    state.views.push_back(std::move(view));
  }
  for (RigSet& set : state.sets) {
    std::ranges::sort(set.views, {}, [&](int v) { return state.views[static_cast<std::size_t>(v)].camera; });
    PutStamps(&set, state.views);
  }
  if (input.world.kind == CalibrationWorld::Kind::kCamera) return state;
  if (!place_of.contains(input.world.number))
    throw core::Error(
        core::ErrorKind::kCamera,
        fmt::format("no camera sees the board in set {}, which is to be the world; next, take a picture "
                    "of the board on the table with camera '{}', or name another set",
                    input.world.number, input.cameras.front().name));
  state.world_set = place_of[input.world.number];
  return state;
}

Adjustment AdjustmentOf(RigState* state) {
  Adjustment a;
  a.surface = state->surface;
  a.flatness_mm = state->flatness_mm;
  a.is_flatness_fixed = state->is_flatness_fixed;
  a.cameras = state->cameras;
  for (RigView& view : state->views) {
    view.adjusted = -1;
    view.shares_board = false;
  }
  for (RigSet& set : state->sets) set.adjusted = -1;
  const std::vector<int> confirmed = ConfirmedSets(*state);
  for (const int k : confirmed) {
    RigSet& set = state->sets[static_cast<std::size_t>(k)];
    set.adjusted = static_cast<int>(a.boards.size());
    a.boards.push_back({set.rig_from_board, set.time_s, k == state->world_set});
  }
  AddSharedViews(confirmed, state, &a);
  for (RigView& view : state->views) {
    if (!view.is_used || view.shares_board || !view.has_pose) continue;
    AdjustedView adjusted = AdjustedViewOf(view);
    adjusted.boards[0] = AddPrivateBoard(*state, view, &a);
    view.adjusted = static_cast<int>(a.views.size());
    a.views.push_back(std::move(adjusted));
  }
  return a;
}

void TakeOver(const Adjustment& a, RigState* state) {
  state->cameras = a.cameras;
  state->flatness_mm = a.flatness_mm;
  for (RigSet& set : state->sets)
    if (set.adjusted >= 0)
      set.rig_from_board = a.boards[static_cast<std::size_t>(set.adjusted)].rig_from_board;
  for (RigView& view : state->views) {
    if (view.adjusted < 0) continue;
    const AdjustedView& adjusted = a.views[static_cast<std::size_t>(view.adjusted)];
    view.points = adjusted.points;
    view.is_used = adjusted.is_used;
    view.cam_from_board = CamFromBoardAt(a, adjusted);
  }
  for (RigSet& set : state->sets) {
    if (set.adjusted >= 0 || set.views.empty()) continue;
    const RigView& view = state->views[static_cast<std::size_t>(set.views.front())];
    if (view.adjusted >= 0)
      set.rig_from_board =
          state->cameras[static_cast<std::size_t>(view.camera)].cam_from_rig.Inverse() * view.cam_from_board;
  }
}

double ShareOfMovingSets(const RigState& state) {
  const std::vector<int> confirmed = ConfirmedSets(state);
  if (confirmed.empty()) return 0.0;
  int moving = 0;
  for (int i = 0; i < static_cast<int>(confirmed.size()); ++i)
    moving += NeighboursOf(state, confirmed, i) ? 1 : 0;
  return static_cast<double>(moving) / static_cast<double>(confirmed.size());
}

PosedView PosedAtSetInstant(const Adjustment& a, const AdjustedView& view) {
  const AdjustedCamera& camera = a.cameras[static_cast<std::size_t>(view.camera)];
  const core::RigidTransform board_from_board_then =
      a.boards[static_cast<std::size_t>(view.boards[0])].rig_from_board.Inverse() * RigFromBoardAt(a, view);
  PosedView posed{&camera.lens, camera.cam_from_rig, {}};
  for (const AdjustedPoint& point : view.points)
    if (point.is_used)
      posed.points.push_back({board_from_board_then * a.surface->Bent(point.point, a.flatness_mm),
                              point.pixel, point.inverse_sigma});
  return posed;
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): it may be a pose of the state
void ChangeFrame(core::RigidTransform new_from_rig, RigState* state) {
  const core::RigidTransform rig_from_new = new_from_rig.Inverse();
  for (AdjustedCamera& camera : state->cameras) camera.cam_from_rig = camera.cam_from_rig * rig_from_new;
  for (RigSet& set : state->sets) set.rig_from_board = new_from_rig * set.rig_from_board;
}

}  // namespace elbowroom::recon
