#include "review/clash.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.h"
#include "review/inside_cells.h"

namespace elbowroom::review {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

// After each block of this many pairs, progress is reported and a stop is checked.
constexpr std::size_t kBlock = 64;

// Bound of the rounding when a vertex is transformed to the world, as a share of the sum of all sizes that
// enter.
constexpr double kDistanceRounding = 4e-15;

// Likewise of the sum of what places two parts: by so much their distance may change when both are shifted by
// the same.
constexpr double kShiftRounding = 4e-15;

AlignedBox3d TurnedBounds(const core::TriangleTree& tree, const Eigen::Matrix3d& rotation) {
  AlignedBox3d box;
  for (const auto& triangle : tree.mesh().triangles) {
    for (const std::int32_t i : triangle)
      box.extend(rotation * tree.mesh().vertices_mm[static_cast<std::size_t>(i)]);
  }
  return box;
}

AlignedBox3d BoundsInWorld(const core::TriangleTree& tree, const AlignedBox3d& turned_bounds,
                           const Vector3d& translation_mm) {
  const double size_mm = tree.bounds().min().cwiseAbs().sum() + tree.bounds().max().cwiseAbs().sum() +
                         translation_mm.cwiseAbs().sum();
  const Vector3d margin_mm = Vector3d::Constant(kDistanceRounding * size_mm);
  return {turned_bounds.min() + translation_mm - margin_mm, turned_bounds.max() + translation_mm + margin_mm};
}

core::Verdict VerdictAt(double distance_mm, double required_mm) {
  if (distance_mm <= kTouchMm) return core::Verdict::kContact;
  return distance_mm < required_mm - kTouchMm ? core::Verdict::kNear : core::Verdict::kClear;
}

core::Verdict VerdictOf(const PairClash& pair) {
  const double distance_mm = pair.gap->distance_mm, uncertainty_mm = pair.uncertainty_mm;
  if (pair.contained)
    return distance_mm > uncertainty_mm ? core::Verdict::kContact : core::Verdict::kUndecided;
  if (distance_mm <= kTouchMm && uncertainty_mm == 0.0) return core::Verdict::kContact;
  const double off_mm = uncertainty_mm + pair.deviation_mm;
  const core::Verdict nearest = VerdictAt(distance_mm - off_mm, pair.demand.required_mm);
  const core::Verdict farthest = VerdictAt(distance_mm + off_mm, pair.demand.required_mm);
  return nearest == farthest ? nearest : core::Verdict::kUndecided;
}

// Whether a connected piece of `piece` is inside of `whole`. The surfaces don't meet, so each piece is inside
// or outside as a whole, and one of its points decides.
bool HoldsAPiece(const SurfaceModel& whole, const core::RigidTransform& world_from_whole,
                 const SurfaceModel& piece, const core::RigidTransform& world_from_piece) {
  if (!whole.tree().is_closed()) return false;
  const core::RigidTransform whole_from_world = world_from_whole.Inverse();
  return std::any_of(piece.piece_points().begin(), piece.piece_points().end(), [&](const Vector3d& point) {
    const Vector3d x_in_whole = whole_from_world * (world_from_piece * point);
    return whole.tree().bounds().contains(x_in_whole) && IsInsideClosedMesh(whole.tree(), x_in_whole);
  });
}

// Bounds how far rounding may put a part off.
double SizeOf(const Vector3d& place_mm, const AlignedBox3d& bounds_in_world) {
  return place_mm.lpNorm<1>() + bounds_in_world.min().lpNorm<1>() + bounds_in_world.max().lpNorm<1>();
}

}  // namespace

ClashCount& ClashCount::operator+=(const ClashCount& other) {
  pairs += other.pairs;
  unchanged += other.unchanged;
  moved_together += other.moved_together;
  settled_by_bounds += other.settled_by_bounds;
  collision_calls += other.collision_calls;
  distance_calls += other.distance_calls;
  return *this;
}

ClashChecker::ClashChecker(const core::Layout& layout, std::vector<PairDemand> pairs,
                           std::vector<double> uncertainty_mm)
    : demands_(std::move(pairs)),
      parts_(layout.parts.size()),
      last_(demands_.size()),
      asked_(demands_.size()) {
  core::Require(uncertainty_mm.empty() || uncertainty_mm.size() == parts_.size(), "one uncertainty a part");
  std::map<core::SharedMesh, std::shared_ptr<const SurfaceModel>> model_of;
  for (const PairDemand& demand : demands_) {
    core::Require(demand.a < demand.b && demand.b < parts_.size(), "pairs are of the layout's parts");
    for (const core::PartIndex part : {demand.a, demand.b}) model_of[layout.parts[part].mesh];
  }
  std::vector<std::pair<const core::SharedMesh, std::shared_ptr<const SurfaceModel>>*> models;
  for (auto& entry : model_of) models.push_back(&entry);
  tbb::parallel_for(std::size_t{0}, models.size(), [&](std::size_t i) {
    models[i]->second = std::make_shared<const SurfaceModel>(models[i]->first);
  });
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const auto model = model_of.find(layout.parts[i].mesh);
    if (model != model_of.end()) parts_[i].model = model->second;
    if (!uncertainty_mm.empty()) parts_[i].uncertainty_mm = uncertainty_mm[i];
    core::Require(parts_[i].uncertainty_mm >= 0.0, "an uncertainty is 0 mm or more");
  }
}

