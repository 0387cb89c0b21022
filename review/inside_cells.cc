#include "review/inside_cells.h"

#include <cmath>

#include "core/part_distance.h"

namespace elbowroom::review {
namespace {

using core::NearestOnPart;
using Eigen::Vector3d;

// An arbitrary direction, along which edges and faces of CAD parts are unlikely to run.
const Vector3d kDirection = Vector3d(0.5773, 0.3911, 0.7173).normalized();

bool RayMeets(const core::Ball& ball, const Vector3d& origin) {
  const Vector3d to_center = ball.center - origin;
  const double along = to_center.dot(kDirection);
  const double square = ball.radius_mm * ball.radius_mm;
  if (along < 0.0 && to_center.squaredNorm() > square) return false;
  return to_center.squaredNorm() - along * along <= square * (1.0 + 1e-9);
}

// Moeller and Trumbore's test. 1 where the ray leaves through the triangle's front, -1 where it enters, 0
// where it misses.
int CrossingOf(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& origin) {
  const Vector3d ab = b - a, ac = c - a, normal_part = kDirection.cross(ac);
  const double determinant = ab.dot(normal_part);
  if (determinant == 0.0) return 0;
  const Vector3d from_a = origin - a;
  const double u = from_a.dot(normal_part) / determinant;
  const Vector3d q = from_a.cross(ab);
  const double v = kDirection.dot(q) / determinant;
  const bool crosses = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && ac.dot(q) / determinant > 0.0;
  if (!crosses) return 0;
  return determinant < 0.0 ? 1 : -1;
}

// How many times the surface winds around the point: the ray counts +1 where it leaves and -1 where it
// enters.
int WindingAround(const core::TriangleTree& part, std::uint32_t index, const Vector3d& origin) {
  const core::TriangleTree::Node& node = part.nodes()[index];
  if (!RayMeets(node.ball, origin)) return 0;
  if (node.left != 0)
    return WindingAround(part, node.left, origin) + WindingAround(part, node.left + 1, origin);
  int winding = 0;
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    const auto& [a, b, c] = part.mesh().triangles[part.order()[i]];
    const auto vertex = [&](std::int32_t v) -> const Vector3d& {
      return part.mesh().vertices_mm[static_cast<std::size_t>(v)];
    };
    winding += CrossingOf(vertex(a), vertex(b), vertex(c), origin);
  }
  return winding;
}

}  // namespace

bool IsInsideClosedMesh(const core::TriangleTree& part, const Vector3d& x_in_part) {
  return !part.nodes().empty() && WindingAround(part, 0, x_in_part) != 0;
}

InsideCells::Cell InsideCells::Child(const Cell& cell, int which) {
  if (facts_[cell.at].first_child == 0) {
    facts_[cell.at].first_child = static_cast<std::uint32_t>(facts_.size());
    const std::uint32_t likely = facts_[cell.at].triangle;
    facts_.resize(facts_.size() + 8, {.triangle = likely});
  }
  const Vector3d center = cell.box.center();
  const Vector3d corner = cell.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(which));
  return {{corner.cwiseMin(center), corner.cwiseMax(center)},
          facts_[cell.at].first_child + static_cast<std::uint32_t>(which)};
}

const InsideCells::Facts& InsideCells::FactsOf(const Cell& cell) {
  Facts& facts = facts_[cell.at];
  if (facts.to_surface_mm < 0.0) {
    const Vector3d center = cell.box.center();
    const NearestOnPart nearest = FindNearest(part_, {.center = center}, facts.triangle);
    facts.to_surface_mm = nearest.distance_mm;
    facts.triangle = nearest.triangle;
    facts.is_inside = IsInsideClosedMesh(part_, center);
  }
  return facts;
}

bool InsideCells::IsInside(const Cell& cell) { return FactsOf(cell).is_inside; }

bool InsideCells::MayHoldSurface(const Cell& cell) { return FactsOf(cell).to_surface_mm <= cell.radius_mm(); }

}  // namespace elbowroom::review
