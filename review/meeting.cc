#include "review/meeting.h"

#include <Eigen/Geometry>
#include <cmath>

#include "review/containment.h"
#include "review/longest_side.h"
#include "review/part_distance.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using recon::BallAnswer;
using enum Meeting::Answer;

// A box's ball is this much larger than its half diagonal, for rounding.
constexpr double kOutwards = 1.0 + 1e-12;
// After so many undecided pieces it won't become certain that the part is apart; it may still meet.
constexpr int kMostOpen = 64;

class MeetingSearch {
 public:
  MeetingSearch(const recon::VisualHull& hull, const core::TriangleTree& part,
                const core::RigidTransform& world_from_part, double smallest_mm, std::int64_t* queries)
      : hull_(hull),
        part_(part),
        world_from_part_(world_from_part),
        smallest_mm_(smallest_mm),
        queries_(queries) {}

  // Nothing: no common point was found, and apart if no piece is open.
  [[nodiscard]] std::optional<Meeting> VisitNode(std::uint32_t index, recon::OpenCameras open) {
    const core::TriangleTree::Node& node = part_.nodes()[index];
    const BallAnswer answer = Ask({world_from_part_ * node.ball.center, node.ball.radius_mm}, &open);
    if (answer == BallAnswer::kOutside) return std::nullopt;
    if (answer == BallAnswer::kInside) return OnFace(CornersOf(part_.order()[node.begin]).a);
    if (node.left != 0) {
      if (const std::optional<Meeting> meeting = VisitNode(node.left, open)) return meeting;
      return VisitNode(node.left + 1, open);
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      if (const std::optional<Meeting> meeting = VisitTriangle(CornersOf(part_.order()[i]), open))
        return meeting;
    }
    return std::nullopt;
  }

  // What of the hull is inside the closed part, whose surface is apart from it.
  [[nodiscard]] std::optional<Meeting> VisitCell(const Eigen::AlignedBox3d& cell_in_part,
                                                 recon::OpenCameras open) {
    const Vector3d center = cell_in_part.center(), center_in_world = world_from_part_ * center;
    const double radius_mm = 0.5 * cell_in_part.diagonal().norm() * kOutwards;
    if (Ask({center_in_world, radius_mm}, &open) == BallAnswer::kOutside) return std::nullopt;
    const bool is_inside = IsInsideClosedMesh(part_, center);
    if (is_inside && hull_.Contains(center_in_world, open)) return Meeting{kMeets, center_in_world, false};
    const bool is_on_one_side = FindNearest(part_, {center}).distance_mm > radius_mm;
    if (is_on_one_side && !is_inside) return std::nullopt;
    if (2.0 * radius_mm <= smallest_mm_) return LeaveOpen();
    for (int child = 0; child < 8; ++child) {
      const Vector3d corner = cell_in_part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(child));
      const Eigen::AlignedBox3d eighth(corner.cwiseMin(center), corner.cwiseMax(center));
      if (const std::optional<Meeting> meeting = VisitCell(eighth, open)) return meeting;
    }
    return std::nullopt;
  }

  [[nodiscard]] bool is_open() const { return open_ > 0; }

 private:
  std::optional<Meeting> LeaveOpen() {
    if (++open_ < kMostOpen) return std::nullopt;
    return Meeting{};
  }

  BallAnswer Ask(const core::Ball& ball, recon::OpenCameras* open) const {
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

  static Meeting OnFace(const Vector3d& x_in_world) { return {kMeets, x_in_world, true}; }

  [[nodiscard]] std::optional<Meeting> VisitTriangle(const Corners& corners, recon::OpenCameras open) {
    const core::Ball ball = core::BallOf(corners.a, corners.b, corners.c);
    const BallAnswer answer = Ask(ball, &open);
    if (answer == BallAnswer::kOutside) return std::nullopt;
    const Vector3d middle = (corners.a + corners.b + corners.c) / 3.0;
    if (answer == BallAnswer::kInside || hull_.Contains(middle, open)) return OnFace(middle);
    if (2.0 * ball.radius_mm <= smallest_mm_) return LeaveOpen();
    const auto [first, second] = Halve(corners);
    if (const std::optional<Meeting> meeting = VisitTriangle(first, open)) return meeting;
    return VisitTriangle(second, open);
  }

  const recon::VisualHull& hull_;
  const core::TriangleTree& part_;
  const core::RigidTransform& world_from_part_;
  double smallest_mm_;
  std::int64_t* queries_;
  int open_ = 0;
};

}  // namespace

Meeting FindMeeting(const recon::VisualHull& hull, const core::TriangleTree& part,
                    const core::RigidTransform& world_from_part, double smallest_mm, std::int64_t* queries) {
  const Meeting apart{kApart};
  if (hull.IsEmpty()) return apart;
  MeetingSearch search(hull, part, world_from_part, smallest_mm, queries);
  ++*queries;
  const core::Ball& ball = part.nodes()[0].ball;
  if (hull.Classify(world_from_part * ball.center, ball.radius_mm) == BallAnswer::kOutside) return apart;
  if (const std::optional<Meeting> on_surface = search.VisitNode(0, {})) return *on_surface;
  if (search.is_open()) return {};
  if (!part.is_closed()) return apart;
  if (const std::optional<Meeting> within = search.VisitCell(part.bounds(), {})) return *within;
  return search.is_open() ? Meeting{} : apart;
}

}  // namespace elbowroom::review
