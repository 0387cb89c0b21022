// A mesh's surface in patches of about one size, numbered.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/triangle_mesh.h"

namespace elbowroom::core {

// Each triangle is halved across its longest side, and the halves again, until no side is longer than
// patch_mm, at most kMostHalvings deep; what is left are the patches. Numbered triangle by triangle: a
// function of mesh and patch_mm alone (surface_patches_test). In the mesh's frame. Thread: any.
class SurfacePatches {
 public:
  static constexpr int kMostHalvings = 12;
  struct Corners {
    Eigen::Vector3d a, b, c;  // turning as the triangle does
    [[nodiscard]] Eigen::Vector3d Centre() const { return (a + b + c) / 3.0; }
  };

  // Throws: PreconditionError unless patch_mm is positive.
  SurfacePatches(SharedMesh mesh, double patch_mm);

  [[nodiscard]] std::size_t size() const { return first_.back(); }
  [[nodiscard]] std::size_t FirstOf(std::size_t triangle) const { return first_[triangle]; }
  [[nodiscard]] std::size_t EndOf(std::size_t triangle) const { return first_[triangle + 1]; }
  // A triangle's patches, FirstOf() first.
  [[nodiscard]] std::vector<Corners> CornersOf(std::size_t triangle) const;

  // The patch that a point of the triangle lies on; of a point off it, or of a triangle without area, some
  // patch of it.
  [[nodiscard]] std::size_t PatchAt(std::size_t triangle, const Eigen::Vector3d& x) const;

 private:
  [[nodiscard]] Corners TriangleAt(std::size_t triangle) const;

  SharedMesh mesh_;
  double patch_mm_;
  std::vector<std::size_t> first_;  // one a triangle, and the number of patches
};

}  // namespace elbowroom::core
