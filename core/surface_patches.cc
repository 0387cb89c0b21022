#include "core/surface_patches.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/error.h"

namespace elbowroom::core {
namespace {

using Eigen::Vector3d;
using Corners = SurfacePatches::Corners;

// Turned so that the longest side comes first.
Corners FromLongestSide(const Corners& p) {
  const double ab = (p.b - p.a).squaredNorm(), bc = (p.c - p.b).squaredNorm(), ca = (p.a - p.c).squaredNorm();
  if (ab >= bc && ab >= ca) return p;
  return bc >= ca ? Corners{p.b, p.c, p.a} : Corners{p.c, p.a, p.b};
}

// Cut at the middle of the longest side, which comes first; the first half holds that side's beginning.
std::array<Corners, 2> HalvesOf(const Corners& longest) {
  const Vector3d middle = 0.5 * (longest.a + longest.b);
  return {{{longest.a, middle, longest.c}, {middle, longest.b, longest.c}}};
}

// Returns how many patches the piece has, and appends SurfacePatches::in_first_half_ of it.
std::uint16_t CountPatches(const Corners& corners, double patch_mm, int halvings,
                           std::vector<std::uint16_t>* in_first_half) {
  static_assert(1 << SurfacePatches::kMostHalvings <= std::numeric_limits<std::uint16_t>::max());
  const Corners longest = FromLongestSide(corners);
  const bool is_small = (longest.b - longest.a).squaredNorm() <= patch_mm * patch_mm;
  if (is_small || halvings >= SurfacePatches::kMostHalvings) return 1;
  const auto [front, back] = HalvesOf(longest);
  const std::size_t piece = in_first_half->size();
  in_first_half->push_back(0);
  const std::uint16_t first = CountPatches(front, patch_mm, halvings + 1, in_first_half);
  (*in_first_half)[piece] = first;
  return static_cast<std::uint16_t>(first + CountPatches(back, patch_mm, halvings + 1, in_first_half));
}

void AppendPatches(const SurfacePatches& patches, const SurfacePatches::Piece& piece,
                   std::vector<Corners>* corners) {
  if (piece.is_patch()) return corners->push_back(piece.corners);
  for (const SurfacePatches::Piece& half : patches.HalvesOf(piece)) AppendPatches(patches, half, corners);
}

}  // namespace

SurfacePatches::SurfacePatches(SharedMesh mesh, double patch_mm) : mesh_(std::move(mesh)) {
  Require(patch_mm > 0.0 && std::isfinite(patch_mm), "a patch has a size");
  first_.reserve(mesh_->triangles.size() + 1);
  first_.push_back(0);
  for (std::size_t t = 0; t < mesh_->triangles.size(); ++t) {
    first_.push_back(first_.back());
    first_.back() += CountPatches(PieceOf(t).corners, patch_mm, 0, &in_first_half_);
  }
}

SurfacePatches::Piece SurfacePatches::PieceOf(std::size_t triangle) const {
  const auto& [a, b, c] = mesh_->triangles[triangle];
  const auto vertex = [&](std::int32_t i) { return mesh_->vertices_mm[static_cast<std::size_t>(i)]; };
  const std::size_t first = FirstOf(triangle);
  return {{vertex(a), vertex(b), vertex(c)}, first, EndOf(triangle), first - triangle};
}

std::array<SurfacePatches::Piece, 2> SurfacePatches::HalvesOf(const Piece& piece) const {
  const auto [front, back] = core::HalvesOf(FromLongestSide(piece.corners));
  const std::size_t patches_of_front = in_first_half_[piece.halving];
  const std::size_t end_of_front = piece.first + patches_of_front;
  // Before the second half's halvings come the piece's own and those of the first half.
  return {{{front, piece.first, end_of_front, piece.halving + 1},
           {back, end_of_front, piece.end, piece.halving + patches_of_front}}};
}

std::vector<Corners> SurfacePatches::CornersOf(std::size_t triangle) const {
  std::vector<Corners> corners;
  corners.reserve(EndOf(triangle) - FirstOf(triangle));
  AppendPatches(*this, PieceOf(triangle), &corners);
  return corners;
}

std::size_t SurfacePatches::PatchAt(std::size_t triangle, const Vector3d& x) const {
  Piece piece = PieceOf(triangle);
  while (!piece.is_patch()) {
    const auto halves = HalvesOf(piece);
    const Corners& first = halves[0].corners;
    // normal x cut lies in the triangle's plane, across the cut, and points to the first half.
    const Vector3d cut = first.c - first.b, normal = (first.b - first.a).cross(first.c - first.a);
    piece = halves[normal.cross(cut).dot(x - first.b) < 0.0 ? 1 : 0];
  }
  return piece.first;
}

}  // namespace elbowroom::core
