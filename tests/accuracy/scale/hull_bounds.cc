#include "tests/accuracy/scale/hull_bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "app/control/demo_parts.h"
#include "app/control/sweep/kept_hulls.h"
#include "app/control/sweep/sweep_frames.h"
#include "core/bvh.h"
#include "core/error.h"
#include "recon/contours/contour_map.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"
#include "review/clearance.h"
#include "sessions/session_reader.h"
#include "tests/accuracy/quantile.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr std::size_t kMostSessions = 4;
constexpr std::size_t kFramesACell = 256;  // as a sweep's
// What a clearance of 15 mm needs at most to be sure: the search's tolerance beside it.
constexpr double kEnoughMm = 16.0;

double MsSince(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

class BoundMaker {
 public:
  BoundMaker(const recon::VisualHull& hull, double edge_mm) : hull_(hull), edge_mm_(edge_mm) {}

  HullBound Make() {
    const AlignedBox3d& space = hull_.rig().workspace_mm;
    Split(space.center(), 0.5 * space.sizes(), {});
    return std::move(bound_);
  }

 private:
  void Split(const Vector3d& center, const Vector3d& half, recon::UndecidedCameras open) {
    ++bound_.nodes;
    recon::BallAnswer answer = hull_.Classify(center, half.norm(), &open);
    const bool is_leaf = 2.0 * half.maxCoeff() <= edge_mm_;
    if (answer == recon::BallAnswer::kMixed && is_leaf)
      answer = hull_.Classify(recon::WorldShape::Box(center, half.asDiagonal()), &open);
    if (answer == recon::BallAnswer::kOutside) return;
    if (answer == recon::BallAnswer::kInside || is_leaf) {
      bound_.boxes.emplace_back(center - half, center + half);
      return;
    }
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d side((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                          (corner & 4) != 0 ? 0.5 : -0.5);
      Split(center + side.cwiseProduct(half), 0.5 * half, open);
    }
  }

  const recon::VisualHull& hull_;
  const double edge_mm_;
  HullBound bound_;
};

struct Costs {
  std::vector<double> load_ms, make_ms, bound_32_ms, bound_16_ms, keep_ms, take_ms, map_bytes, packed_bytes,
      bound_32_bytes, bound_16_bytes;

  // As control::KeptHulls keeps and takes them, but for the files.
  void AddMaps(const recon::VisualHull& hull) {
    double keeping_ms = 0.0, taking_ms = 0.0, of_maps = 0.0, of_packed = 0.0;
    for (const auto& silhouette : hull.silhouettes()) {
      auto begin = Clock::now();
      const std::string packed = control::Packed(silhouette->labels());
      keeping_ms += MsSince(begin);
      begin = Clock::now();
      const auto map = control::Unpacked(packed);
      taking_ms += MsSince(begin);
      const std::string bytes = silhouette->labels().Bytes();
      core::Require(map && map->Bytes() == bytes, "a map comes back as it was");
      of_maps += static_cast<double>(bytes.size());
      of_packed += static_cast<double>(packed.size());
    }
    keep_ms.push_back(keeping_ms);
    take_ms.push_back(taking_ms);
    map_bytes.push_back(of_maps);
    packed_bytes.push_back(of_packed);
  }
};

// A bracket that is added to a layout, and where it stands.
struct Bracket {
  std::string where;
  Vector3d size_mm;
  Vector3d foot_in_world_mm;  // of the middle of its underside, at a gap of 0 if it moves
  bool moves = false;         // with payload A
};

std::vector<Bracket> Brackets() {
  using control::kPmtHeightMm;
  const Vector3d small(60.0, 40.0, 20.0), rib(300.0, 6.0, 30.0), cover(120.0, 120.0, 60.0);
  return {{"small, below payload A, over the well", small, {0.0, 0.0, kPmtHeightMm - 20.0}, true},
          {"small, below a corner of payload A", small, {-120.0, 120.0, kPmtHeightMm - 20.0}, true},
          {"small, on the rim of payload A", small, {140.0, 0.0, kPmtHeightMm + 10.0}, true},
          {"a rib along payload A's edge", rib, {0.0, -157.0, kPmtHeightMm - 30.0}, true},
          {"small, on the PMT box's side", small, {180.0, 0.0, 40.0}},
          {"a cover on top of payload A", cover, {0.0, 0.0, kPmtHeightMm + 160.0}, true},
          {"a cover beside payload B", cover, {-430.0, 0.0, 0.0}}};
}

// A frame's distances from a bracket at each gap: certain ones of its hull, and lower bounds by its bounds.
struct Distances {
  std::vector<double> lower_mm, upper_mm, by_box_mm, by_32_mm, by_16_mm;
};

struct BoundedFrame {
  std::shared_ptr<const recon::VisualHull> hull;
  HullBound bound_32, bound_16;
};

Distances DistancesOf(const BoundedFrame& frame, const Bracket& bracket, const core::TriangleTree& tree,
                      std::span<const double> gaps_mm) {
  Distances distances;
  HullBound around;
  if (!frame.bound_32.boxes.empty()) around.boxes = {frame.bound_32.Around()};
  for (const double gap_mm : gaps_mm) {
    core::RigidTransform world_from_part;
    world_from_part.translation_mm =
        bracket.foot_in_world_mm + (bracket.moves ? gap_mm : 0.0) * Vector3d::UnitZ();
    const review::Clearance clearance = review::FindClearance(*frame.hull, tree, world_from_part);
    distances.lower_mm.push_back(clearance.interval.lower_mm);
    distances.upper_mm.push_back(clearance.interval.upper_mm);
    const Vector3d half(0.5 * bracket.size_mm.x(), 0.5 * bracket.size_mm.y(), 0.0);
    const AlignedBox3d box(world_from_part.translation_mm - half,
                           world_from_part.translation_mm + half + bracket.size_mm.z() * Vector3d::UnitZ());
    distances.by_box_mm.push_back(around.DistanceMm(box));
    distances.by_32_mm.push_back(frame.bound_32.DistanceMm(box));
    distances.by_16_mm.push_back(frame.bound_16.DistanceMm(box));
  }
  return distances;
}

// How many hulls a study needs that goes through the frames in their order, and leaves out those whose lower
// bounds show at every gap that neither the verdict nor the least distance can change.
std::int64_t HullsNeeded(std::span<const Distances> frames, std::vector<double> Distances::*bound) {
  std::int64_t needed = 0;
  std::vector<double> least_mm;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Distances& frame = frames[i];
    if (i % kFramesACell == 0)
      least_mm.assign(frame.lower_mm.size(), std::numeric_limits<double>::infinity());
    bool is_needed = false;
    for (std::size_t gap = 0; gap < least_mm.size(); ++gap)
      is_needed = is_needed || (frame.*bound)[gap] < std::max(kEnoughMm, least_mm[gap]);
    if (!is_needed) continue;
    ++needed;
    for (std::size_t gap = 0; gap < least_mm.size(); ++gap)
      least_mm[gap] = std::min(least_mm[gap], frame.upper_mm[gap]);
  }
  return needed;
}

