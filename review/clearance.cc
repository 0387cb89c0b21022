#include "review/clearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/infinity.h"
#include "core/part_distance.h"
#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull.h"
#include "review/inside_cells.h"

namespace elbowroom::review {
namespace {

using Cell = ClearanceCell;
using core::BoxInPart;
using core::NearestOnPart;
using core::NearStretch;
using Eigen::Vector3d;
using recon::BallAnswer;

using core::kInfinity;
// Rounding of distances, as a share of the coordinates' size.
constexpr double kClearanceRounding = 1e-12;
// Cells smaller than this share of the tolerance aren't divided.
constexpr double kSmallestCell = 1.0 / 64.0;
constexpr int kHalvings = 24;
constexpr int kMostSlides = 8;
// A hull point is slid along the hull while each slide lowers the upper bound by this share of the tolerance.
constexpr double kWorthwhile = 0.05;
// A cell is only cut if no more than this is left of its 2 half edges.
constexpr double kMostLeft = 1.6;
// Edges shorter than this share of the longest aren't divided.
constexpr double kFlat = 0.7;
// What distances to the part may be wrong by: this share of the tolerance, or of a large cell's half
// diagonal.
constexpr double kAllowedOfTolerance = 1.0 / 16.0;
constexpr double kAllowedOfCell = 1.0 / 20.0;

// Branch and bound: takes cells in order of their lower bounds, nearest first, and drops those without hull.
class Search {
 public:
  Search(const recon::VisualHull& hull, const core::TriangleTree& part,
         const core::RigidTransform& world_from_part, const ClearanceOptions& options, ReviewScratch* scratch)
      : hull_(hull),
        part_(part),
        world_from_part_(world_from_part),
        part_from_world_(world_from_part.Inverse()),
        options_(options),
        scratch_(*scratch) {
    cells_.clear();
    const Eigen::AlignedBox3d& box = hull.rig().workspace_mm;
    const double reach_mm = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm() +
                            part.nodes()[0].ball.radius_mm + part.nodes()[0].ball.center.norm() +
                            world_from_part.translation_mm.norm();
    slack_mm_ = kClearanceRounding * reach_mm;
  }

  Clearance Run(const std::optional<ClearanceHint>& hint) {
    if (hint) TryHint(*hint);
    const Eigen::AlignedBox3d& box = hull_.rig().workspace_mm;
    recon::UndecidedCameras all;
    Push(box.center(), 0.5 * box.sizes(), 0, &all);
    double lower_mm = kInfinity;
    while (!cells_.empty()) {
      const Cell cell = cells_.front();
      lower_mm = cell.lower_mm;
      if (IsSettled(lower_mm) || queries_ >= options_.max_queries) break;
      std::pop_heap(cells_.begin(), cells_.end());
      cells_.pop_back();
      lower_mm = kInfinity;
      if (!Divide(cell)) {
        lower_mm = cell.lower_mm;
        break;
      }
    }
    return Conclude(std::min({lower_mm, upper_mm_, passed_mm_}));
  }

 private:
  [[nodiscard]] bool IsSettled(double lower_mm) const {
    return lower_mm >= upper_mm_ - options_.tolerance_mm || lower_mm >= options_.enough_mm;
  }

  // Hull points at least this far from the part can't change the answer.
  [[nodiscard]] double FarEnoughMm() const {
    return std::min(upper_mm_ - options_.tolerance_mm + slack_mm_, options_.enough_mm);
  }

  NearestOnPart Nearest(const Vector3d& x_in_world, std::uint32_t likely, const Vector3d& half = {0, 0, 0}) {
    ++distances_;
    return FindNearest(part_, BoxOf(x_in_world, half), likely);
  }
  [[nodiscard]] BoxInPart BoxOf(const Vector3d& center, const Vector3d& half) const {
    return {part_from_world_ * center, part_from_world_.rotation * half.asDiagonal(),
            FarEnoughMm() + slack_mm_,
            std::max(kAllowedOfTolerance * options_.tolerance_mm, kAllowedOfCell * half.norm())};
  }
  [[nodiscard]] bool Contains(const Vector3d& x_in_world, const recon::UndecidedCameras& open = {}) {
    ++queries_;
    return hull_.Contains(x_in_world, open);
  }

