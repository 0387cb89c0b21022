#include "recon/hull/triangle_pieces.h"

#include <array>
#include <bit>
#include <cstddef>

#include "core/error.h"
#include "recon/contours/contour_kernel.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

static_assert(CutTriangle::kMostSides * CutTriangle::kMostSides == GridPoints::kMost, "a word of pieces");

// Centres of the pieces, in steps along two sides. In each row first those that point like the triangle, then
// the others.
GridPoints CentresOf(int sides) {
  GridPoints points{};
  const auto add = [&](double x, double y) {
    points.at[0][points.count] = x;
    points.at[1][points.count] = y;
    ++points.count;
  };
  for (int y = 0; y < sides; ++y) {
    for (int x = 0; x + y < sides; ++x) add(x + 1.0 / 3.0, y + 1.0 / 3.0);
    for (int x = 0; x + y + 1 < sides; ++x) add(x + 2.0 / 3.0, y + 2.0 / 3.0);
  }
  return points;
}

const GridPoints& Centres(int sides) {
  static const auto all = [] {
    std::array<GridPoints, CutTriangle::kMostSides> made;
    for (int i = 0; i < CutTriangle::kMostSides; ++i) made[static_cast<std::size_t>(i)] = CentresOf(i + 1);
    return made;
  }();
  return all[static_cast<std::size_t>(sides - 1)];
}

GridView ViewOf(const core::CameraModel& camera, double focal_px, const CutTriangle& triangle) {
  const Vector3d scale(focal_px, focal_px, 1.0);
  const core::RigidTransform& cam_from_world = camera.cam_from_world();
  const Vector3d origin = scale.cwiseProduct(cam_from_world * triangle.a);
  const auto step = [&](const Vector3d& end) -> Vector3d {
    return scale.cwiseProduct(cam_from_world.rotation * (end - triangle.a)) / triangle.sides;
  };
  const Vector3d x = step(triangle.b), y = step(triangle.c);
  return {{origin.x(), origin.y(), origin.z()}, {{{x.x(), x.y(), x.z()}, {y.x(), y.y(), y.z()}, {}}}};
}

std::uint64_t InWorkspace(const Eigen::AlignedBox3d& workspace_mm, const CutTriangle& triangle,
                          std::uint64_t pieces) {
  if (workspace_mm.contains(triangle.a) && workspace_mm.contains(triangle.b) &&
      workspace_mm.contains(triangle.c))
    return pieces;
  for (std::uint64_t left = pieces; left != 0; left &= left - 1) {
    const int piece = std::countr_zero(left);
    if (!workspace_mm.contains(triangle.CentreOf(piece))) pieces &= ~(std::uint64_t{1} << piece);
  }
  return pieces;
}

}  // namespace

Vector3d CutTriangle::CentreOf(int piece) const {
  const GridPoints& centres = Centres(sides);
  const auto i = static_cast<std::size_t>(piece);
  return a + centres.at[0][i] / sides * (b - a) + centres.at[1][i] / sides * (c - a);
}

std::uint64_t PiecesInHull(const VisualHull& hull, const CutTriangle& triangle,
                           const UndecidedCameras& open) {
  core::Require(triangle.sides >= 1 && triangle.sides <= CutTriangle::kMostSides, "1 to 8 pieces a side");
  if (hull.IsEmpty()) return 0;
  const GridPoints& centres = Centres(triangle.sides);
  const auto pieces = static_cast<unsigned>(triangle.pieces());
  std::uint64_t inside = InWorkspace(hull.rig().workspace_mm, triangle, ~std::uint64_t{0} >> (64 - pieces));
  const auto silhouettes = hull.silhouettes();
  for (std::size_t i = 0; i < silhouettes.size() && inside != 0; ++i) {
    if (!open.Asks(i)) continue;
    const GridView view = ViewOf(hull.rig().cameras[i], silhouettes[i]->plane().focal_px(), triangle);
    inside = LabelPoints(view, silhouettes[i]->labels().CellsView(), centres, inside);
  }
  if (!ExteriorIsObject(hull.rig()) || !open.asks_visibility) return inside;
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < silhouettes.size() && (inside & ~seen) != 0; ++i) {
    const UndistortedPlane& plane = silhouettes[i]->plane();
    seen |= LabelPoints(ViewOf(hull.rig().cameras[i], plane.focal_px(), triangle),
                        plane.outline().CellsView(), centres);
  }
  return inside & seen;
}

}  // namespace elbowroom::recon