class BoundMeasurement {
 public:
  void AddSession(const fs::path& path) {
    sessions::SessionReader session(path);
    session.Freeze();
    const control::SweepFrames frames = control::SweepFramesOf(session);
    control::SweepFrameLoader loader(session, frames);
    std::vector<BoundedFrame> bounded;
    for (std::size_t i = 0; i < frames.frames.size(); ++i) {
      auto begin = Clock::now();
      BoundedFrame frame{loader.Load(i).hull, {}, {}};
      costs_.load_ms.push_back(MsSince(begin));
      begin = Clock::now();
      frame.hull->Prepare();
      costs_.make_ms.push_back(MsSince(begin));
      begin = Clock::now();
      frame.bound_32 = BoundOf(*frame.hull, 32.0);
      costs_.bound_32_ms.push_back(MsSince(begin));
      begin = Clock::now();
      frame.bound_16 = BoundOf(*frame.hull, 16.0);
      costs_.bound_16_ms.push_back(MsSince(begin));
      costs_.bound_32_bytes.push_back(static_cast<double>(frame.bound_32.bytes()));
      costs_.bound_16_bytes.push_back(static_cast<double>(frame.bound_16.bytes()));
      if (!frame.hull->IsEmpty()) costs_.AddMaps(*frame.hull);
      AddDistances(frame);
    }
    frames_ += std::ssize(frames.frames);
    stretches_.emplace_back(distances_.size());
    std::swap(stretches_.back(), distances_);
    distances_.assign(brackets_.size(), {});
  }

  [[nodiscard]] reporting::Table CostTable() const {
    const auto row = [](const std::string& what, const std::vector<double>& ms,
                        const std::vector<double>& bytes) {
      return std::vector<std::string>{
          what, fmt::format("{:.2f}", Quantile(ms, 0.5)), fmt::format("{:.2f}", Quantile(ms, 0.9)),
          bytes.empty() ? "-" : reporting::ThreeDigits(1e-3 * Quantile(bytes, 0.5))};
    };
    return {{"one core", "ms a frame", "90 %", "kB a frame"},
            {row("silhouettes read from the session", costs_.load_ms, {}),
             row("a hull's contours and grids made", costs_.make_ms, {}),
             row("as bytes, and packed", costs_.keep_ms, costs_.map_bytes),
             row("taken from the packed bytes", costs_.take_ms, costs_.packed_bytes),
             row("boxes around it, edges up to 32 mm", costs_.bound_32_ms, costs_.bound_32_bytes),
             row("boxes around it, edges up to 16 mm", costs_.bound_16_ms, costs_.bound_16_bytes)}};
  }

