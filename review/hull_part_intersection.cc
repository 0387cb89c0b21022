#include "review/hull_part_intersection.h"

#include <Eigen/Geometry>
#include <cmath>
#include <deque>

#include "core/part_distance.h"
#include "recon/hull/visual_hull.h"
#include "review/inside_cells.h"
#include "review/triangle_bisection.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using recon::BallAnswer;
using enum HullPartIntersection::Answer;

// A box's ball is this much larger than its half diagonal, for rounding.
constexpr double kReachOutwards = 1.0 + 1e-12;
// The search ends after this many undecided pieces, with the answer kOpen.
constexpr int kMostOpen = 64;

// Breadth first, from coarse to fine: a common point mostly shows in coarse pieces, while next to the hull's
// surface pieces are divided down to the smallest size.
class MeetingSearch {
 public:
  MeetingSearch(const recon::VisualHull& hull, const core::TriangleTree& part,
                const core::RigidTransform& world_from_part, double smallest_mm, std::int64_t* queries)
      : hull_(hull),
        part_(part),
        world_from_part_(world_from_part),
        smallest_mm_(smallest_mm),
        queries_(queries) {}

  [[nodiscard]] HullPartIntersection OfSurface() {
    if (VisitNode(0, {})) return meeting_;
    for (; !triangles_.empty(); triangles_.pop_front())
      if (VisitTriangle(triangles_.front())) return meeting_;
    return {open_ > 0 ? kOpen : kApart};
  }

  // Looks for hull inside the closed part. The part's surface is known to be apart from the hull.
  [[nodiscard]] HullPartIntersection OfInside() {
    cells_.push_back({part_.bounds(), {}});
    for (; !cells_.empty(); cells_.pop_front())
      if (VisitCell(cells_.front())) return meeting_;
    return {open_ > 0 ? kOpen : kApart};
  }

 private:
  struct Piece {
    Corners corners;  // in world
    recon::UndecidedCameras open;
  };
  struct Cell {
    Eigen::AlignedBox3d box_in_part;
    recon::UndecidedCameras open;
  };

  BallAnswer Ask(const core::Ball& ball, recon::UndecidedCameras* open) {
    ++*queries_;
    return hull_.Classify(ball.center, ball.radius_mm, open);
  }

  [[nodiscard]] Corners CornersOf(std::uint32_t triangle) const {
    const auto& [a, b, c] = part_.mesh().triangles[triangle];
    const auto vertex = [&](std::int32_t i) {
      return world_from_part_ * part_.mesh().vertices_mm[static_cast<std::size_t>(i)];
    };
    return {vertex(a), vertex(b), vertex(c)};
  }

  // These return true if the search ends, with meeting_ as its result.
  bool End(const Vector3d& common_in_world) {
    meeting_ = {kIntersects, common_in_world};
    return true;
  }
  bool LeaveOpen() { return ++open_ >= kMostOpen; }

  bool VisitNode(std::uint32_t index, recon::UndecidedCameras open) {
    const core::TriangleTree::Node& node = part_.nodes()[index];
    const BallAnswer answer = Ask({world_from_part_ * node.ball.center, node.ball.radius_mm}, &open);
    if (answer == BallAnswer::kOutside) return false;
    if (answer == BallAnswer::kInside) return End(CornersOf(part_.order()[node.begin]).a);
    if (node.left != 0) return VisitNode(node.left, open) || VisitNode(node.left + 1, open);
    for (std::uint32_t i = node.begin; i < node.end; ++i)
      triangles_.push_back({CornersOf(part_.order()[i]), open});
    return false;
  }

  bool VisitTriangle(Piece piece) {
    const Corners& corners = piece.corners;
    const core::Ball ball = core::BallOf(corners.a, corners.b, corners.c);
    const BallAnswer answer = Ask(ball, &piece.open);
    if (answer == BallAnswer::kOutside) return false;
    const Vector3d middle = (corners.a + corners.b + corners.c) / 3.0;
    if (answer == BallAnswer::kInside || hull_.Contains(middle, piece.open)) return End(middle);
    if (2.0 * ball.radius_mm <= smallest_mm_) return LeaveOpen();
    const auto [first, second] = Bisect(corners);
    triangles_.push_back({first, piece.open});
    triangles_.push_back({second, piece.open});
    return false;
  }

  bool VisitCell(Cell cell) {
    const Vector3d center = cell.box_in_part.center(), center_in_world = world_from_part_ * center;
    const double radius_mm = 0.5 * cell.box_in_part.diagonal().norm() * kReachOutwards;
    if (Ask({center_in_world, radius_mm}, &cell.open) == BallAnswer::kOutside) return false;
    const bool is_inside = IsInsideClosedMesh(part_, center);
    if (is_inside && hull_.Contains(center_in_world, cell.open)) return End(center_in_world);
    if (!is_inside && FindNearest(part_, {center}).distance_mm > radius_mm) return false;
    if (2.0 * radius_mm <= smallest_mm_) return LeaveOpen();
    for (int child = 0; child < 8; ++child) {
      const Vector3d corner = cell.box_in_part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(child));
      cells_.push_back({{corner.cwiseMin(center), corner.cwiseMax(center)}, cell.open});
    }
    return false;
  }

  const recon::VisualHull& hull_;
  const core::TriangleTree& part_;
  const core::RigidTransform& world_from_part_;
  double smallest_mm_;
  std::int64_t* queries_;
  std::deque<Piece> triangles_;
  std::deque<Cell> cells_;
  int open_ = 0;
  HullPartIntersection meeting_;  // kOpen, until a common point is found
};

}  // namespace

HullPartIntersection FindHullPartIntersection(const recon::VisualHull& hull, const core::TriangleTree& part,
                                              const core::RigidTransform& world_from_part, double smallest_mm,
                                              std::int64_t* queries) {
  if (hull.IsEmpty()) return {kApart};
  MeetingSearch search(hull, part, world_from_part, smallest_mm, queries);
  ++*queries;
  const core::Ball& ball = part.nodes()[0].ball;
  if (hull.Classify(world_from_part * ball.center, ball.radius_mm) == BallAnswer::kOutside) return {kApart};
  HullPartIntersection of_surface = search.OfSurface();
  return of_surface.answer == kApart && part.is_closed() ? search.OfInside() : of_surface;
}

}  // namespace elbowroom::review
