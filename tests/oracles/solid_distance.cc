#include "tests/oracles/solid_distance.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

#include "core/error.h"
#include "tests/oracles/mesh_gap.h"

namespace elbowroom::oracles {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

// Solids by number, a bit each.
using Some = std::uint64_t;
constexpr std::size_t kMostSolids = 64;

// A piece of surface, which solids may be the nearest to one of its points, and what none is nearer than.
struct Piece {
  Corners corners;
  Some solids = 0;
  double least_mm = 0.0;

  [[nodiscard]] bool operator<(const Piece& other) const { return least_mm > other.least_mm; }
};

// Of all pieces, the one that may be the nearest is cut first.
class Search {
 public:
  explicit Search(std::span<const recon::Solid> solids) : solids_(solids) {}

  void Add(const Corners& corners) {
    const Some all = solids_.size() == kMostSolids ? ~Some{0} : (Some{1} << solids_.size()) - 1;
    Add(corners, all);
  }

  [[nodiscard]] double Run(double tolerance_mm, double far_mm) {
    while (!pieces_.empty()) {
      const Piece nearest = pieces_.top();
      if (nearest.least_mm >= found_mm_ - tolerance_mm) break;
      if (nearest.least_mm >= far_mm) return std::max(found_mm_, far_mm);
      pieces_.pop();
      Halve(nearest);
    }
    return found_mm_;
  }

 private:
  void Add(const Corners& corners, Some solids) {
    const Eigen::Vector3d middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    double reach_mm = 0.0;
    for (const Eigen::Vector3d& corner : corners) reach_mm = std::max(reach_mm, (corner - middle).norm());
    std::array<double, kMostSolids> distances_mm;
    double distance_mm = std::numeric_limits<double>::infinity();
    for (Some left = solids; left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      distances_mm[i] = recon::SignedDistanceMm(solids_[i], middle);
      distance_mm = std::min(distance_mm, distances_mm[i]);
    }
    found_mm_ = std::min(found_mm_, distance_mm);
    if (distance_mm - reach_mm >= found_mm_) return;
    // At no point of the piece is a solid the nearest that is farther from its middle than this.
    Some near = 0;
    for (Some left = solids; left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      if (distances_mm[i] <= distance_mm + 2.0 * reach_mm) near |= Some{1} << i;
    }
    pieces_.push({corners, near, distance_mm - reach_mm});
  }

  // Across the longest side.
  void Halve(const Piece& piece) {
    const Corners& corners = piece.corners;
    std::size_t longest = 0;
    const auto length = [&](std::size_t i) { return (corners[(i + 1) % 3] - corners[i]).norm(); };
    for (std::size_t i = 1; i < 3; ++i)
      if (length(i) > length(longest)) longest = i;
    const Eigen::Vector3d& a = corners[longest];
    const Eigen::Vector3d& b = corners[(longest + 1) % 3];
    const Eigen::Vector3d& c = corners[(longest + 2) % 3];
    const Eigen::Vector3d middle = 0.5 * (a + b);
    Add({a, middle, c}, piece.solids);
    Add({middle, b, c}, piece.solids);
  }

  std::span<const recon::Solid> solids_;
  std::priority_queue<Piece> pieces_;
  double found_mm_ = std::numeric_limits<double>::infinity();
};

// All solids have the middle of their bounding sphere inside themselves or, of a tube, in its bore: one that
// touches no face of the part is inside it as its middle is.
bool HoldsASolid(const core::TriangleMesh& part, const core::RigidTransform& world_from_part,
                 std::span<const recon::Solid> solids) {
  const Eigen::AlignedBox3d box = core::BoundsOf(part);
  const core::RigidTransform part_from_world = world_from_part.Inverse();
  return std::ranges::any_of(solids, [&](const recon::Solid& solid) {
    const Eigen::Vector3d middle = part_from_world * recon::BoundingSphereOf(solid).center_in_world;
    return box.contains(middle) && WindingNumber(part, middle.cast<long double>()) > 0.5L;
  });
}

}  // namespace

double SolidDistanceMm(const core::TriangleMesh& part, const core::RigidTransform& world_from_part,
                       std::span<const recon::Solid> solids, double tolerance_mm, double far_mm) {
  core::Require(!solids.empty() && !part.triangles.empty(), "there are solids and triangles");
  core::Require(solids.size() <= kMostSolids, "there are 64 solids at most");
  core::Require(tolerance_mm > 0.0, "the tolerance is positive");
  Search search(solids);
  for (const auto& triangle : part.triangles) {
    const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
      return world_from_part * part.vertices_mm[static_cast<std::size_t>(triangle[i])];
    };
    search.Add({corner(0), corner(1), corner(2)});
  }
  const double distance_mm = search.Run(tolerance_mm, far_mm);
  const bool is_apart = distance_mm > 0.0;
  return is_apart && HoldsASolid(part, world_from_part, solids) ? -distance_mm : distance_mm;
}

}  // namespace elbowroom::oracles
