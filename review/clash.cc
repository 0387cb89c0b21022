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

AlignedBox3d BoundsInWorld(const core::TriangleTree& tree, const core::RigidTransform& world_from_part) {
  AlignedBox3d box;
  for (const auto& triangle : tree.mesh().triangles) {
    for (const std::int32_t i : triangle)
      box.extend(world_from_part * tree.mesh().vertices_mm[static_cast<std::size_t>(i)]);
  }
  const double size_mm = tree.bounds().min().cwiseAbs().sum() + tree.bounds().max().cwiseAbs().sum() +
                         world_from_part.translation_mm.cwiseAbs().sum();
  const Vector3d margin_mm = Vector3d::Constant(kDistanceRounding * size_mm);
  return {box.min() - margin_mm, box.max() + margin_mm};
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

ClashCount Sum(const std::vector<ClashCount>& counts) {
  ClashCount sum;
  for (const ClashCount& count : counts) {
    sum.settled_by_bounds += count.settled_by_bounds;
    sum.collision_calls += count.collision_calls;
    sum.distance_calls += count.distance_calls;
  }
  return sum;
}

}  // namespace

ClashChecker::ClashChecker(const core::Layout& layout, std::vector<PairDemand> pairs,
                           std::vector<double> uncertainty_mm)
    : demands_(std::move(pairs)), parts_(layout.parts.size()), last_(demands_.size()) {
  core::Require(uncertainty_mm.empty() || uncertainty_mm.size() == parts_.size(), "one uncertainty a part");
  std::map<core::SharedMesh, std::shared_ptr<const SurfaceModel>> model_of;
  for (const core::Part& part : layout.parts) model_of[part.mesh];
  std::vector<std::pair<const core::SharedMesh, std::shared_ptr<const SurfaceModel>>*> models;
  for (auto& entry : model_of) models.push_back(&entry);
  tbb::parallel_for(std::size_t{0}, models.size(), [&](std::size_t i) {
    models[i]->second = std::make_shared<const SurfaceModel>(models[i]->first);
  });
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    parts_[i].model = model_of.at(layout.parts[i].mesh);
    if (!uncertainty_mm.empty()) parts_[i].uncertainty_mm = uncertainty_mm[i];
    core::Require(parts_[i].uncertainty_mm >= 0.0, "an uncertainty is 0 mm or more");
  }
  for (const PairDemand& demand : demands_)
    core::Require(demand.a < demand.b && demand.b < parts_.size(), "pairs are of the layout's parts");
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

std::vector<bool> ClashChecker::Place(std::span<const core::RigidTransform> world_from_parts,
                                      std::vector<Part>& parts) const {
  std::vector<bool> has_moved(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i)
    has_moved[i] = !has_checked_ || !(parts[i].world_from_part == world_from_parts[i]);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    if (!has_moved[i]) return;
    parts[i].world_from_part = world_from_parts[i];
    parts[i].bounds_in_world = BoundsInWorld(parts[i].model->tree(), world_from_parts[i]);
  });
  return has_moved;
}

ClashReport ClashChecker::Check(std::span<const core::RigidTransform> world_from_parts,
                                const core::Progress& progress, const std::stop_token& stop) {
  core::Require(world_from_parts.size() == parts_.size(), "one pose a part");
  std::vector<Part> parts = parts_;
  const std::vector<bool> has_moved = Place(world_from_parts, parts);
  ClashReport report;
  report.pairs = last_;
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < demands_.size(); ++i)
    if (has_moved[demands_[i].a] || has_moved[demands_[i].b]) changed.push_back(i);
  std::vector<ClashCount> counts(changed.size());
  for (std::size_t begin = 0; begin < changed.size(); begin += kBlock) {
    core::ThrowIfStopped(stop, "checking for clashes");
    const std::size_t end = std::min(begin + kBlock, changed.size());
    tbb::parallel_for(begin, end, [&](std::size_t i) {
      report.pairs[changed[i]] = Ask(demands_[changed[i]], parts, counts[i]);
    });
    progress.Report(static_cast<std::int64_t>(end), static_cast<std::int64_t>(changed.size()), "pairs");
  }
  report.count = Sum(counts);
  report.count.pairs = static_cast<std::int64_t>(demands_.size());
  report.count.unchanged = report.count.pairs - static_cast<std::int64_t>(changed.size());
  parts_ = std::move(parts);
  last_ = report.pairs;
  has_checked_ = true;
  return report;
}

}  // namespace elbowroom::review
