// A mesh's surface, cut into numbered patches of bounded size.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/triangle_mesh.h"

namespace elbowroom::core {

// Each triangle is halved at the middle of its longest side, and so are the halves, until no side is longer
// than patch_mm or kMostHalvings is reached: these pieces are the patches. They are numbered triangle by
// triangle, so that the numbers depend only on mesh and patch_mm (surface_patches_test). Frame: the mesh's.
// Thread: any.
class SurfacePatches {
 public:
  static constexpr int kMostHalvings = 12;
  struct Corners {
    Eigen::Vector3d a, b, c;  // in the triangle's orientation
    [[nodiscard]] Eigen::Vector3d Centre() const { return (a + b + c) / 3.0; }
  };

  // Throws: PreconditionError unless patch_mm is positive.
  SurfacePatches(SharedMesh mesh, double patch_mm);

  [[nodiscard]] std::size_t size() const { return first_.back(); }
  [[nodiscard]] std::size_t FirstOf(std::size_t triangle) const { return first_[triangle]; }
  [[nodiscard]] std::size_t EndOf(std::size_t triangle) const { return first_[triangle + 1]; }
  // A triangle, or one of its halves, or one of theirs, with the patches that it consists of.
  struct Piece {
    Corners corners;
    std::size_t first = 0;
    std::size_t end = 0;
    std::size_t halving = 0;  // its place in in_first_half_

    [[nodiscard]] bool is_patch() const { return end - first == 1; }
  };
  [[nodiscard]] Piece PieceOf(std::size_t triangle) const;
  // Of a piece that isn't a patch. The halves' patches follow one another.
  [[nodiscard]] std::array<Piece, 2> HalvesOf(const Piece& piece) const;

  // A triangle's patches, FirstOf() first.
  [[nodiscard]] std::vector<Corners> CornersOf(std::size_t triangle) const;

  // The patch of the triangle on which the point lies. If the point is off the triangle, or the triangle has
  // no area, any of its patches. At most kMostHalvings steps.
  [[nodiscard]] std::size_t PatchAt(std::size_t triangle, const Eigen::Vector3d& x) const;

 private:
  SharedMesh mesh_;
  std::vector<std::size_t> first_;  // first patch of each triangle; at the end, the number of patches
  // For each piece that is halved, the patches of its first half. A triangle with n patches is halved n - 1
  // times: first the triangle, then all of its first half, then all of its second.
  std::vector<std::uint16_t> in_first_half_;
};

}  // namespace elbowroom::core
