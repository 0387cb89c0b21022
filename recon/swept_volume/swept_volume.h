// The union of hulls as one closed mesh, with how long each place was covered.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "core/progress.h"
#include "core/triangle_mesh.h"
#include "recon/hull/visual_hull_declared.h"
#include "recon/swept_volume/swept_grid.h"
#include "recon/swept_volume/swept_tile.h"

namespace elbowroom::recon {

// A hull, and for how long it stood as it is.
struct HullSpan {
  std::shared_ptr<const VisualHull> hull;
  double seconds = 0.0;  // >= 0
};

struct SweptMesh {
  core::TriangleMesh mesh;  // world, mm; closed and 2-manifold by construction; nothing swept: no triangles
  std::vector<double> dwell_s;  // by vertex
};

struct SweptVolumeOptions {
  double edge_mm = 5.0;                              // > 0: of the cells
  std::int64_t most_bytes = std::int64_t{2} << 30U;  // of memory for cells
};

// Hulls are added to a sparse grid, whose corners keep values such that the values interpolated in the cells'
// tetrahedra are at most 0 in every hull. The mesh is the surface at 0, so every point of every hull is
// inside it or on it: certified, also after its vertices are rounded to float32 (swept_volume_test). How far
// the mesh may reach beyond: BoundMm(). The dwell of a vertex is at least the time for which hulls reached
// into the cells that it is in, and at most that for which they weren't surely farther from it than two
// cells' diagonals. Derivation: docs/keep_out.md. Thread: one at a time; the result depends neither on the
// number of threads nor on how hulls are shared out to calls.
class SweptVolume {
 public:
  // Throws: as MakeSweptGrid.
  SweptVolume(const Eigen::AlignedBox3d& workspace_mm, const SweptVolumeOptions& options);
  ~SweptVolume();

  // Throws: core::Error{kRange} when the cells need more memory than allowed, naming an edge that needs less;
  // core::Error{kCancelled}.
  void Add(std::span<const HullSpan> hulls, const std::stop_token& stop = {});

  // Throws: core::Error{kCancelled}; core::Error{kRange} for more triangles than a mesh can hold.
  [[nodiscard]] SweptMesh Mesh(const core::Progress& progress = {}, const std::stop_token& stop = {}) const;

  // For every point of the mesh there is a hull added so that each of its cameras has object this near to the
  // point: the camera's silhouette, as a cone in space, is no farther away. Infinite where a camera stands in
  // the workspace.
  [[nodiscard]] double BoundMm() const;
  [[nodiscard]] const SweptGrid& grid() const;
  [[nodiscard]] const SweptWork& work() const;
  [[nodiscard]] std::int64_t bytes() const;  // of memory for cells, at most so far

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace elbowroom::recon