  // Keeps the cell if it may hold a hull point that is nearer than the upper bound. A cell wholly inside the
  // hull is dropped after a slide from its centre to the part: if hull and part don't meet, the nearest hull
  // point is on the hull's surface, and if the part reaches into the cell, the slide finds that they meet.
  void Push(const Vector3d& center, const Vector3d& half, std::uint32_t likely,
            recon::UndecidedCameras* of_parent) {
    ++queries_;
    recon::UndecidedCameras open = *of_parent;
    const BallAnswer answer = hull_.Classify(center, half.norm(), &open);
    of_parent->likely = open.likely;
    if (answer == BallAnswer::kOutside) return;
    const NearestOnPart nearest = Nearest(center, likely, half);
    const double lower_mm = std::max(nearest.box_lower_mm - slack_mm_, 0.0);
    if (lower_mm >= upper_mm_) return;
    const bool is_inside = answer == BallAnswer::kInside;
    if (nearest.distance_mm < upper_mm_ && (is_inside || Contains(center, open))) Slide(center, nearest);
    if (is_inside) return;
    Cell cell{lower_mm, center, half, nearest.triangle, open};
    const Cut cut = CutOff(nearest, &cell);
    if (cut == Cut::kAll) return;
    ++queries_;
    switch (hull_.Classify(recon::WorldShape::Box(cell.center, cell.half.asDiagonal()), &cell.open)) {
      case BallAnswer::kOutside:
        return;
      case BallAnswer::kInside:
        if (cut == Cut::kSome) Slide(cell.center, Nearest(cell.center, cell.triangle));
        return;
      case BallAnswer::kMixed:
        cells_.push_back(cell);
        std::push_heap(cells_.begin(), cells_.end());
    }
  }

  enum class Cut { kNothing, kSome, kAll };

  // Cuts off the share of the cell that is far enough from the part, along the axis that leads away from the
  // part most, unless that share is small.
  Cut CutOff(const NearestOnPart& nearest, Cell* cell) {
    const double within_mm = FarEnoughMm();
    if (!(within_mm > 0.0 && within_mm < kInfinity && nearest.distance_mm > 0.0)) return Cut::kNothing;
    const Vector3d way = cell->center - world_from_part_ * nearest.position_in_part;
    Eigen::Index axis = 0;
    const double climb_mm = way.cwiseAbs().cwiseProduct(cell->half).maxCoeff(&axis) / nearest.distance_mm;
    if (nearest.distance_mm + climb_mm <= within_mm) return Cut::kNothing;  // the far end is near
    ++distances_;
    const NearStretch near = FindNearStretch(part_, BoxOf(cell->center, cell->half), axis,
                                             within_mm + slack_mm_, nearest.triangle, kMostLeft);
    if (near.length() > kMostLeft) return Cut::kNothing;
    passed_mm_ = std::min(passed_mm_, within_mm);
    ++cut_cells_;
    if (near.is_empty()) return Cut::kAll;
    cell->center[axis] += 0.5 * (near.from + near.to) * cell->half[axis];
    cell->half[axis] = 0.5 * (near.to - near.from) * cell->half[axis] + slack_mm_;
    return Cut::kSome;
  }

  // False if the cell is too small to be divided and the answer isn't settled.
  bool Divide(const Cell& cell) {
    if (cell.half.norm() < kSmallestCell * options_.tolerance_mm) {
      LookAcross(cell);
      return IsSettled(cell.lower_mm);
    }
    // Edges that are already short aren't halved, so that flat cells don't get flatter.
    Vector3d half = cell.half;
    const double longest_mm = half.maxCoeff();
    std::array<int, 3> parts{};
    for (Eigen::Index i = 0; i < 3; ++i) {
      const bool is_cut = half[i] > kFlat * longest_mm;
      parts[static_cast<std::size_t>(i)] = is_cut ? 2 : 1;
      if (is_cut) half[i] *= 0.5;
    }
    const Vector3d first = cell.center - cell.half + half;
    recon::UndecidedCameras open = cell.open;
    for (int z = 0; z < parts[2]; ++z)
      for (int y = 0; y < parts[1]; ++y)
        for (int x = 0; x < parts[0]; ++x)
          Push(first + 2.0 * half.cwiseProduct(Vector3d(x, y, z)), half, cell.triangle, &open);
    return true;
  }

