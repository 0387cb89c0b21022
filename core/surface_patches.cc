#include "core/surface_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "core/error.h"

namespace elbowroom::core {
namespace {

using Eigen::Vector3d;
using Corners = SurfacePatches::Corners;

// The two halves of a piece, cut at the middle of its longest side; the first holds that side's beginning.
// Nothing: no side is longer than patch_mm.
std::optional<std::array<Corners, 2>> HalvesOf(const Corners& p, double patch_mm) {
  const std::array<Corners, 3> turned{{{p.a, p.b, p.c}, {p.b, p.c, p.a}, {p.c, p.a, p.b}}};
  const auto side_mm2 = [](const Corners& t) { return (t.b - t.a).squaredNorm(); };
  const Corners& longest = *std::ranges::max_element(turned, {}, side_mm2);
  if (side_mm2(longest) <= patch_mm * patch_mm) return std::nullopt;
  const Vector3d middle = 0.5 * (longest.a + longest.b);
  return std::array<Corners, 2>{{{longest.a, middle, longest.c}, {middle, longest.b, longest.c}}};
}

template <typename Visit>
void VisitPatches(const Corners& corners, double patch_mm, int halvings, const Visit& visit) {
  const auto halves = halvings < SurfacePatches::kMostHalvings ? HalvesOf(corners, patch_mm) : std::nullopt;
  if (!halves) return visit(corners);
  for (const Corners& half : *halves) VisitPatches(half, patch_mm, halvings + 1, visit);
}

// Returns how many patches the piece has, and appends SurfacePatches::in_first_half_ of it.
std::uint16_t CountPatches(const Corners& corners, double patch_mm, int halvings,
                           std::vector<std::uint16_t>* in_first_half) {
  static_assert(1 << SurfacePatches::kMostHalvings <= std::numeric_limits<std::uint16_t>::max());
  const auto halves = halvings < SurfacePatches::kMostHalvings ? HalvesOf(corners, patch_mm) : std::nullopt;
  if (!halves) return 1;
  const std::size_t piece = in_first_half->size();
  in_first_half->push_back(0);
  const std::uint16_t first = CountPatches(halves->front(), patch_mm, halvings + 1, in_first_half);
  (*in_first_half)[piece] = first;
  return static_cast<std::uint16_t>(first +
                                    CountPatches(halves->back(), patch_mm, halvings + 1, in_first_half));
}

}  // namespace

SurfacePatches::SurfacePatches(SharedMesh mesh, double patch_mm)
    : mesh_(std::move(mesh)), patch_mm_(patch_mm) {
  Require(patch_mm > 0.0 && std::isfinite(patch_mm), "a patch has a size");
  first_.reserve(mesh_->triangles.size() + 1);
  first_.push_back(0);
  for (std::size_t t = 0; t < mesh_->triangles.size(); ++t)
    first_.push_back(first_.back() + CountPatches(TriangleAt(t), patch_mm_, 0, &in_first_half_));
}

Corners SurfacePatches::TriangleAt(std::size_t triangle) const {
  const auto& [a, b, c] = mesh_->triangles[triangle];
  const auto vertex = [&](std::int32_t i) { return mesh_->vertices_mm[static_cast<std::size_t>(i)]; };
  return {vertex(a), vertex(b), vertex(c)};
}

std::vector<Corners> SurfacePatches::CornersOf(std::size_t triangle) const {
  std::vector<Corners> patches;
  patches.reserve(EndOf(triangle) - FirstOf(triangle));
  VisitPatches(TriangleAt(triangle), patch_mm_, 0, [&](const Corners& p) { patches.push_back(p); });
  return patches;
}

std::size_t SurfacePatches::PatchAt(std::size_t triangle, const Vector3d& x) const {
  Corners corners = TriangleAt(triangle);
  std::size_t patch = FirstOf(triangle), end = EndOf(triangle);
  for (std::size_t piece = patch - triangle; end - patch > 1;) {
    const auto [first, second] = *HalvesOf(corners, patch_mm_);
    const std::size_t patches_of_first = in_first_half_[piece];
    // normal x cut lies in the triangle's plane, across the cut, and points to the first half.
    const Vector3d cut = first.c - first.b, normal = (first.b - first.a).cross(first.c - first.a);
    const bool is_in_second = normal.cross(cut).dot(x - first.b) < 0.0;
    if (is_in_second) {
      patch += patches_of_first;
      piece += patches_of_first;  // past itself and what its first half is halved
    } else {
      end = patch + patches_of_first;
      ++piece;
    }
    corners = is_in_second ? second : first;
  }
  return patch;
}

}  // namespace elbowroom::core
