#include "review/containment.h"

#include <Eigen/Geometry>
#include <cmath>

#include "review/part_distance.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

// Along no edge of anything that was drawn with a ruler.
const Vector3d kDirection = Vector3d(0.5773, 0.3911, 0.7173).normalized();

bool RayMeets(const core::Ball& ball, const Vector3d& origin) {
  const Vector3d to_center = ball.center - origin;
  const double along = to_center.dot(kDirection);
  const double square = ball.radius_mm * ball.radius_mm;
  if (along < 0.0 && to_center.squaredNorm() > square) return false;
  return to_center.squaredNorm() - along * along <= square * (1.0 + 1e-9);
}

// Moeller and Trumbore's test.
bool RayCrosses(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& origin) {
  const Vector3d ab = b - a, ac = c - a, normal_part = kDirection.cross(ac);
  const double determinant = ab.dot(normal_part);
  if (determinant == 0.0) return false;
  const Vector3d from_a = origin - a;
  const double u = from_a.dot(normal_part) / determinant;
  const Vector3d q = from_a.cross(ab);
  const double v = kDirection.dot(q) / determinant;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && ac.dot(q) / determinant > 0.0;
}

int CountCrossings(const core::TriangleTree& part, std::uint32_t index, const Vector3d& origin) {
  const core::TriangleTree::Node& node = part.nodes()[index];
  if (!RayMeets(node.ball, origin)) return 0;
  if (node.left != 0)
    return CountCrossings(part, node.left, origin) + CountCrossings(part, node.left + 1, origin);
  int crossings = 0;
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    const auto& [a, b, c] = part.mesh().triangles[part.order()[i]];
    const auto vertex = [&](std::int32_t v) -> const Vector3d& {
      return part.mesh().vertices_mm[static_cast<std::size_t>(v)];
    };
    crossings += RayCrosses(vertex(a), vertex(b), vertex(c), origin) ? 1 : 0;
  }
  return crossings;
}

class InsideSearch {
 public:
  InsideSearch(const recon::VisualHull& hull, const core::TriangleTree& part,
               const core::RigidTransform& world_from_part, double cell_mm, std::int64_t* queries)
      : hull_(hull), part_(part), world_from_part_(world_from_part), cell_mm_(cell_mm), queries_(queries) {}

  [[nodiscard]] std::optional<Vector3d> Run() { return Visit(part_.bounds(), 0, {}); }

 private:
  // `likely`: a triangle that is probably near.
  [[nodiscard]] std::optional<Vector3d> Visit(const Eigen::AlignedBox3d& cell_in_part, std::uint32_t likely,
                                              recon::OpenCameras open) {
    const Vector3d center = cell_in_part.center(), center_in_world = world_from_part_ * center;
    const double radius_mm = 0.5 * cell_in_part.diagonal().norm() * (1.0 + 1e-12);
    const recon::BallAnswer answer = Ask(center_in_world, radius_mm, 0.5 * cell_in_part.sizes(), &open);
    if (answer == recon::BallAnswer::kOutside) return std::nullopt;
    const bool is_hull = hull_.Contains(center_in_world, open);
    const NearestOnPart nearest = FindNearest(part_, {.center = center}, likely);
    // A cell without surface is on one side of it; so is one wholly in the hull, where no face is.
    const bool is_one_side = nearest.distance_mm > radius_mm || answer == recon::BallAnswer::kInside;
    if (is_hull || is_one_side) {
      const bool is_in_part = IsInsideClosedMesh(part_, center);
      if (is_hull && is_in_part) return center_in_world;
      if (is_one_side && !is_in_part) return std::nullopt;
    }
    if (cell_in_part.sizes().maxCoeff() <= cell_mm_) return std::nullopt;
    for (int child = 0; child < 8; ++child) {
      const Vector3d corner = cell_in_part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(child));
      const Eigen::AlignedBox3d eighth(corner.cwiseMin(center), corner.cwiseMax(center));
      if (std::optional<Vector3d> found = Visit(eighth, nearest.triangle, open)) return found;
    }
    return std::nullopt;
  }

  // Of the cell's ball, and where that is mixed, of the cell.
  recon::BallAnswer Ask(const Vector3d& center_in_world, double radius_mm, const Vector3d& half_mm,
                        recon::OpenCameras* open) {
    ++*queries_;
    const recon::BallAnswer answer = hull_.Classify(center_in_world, radius_mm, open);
    if (answer != recon::BallAnswer::kMixed) return answer;
    ++*queries_;
    return hull_.Classify(
        recon::WorldShape::Box(center_in_world, world_from_part_.rotation * half_mm.asDiagonal()), open);
  }

  const recon::VisualHull& hull_;
  const core::TriangleTree& part_;
  const core::RigidTransform& world_from_part_;
  double cell_mm_;
  std::int64_t* queries_;
};

}  // namespace

bool IsInsideClosedMesh(const core::TriangleTree& part, const Vector3d& x_in_part) {
  return !part.nodes().empty() && CountCrossings(part, 0, x_in_part) % 2 == 1;
}

std::optional<Vector3d> FindHullInside(const recon::VisualHull& hull, const core::TriangleTree& part,
                                       const core::RigidTransform& world_from_part, double cell_mm,
                                       std::int64_t* queries) {
  if (!part.is_closed()) return std::nullopt;
  return InsideSearch(hull, part, world_from_part, cell_mm, queries).Run();
}

}  // namespace elbowroom::review