  // Lowers the upper bound: goes from a hull point straight towards the part's nearest point, to the last
  // point found in the hull, and again from there, for as long as that helps.
  void Slide(Vector3d x_in_world, NearestOnPart nearest) {
    for (int slide = 0; slide < kMostSlides; ++slide) {
      const double before_mm = upper_mm_;
      const Vector3d p_in_world = world_from_part_ * nearest.position_in_part;
      x_in_world = LastInside(x_in_world, p_in_world);
      nearest = Nearest(x_in_world, nearest.triangle);
      Offer(x_in_world, nearest);
      if (upper_mm_ == 0.0 || !(upper_mm_ < before_mm - kWorthwhile * options_.tolerance_mm)) return;
    }
  }

  // A hull point between `inside` and `end` that is next to a point outside, by bisection; `end` itself if
  // that is in the hull.
  Vector3d LastInside(Vector3d inside, const Vector3d& end) {
    if (Contains(end)) return end;
    Vector3d outside = end;
    for (int i = 0; i < kHalvings && (outside - inside).norm() > kSmallestCell * options_.tolerance_mm; ++i) {
      const Vector3d middle = 0.5 * (inside + outside);
      (Contains(middle) ? inside : outside) = middle;
    }
    return inside;
  }

  void Offer(const Vector3d& x_in_world, const NearestOnPart& nearest) {
    if (nearest.distance_mm + slack_mm_ >= upper_mm_) return;
    upper_mm_ = nearest.distance_mm <= slack_mm_ ? 0.0 : nearest.distance_mm + slack_mm_;
    witness_hull_in_world_ = x_in_world;
    witness_part_in_world_ = world_from_part_ * nearest.position_in_part;
  }

  // Asks the contours themselves along a ray from the part through the cell: that finds hull which is too
  // thin to hold a cell's centre.
  void LookAcross(const Cell& cell) {
    const NearestOnPart nearest = Nearest(cell.center, cell.triangle);
    const Vector3d p_in_world = world_from_part_ * nearest.position_in_part;
    const double distance_mm = (cell.center - p_in_world).norm();
    if (!(distance_mm > 0.0)) return;
    const recon::Ray ray{p_in_world, (cell.center - p_in_world) / distance_mm};
    ++queries_;
    const std::optional<double> first_mm =
        recon::FirstInside(hull_, ray, {0.0, distance_mm + cell.half.norm()}, &scratch_.crossings);
    if (!first_mm) return;
    const Vector3d x_in_world = p_in_world + *first_mm * ray.direction_in_world;
    Offer(x_in_world, Nearest(x_in_world, nearest.triangle));
  }

  void TryHint(const ClearanceHint& hint) {
    const Vector3d p_in_world = world_from_part_ * hint.witness_part_in_part;
    const Vector3d way = hint.witness_hull_in_world - p_in_world;
    if (!(way.norm() > 0.0)) return;
    ++queries_;
    const recon::Ray ray{p_in_world, way.normalized()};
    const std::optional<double> first_mm = recon::FirstInside(hull_, ray, {}, &scratch_.crossings);
    if (!first_mm) return;
    const Vector3d x_in_world = p_in_world + *first_mm * ray.direction_in_world;
    const NearestOnPart nearest = Nearest(x_in_world, 0);
    Offer(x_in_world, nearest);
  }