PairClash ClashChecker::Ask(const PairDemand& demand, const std::vector<Part>& parts, ClashCount& count) {
  const Part &a = parts[demand.a], &b = parts[demand.b];
  PairClash pair;
  pair.demand = demand;
  pair.uncertainty_mm = a.uncertainty_mm + b.uncertainty_mm;
  pair.deviation_mm = a.model->tree().mesh().deviation_mm + b.model->tree().mesh().deviation_mm;
  pair.at_least_mm = std::sqrt(a.bounds_in_world.squaredExteriorDistance(b.bounds_in_world));
  const auto is_clear = [&] {
    const double off_mm = pair.uncertainty_mm + pair.deviation_mm;
    return VerdictAt(pair.at_least_mm - off_mm, demand.required_mm) == core::Verdict::kClear;
  };
  std::optional<SurfacePair> surfaces;
  if (!is_clear()) {
    surfaces.emplace(*a.model, a.world_from_part, *b.model, b.world_from_part);
    pair.at_least_mm = std::max(pair.at_least_mm, surfaces->BoundsGapMm());
  }
  if (is_clear()) {
    ++count.settled_by_bounds;
    return pair;
  }
  if (pair.at_least_mm <= kTouchMm) {
    ++count.collision_calls;
    pair.gap = surfaces->FindIntersection();
    if (pair.gap && pair.gap->distance_mm > kTouchMm) pair.gap.reset();
  }
  if (!pair.gap) {
    ++count.distance_calls;
    pair.gap = surfaces->Measure();
  }
  pair.at_least_mm = pair.gap->distance_mm;
  pair.contained = pair.gap->distance_mm > kTouchMm &&
                   (HoldsAPiece(*a.model, a.world_from_part, *b.model, b.world_from_part) ||
                    HoldsAPiece(*b.model, b.world_from_part, *a.model, a.world_from_part));
  pair.verdict = VerdictOf(pair);
  return pair;
}

std::vector<ClashChecker::Motion> ClashChecker::Place(std::span<const core::RigidTransform> world_from_parts,
                                                      std::vector<Part>& parts) const {
  std::vector<Motion> motions(parts.size(), Motion::kTurned);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    Part& part = parts[i];
    if (has_checked_ && part.world_from_part.rotation == world_from_parts[i].rotation) {
      const bool stays = part.world_from_part == world_from_parts[i];
      motions[i] = stays ? Motion::kNone : Motion::kShifted;
      if (stays) return;
    }
    part.world_from_part = world_from_parts[i];
    if (!part.model) return;
    if (motions[i] == Motion::kTurned)
      part.turned_bounds = TurnedBounds(part.model->tree(), part.world_from_part.rotation);
    part.bounds_in_world =
        BoundsInWorld(part.model->tree(), part.turned_bounds, part.world_from_part.translation_mm);
  });
  return motions;
}

bool ClashChecker::MovedTogether(const Asked& asked, const Part& a, const Part& b) {
  const Vector3d before_mm = asked.b_in_world_mm - asked.a_in_world_mm;
  const Vector3d now_mm = b.world_from_part.translation_mm - a.world_from_part.translation_mm;
  const double size_mm =
      SizeOf(asked.a_in_world_mm, a.bounds_in_world) + SizeOf(asked.b_in_world_mm, b.bounds_in_world) +
      a.world_from_part.translation_mm.lpNorm<1>() + b.world_from_part.translation_mm.lpNorm<1>();
  return (now_mm - before_mm).lpNorm<Eigen::Infinity>() <= kShiftRounding * size_mm;
}

// The answer of each pair, its points where the parts are now.
std::vector<PairClash> ClashChecker::Answers() const {
  std::vector<PairClash> answers = last_;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!answers[i].gap) continue;
    const Vector3d by_mm = parts_[demands_[i].a].world_from_part.translation_mm - asked_[i].a_in_world_mm;
    answers[i].gap->on_a += by_mm;
    answers[i].gap->on_b += by_mm;
  }
  return answers;
}

ClashReport ClashChecker::Check(std::span<const core::RigidTransform> world_from_parts,
                                const core::Progress& progress, const std::stop_token& stop) {
  core::Require(world_from_parts.size() == parts_.size(), "one pose a part");
  std::vector<Part> parts = parts_;
  const std::vector<Motion> motions = Place(world_from_parts, parts);
  ClashReport report;
  report.count.pairs = static_cast<std::int64_t>(demands_.size());
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < demands_.size(); ++i) {
    const core::PartIndex a = demands_[i].a, b = demands_[i].b;
    if (motions[a] == Motion::kNone && motions[b] == Motion::kNone) {
      ++report.count.unchanged;
    } else if (motions[a] == Motion::kShifted && motions[b] == Motion::kShifted &&
               MovedTogether(asked_[i], parts[a], parts[b])) {
      ++report.count.moved_together;
    } else {
      changed.push_back(i);
    }
  }
  std::vector<PairClash> asked(changed.size());
  std::vector<ClashCount> counts(changed.size());
  for (std::size_t begin = 0; begin < changed.size(); begin += kBlock) {
    core::ThrowIfStopped(stop, "checking for clashes");
    const std::size_t end = std::min(begin + kBlock, changed.size());
    tbb::parallel_for(begin, end,
                      [&](std::size_t i) { asked[i] = Ask(demands_[changed[i]], parts, counts[i]); });
    progress.Report(static_cast<std::int64_t>(end), static_cast<std::int64_t>(changed.size()), "pairs");
  }
  for (const ClashCount& count : counts) report.count += count;
  parts_ = std::move(parts);
  has_checked_ = true;
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const PairDemand& demand = demands_[changed[i]];
    last_[changed[i]] = asked[i];
    asked_[changed[i]] = {parts_[demand.a].world_from_part.translation_mm,
                          parts_[demand.b].world_from_part.translation_mm};
  }
  report.pairs = Answers();
  return report;
}

}  // namespace elbowroom::review