  [[nodiscard]] reporting::Table BracketTable() const {
    reporting::Table table{{"a bracket that is new", "frames", "touched or nearer than required, at some gap",
                            "hulls needed by one box", "boxes of 32 mm", "of 16 mm", "exact distances"},
                           {}};
    for (std::size_t k = 0; k < brackets_.size(); ++k) {
      std::array<std::int64_t, 4> needed = {};
      std::int64_t near = 0;
      for (const auto& stretch : stretches_) {
        const std::array bounds{&Distances::by_box_mm, &Distances::by_32_mm, &Distances::by_16_mm,
                                &Distances::lower_mm};
        for (std::size_t i = 0; i < bounds.size(); ++i) needed.at(i) += HullsNeeded(stretch[k], bounds.at(i));
        near += std::ranges::count_if(stretch[k], [](const Distances& frame) {
          return std::ranges::any_of(frame.lower_mm, [](double mm) { return mm < kEnoughMm; });
        });
      }
      const auto share = [&](std::int64_t count) {
        return fmt::format("{} ({:.0f} %)", count,
                           100.0 * static_cast<double>(count) / static_cast<double>(frames_));
      };
      table.rows.push_back({brackets_[k].where, std::to_string(frames_), share(near), share(needed[0]),
                            share(needed[1]), share(needed[2]), share(needed[3])});
    }
    return table;
  }

 private:
  void AddDistances(const BoundedFrame& frame) {
    for (std::size_t k = 0; k < brackets_.size(); ++k)
      distances_[k].push_back(DistancesOf(frame, brackets_[k], trees_[k], gaps_mm_));
  }

  [[nodiscard]] static core::TriangleTree TreeOf(const Bracket& bracket) {
    const std::array rings{
        control::RectangleRing(bracket.size_mm.x(), bracket.size_mm.y(), 0.0),
        control::RectangleRing(bracket.size_mm.x(), bracket.size_mm.y(), bracket.size_mm.z())};
    return core::TriangleTree(std::make_shared<const core::TriangleMesh>(control::MeshThrough(rings)));
  }

  const std::vector<Bracket> brackets_ = Brackets();
  const std::vector<core::TriangleTree> trees_ = [this] {
    std::vector<core::TriangleTree> trees;
    for (const Bracket& bracket : brackets_) trees.push_back(TreeOf(bracket));
    return trees;
  }();
  const std::vector<double> gaps_mm_{120.0, 160.0, 200.0, 240.0, 280.0, 320.0, 360.0, 400.0};
  Costs costs_;
  std::int64_t frames_ = 0;
  std::vector<std::vector<Distances>> distances_{brackets_.size()};  // of this session, by bracket
  std::vector<std::vector<std::vector<Distances>>> stretches_;       // of each session
};

}  // namespace

AlignedBox3d HullBound::Around() const {
  AlignedBox3d around;
  for (const AlignedBox3d& box : boxes) around.extend(box);
  return around;
}

double HullBound::DistanceMm(const AlignedBox3d& to_mm) const {
  double least_mm = std::numeric_limits<double>::infinity();
  for (const AlignedBox3d& box : boxes) least_mm = std::min(least_mm, box.exteriorDistance(to_mm));
  return least_mm;
}

HullBound BoundOf(const recon::VisualHull& hull, double edge_mm) { return BoundMaker(hull, edge_mm).Make(); }

void MeasureHullBounds(const fs::path& docs, const SimulatedCohort& cohort) {
  BoundMeasurement measurement;
  for (std::size_t i = 0; i < std::min(kMostSessions, cohort.sessions.size()); ++i) {
    fmt::print(stderr, "scale: bounds of the hulls of {}\n", cohort.sessions[i].string());
    measurement.AddSession(cohort.sessions[i]);
  }
  const std::string machine = reporting::ToLine(reporting::ThisMachine(docs / ".."));
  reporting::WriteSection(docs / "scale.md", "hulls",
                          reporting::ToMarkdown(measurement.CostTable()) + "\n" + machine);
  reporting::WriteSection(docs / "scale.md", "hull_bounds",
                          reporting::ToMarkdown(measurement.BracketTable()) + "\n" + machine);
}

}  // namespace elbowroom::accuracy
