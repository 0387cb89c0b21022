#include "tests/recon/scenes/part_samples.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <vector>

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Multiples of a sixteenth: doubles hold all of it exactly.
bool Covers(const TriangleViewport& viewport, const TriangleViewportOptions& options, int column, int row) {
  const std::array<Vector2d, 3> corners = {
      {{0.0, 0.0}, {options.width_px, 0.0}, {viewport.apex_x_px(), options.height_px}}};
  const Vector2d center(column + 0.5, row + 0.5);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector2d edge = corners[(i + 1) % 3] - corners[i];
    if (Cross(edge, center - corners[i]) < 0.0) return false;
  }
  return true;
}

}  // namespace

core::TriangleMesh RandomTriangles(Random* random, const Eigen::AlignedBox3d& box_mm, int count) {
  core::TriangleMesh mesh;
  const double size_mm = box_mm.diagonal().norm();
  for (int i = 0; i < count; ++i) {
    const Vector3d a = random->PointIn(box_mm);
    const double side_mm = random->LogUniform(0.05, 1.0) * size_mm;
    const Vector3d b = a + side_mm * random->Direction();
    const double thin = i % 5 == 1 ? 1e-3 : (i % 5 == 2 ? 0.0 : 1.0);
    const Vector3d c = a + random->Uniform(-0.5, 1.5) * (b - a) + thin * side_mm * random->Direction();
    core::Append(mesh, {{a, b, i % 11 == 0 ? a : c}, {{0, 1, 2}}});
  }
  return mesh;
}

SampleCheck CheckSamples(const core::Rig& rig, std::span<const core::SoftMask> masks,
                         const core::TriangleMesh& part, const core::RigidTransform& world_from_part,
                         const TriangleViewportOptions& options, const SampledContacts& sampled,
                         const SweepBand& band) {
  const PointOracle oracle(rig, masks, band);
  std::set<std::tuple<std::uint32_t, int, int>> found;
  for (const ViewportContact& contact : sampled.contacts)
    found.insert({contact.triangle, contact.row, contact.column});
  SampleCheck check;
  const std::vector<TriangleViewport> viewports = MakeViewports(part, world_from_part, options);
  for (std::uint32_t i = 0; i < viewports.size(); ++i) {
    // Of the positions' numbers: the origin and all that is added to it.
    const double size_mm = viewports[i].origin_mm().norm() +
                           options.width_px * viewports[i].along_x_mm().norm() +
                           options.height_px * viewports[i].along_y_mm().norm();
    for (int row = 0; row < options.height_px; ++row) {
      for (int column = 0; column < options.width_px; ++column) {
        const bool is_found = found.contains({i, row, column});
        const Sure inside = Covers(viewports[i], options, column, row)
                                ? oracle.InHull(viewports[i].PositionOf(column, row), size_mm)
                                : Sure::kNo;
        check.unsure_samples += inside == Sure::kUnsure ? 1 : 0;
        check.hull_samples += inside == Sure::kYes ? 1 : 0;
        if (inside == Sure::kUnsure || (inside == Sure::kYes) == is_found) continue;
        if (check.wrong_samples++ == 0) {
          check.first_wrong = fmt::format("triangle {}, pixel ({}, {}): {}", i, column, row,
                                          is_found ? "not in the hull" : "missed");
        }
      }
    }
  }
  return check;
}

}  // namespace elbowroom::recon