  Clearance Conclude(double lower_mm) {
    Clearance result;
    result.has_witnesses = upper_mm_ < kInfinity;
    if (result.has_witnesses && part_.is_closed() &&
        IsInsideClosedMesh(part_, part_from_world_ * witness_hull_in_world_)) {
      upper_mm_ = 0.0;
      witness_part_in_world_ = witness_hull_in_world_;
    }
    result.interval = {std::min(lower_mm, upper_mm_), upper_mm_, witness_part_in_world_,
                       witness_hull_in_world_};
    result.meets = upper_mm_ == 0.0;
    result.queries = queries_;
    result.distances = distances_;
    result.cells_left = static_cast<std::int64_t>(cells_.size());
    result.cut_cells = cut_cells_;
    return result;
  }

  const recon::VisualHull& hull_;
  const core::TriangleTree& part_;
  const core::RigidTransform& world_from_part_;
  const core::RigidTransform part_from_world_;
  const ClearanceOptions& options_;
  double slack_mm_ = 0.0;
  ReviewScratch& scratch_;
  std::vector<Cell>& cells_ = scratch_.cells;  // a heap
  double upper_mm_ = kInfinity;
  double passed_mm_ = kInfinity;  // what was cut off cells is at least this far away
  Vector3d witness_hull_in_world_ = Vector3d::Zero();
  Vector3d witness_part_in_world_ = Vector3d::Zero();
  std::int64_t queries_ = 0;
  std::int64_t distances_ = 0;
  std::int64_t cut_cells_ = 0;
};

// Turns bounds of the distance to the mesh into bounds of the distance to the surface that it approximates.
Clearance WithDeviation(Clearance clearance, double deviation_mm) {
  core::ClearanceInterval& interval = clearance.interval;
  interval.lower_mm = std::max(interval.lower_mm - deviation_mm, 0.0);
  interval.upper_mm += deviation_mm;
  return clearance;
}

}  // namespace

void ClearanceOptions::Validate() const {
  const auto require = [](bool holds, auto what, const auto& value) {
    if (!holds)
      throw core::Error(core::ErrorKind::kRange,
                        fmt::format("clearance: {}", fmt::format(fmt::runtime(what), value)));
  };
  require(tolerance_mm > 0.0 && std::isfinite(tolerance_mm), "tolerance must be positive, not {} mm",
          tolerance_mm);
  require(enough_mm > 0.0, "enough must be positive, not {} mm", enough_mm);
  require(max_queries > 0, "at least one query must be allowed, not {}", max_queries);
}

Clearance FindClearance(const recon::VisualHull& hull, const core::TriangleTree& part,
                        const core::RigidTransform& world_from_part, const ClearanceOptions& options,
                        const std::optional<ClearanceHint>& hint, ReviewScratch* scratch) {
  if (scratch == nullptr) {
    ReviewScratch own;
    return FindClearance(hull, part, world_from_part, options, hint, &own);
  }
  options.Validate();
  Clearance nothing;
  nothing.interval.lower_mm = kInfinity;
  if (part.nodes().empty() || hull.IsEmpty()) return nothing;
  const double deviation_mm = part.mesh().deviation_mm;
  ClearanceOptions of_mesh = options;
  of_mesh.enough_mm += deviation_mm;
  if (std::isfinite(of_mesh.enough_mm)) {
    const core::Ball& ball = part.nodes()[0].ball;
    nothing.queries = 1;
    if (hull.Classify(world_from_part * ball.center, ball.radius_mm + of_mesh.enough_mm) ==
        BallAnswer::kOutside) {
      nothing.interval.lower_mm = options.enough_mm;
      return nothing;
    }
  }
  return WithDeviation(Search(hull, part, world_from_part, of_mesh, scratch).Run(hint), deviation_mm);
}

core::Verdict Judge(const Clearance& clearance, double required_mm, double uncertainty_mm) {
  const core::ClearanceInterval& interval = clearance.interval;
  if (clearance.meets) return core::Verdict::kContact;
  if (interval.lower_mm - uncertainty_mm >= required_mm) return core::Verdict::kClear;
  if (interval.upper_mm + uncertainty_mm < required_mm) return core::Verdict::kNear;
  return core::Verdict::kUndecided;
}

}  // namespace elbowroom::review
