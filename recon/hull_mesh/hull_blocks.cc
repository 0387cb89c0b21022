#include "recon/hull_mesh/hull_blocks.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/error.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/camera_query.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

// Coordinates of grid points fit 20 bits.
constexpr int kLargestSide = (1 << 20) - 1;
// Cubes of this many cells a side are the pieces of work for threads.
constexpr int kTaskCells = 32;
constexpr std::size_t kMostCameras = 255;

// The questions that are still open about a cube.
struct Doubts {
  std::array<std::uint8_t, kMostCameras> cameras;
  std::size_t camera_count = 0;
  bool is_in_workspace = false;
  bool is_seen = true;
};

class Search {
 public:
  Search(const VisualHull& hull, const HullGrid& grid) : hull_(hull), grid_(grid) {}

  // Down to cubes of `least` cells; calls visit(corner, doubts) for those that aren't settled.
  template <typename Visit>
  void Descend(const GridPoint& corner, int size, int least, const Doubts& before, const Visit& visit) {
    if ((corner.array() >= grid_.cells.array()).any()) return;
    Doubts doubts;
    if (!IsOpen(corner, size, before, &doubts)) return;
    if (size == least) return visit(corner, doubts);
    for (int child = 0; child < 8; ++child) {
      Descend(corner + GridPoint(child & 1, (child >> 1) & 1, child >> 2) * (size / 2), size / 2, least,
              doubts, visit);
    }
  }

  [[nodiscard]] std::int64_t queries() const { return queries_; }

 private:
  // False if the cube is all outside, or all inside.
  bool IsOpen(const GridPoint& corner, int size, const Doubts& before, Doubts* doubts) {
    const Eigen::Vector3d center = grid_.At(corner) + Eigen::Vector3d::Constant(0.5 * size * grid_.edge_mm);
    const double radius_mm = 0.5 * std::sqrt(3.0) * size * grid_.edge_mm * (1.0 + 1e-12);
    const Eigen::AlignedBox3d& workspace_mm = hull_.rig().workspace_mm;
    doubts->is_in_workspace = before.is_in_workspace;
    if (!before.is_in_workspace) {
      if (workspace_mm.exteriorDistance(center) > radius_mm) return false;
      doubts->is_in_workspace = (center - workspace_mm.min()).minCoeff() > radius_mm &&
                                (workspace_mm.max() - center).minCoeff() > radius_mm;
    }
    doubts->camera_count = 0;
    for (std::size_t i = 0; i < before.camera_count; ++i) {
      const std::uint8_t camera = before.cameras[i];
      const Silhouette& silhouette = *hull_.silhouettes()[camera];
      const BallLabel label = AskPlane(hull_.rig().cameras[camera], silhouette.plane().focal_px(),
                                       silhouette.labels(), center, radius_mm);
      ++queries_;
      if (label.radius_mm < radius_mm) {
        doubts->cameras[doubts->camera_count++] = camera;
      } else if (!label.is_object) {
        return false;
      }
    }
    doubts->is_seen = before.is_seen || IsSeen(center, radius_mm);
    return doubts->camera_count > 0 || !doubts->is_in_workspace || !doubts->is_seen;
  }

  // Whether one camera sees all of the ball.
  bool IsSeen(const Eigen::Vector3d& center, double radius_mm) {
    for (std::size_t i = 0; i < hull_.silhouettes().size(); ++i) {
      const UndistortedPlane& plane = hull_.silhouettes()[i]->plane();
      const BallLabel seen =
          AskPlane(hull_.rig().cameras[i], plane.focal_px(), plane.outline(), center, radius_mm);
      ++queries_;
      if (seen.is_object && seen.radius_mm >= radius_mm) return true;
    }
    return false;
  }

  const VisualHull& hull_;
  const HullGrid& grid_;
  std::int64_t queries_ = 0;
};

HullBlock BlockAt(const GridPoint& corner, const Doubts& doubts) {
  const auto* const cameras = doubts.cameras.data();
  return {corner, {cameras, cameras + doubts.camera_count}, doubts.is_in_workspace, doubts.is_seen};
}

// The lowest 20 bits, two zeros between each and the next.
std::uint64_t SpreadBits(int number) {
  auto bits = static_cast<std::uint64_t>(number);
  bits = (bits | bits << 32U) & 0x001F00000000FFFFU;
  bits = (bits | bits << 16U) & 0x001F0000FF0000FFU;
  bits = (bits | bits << 8U) & 0x100F00F00F00F00FU;
  bits = (bits | bits << 4U) & 0x10C30C30C30C30C3U;
  return (bits | bits << 2U) & 0x1249249249249249U;
}

struct OpenCube {
  GridPoint corner;
  Doubts doubts;
};

}  // namespace

HullGrid MakeHullGrid(const Eigen::AlignedBox3d& workspace_mm, double edge_mm) {
  if (!(edge_mm > 0.0) || !std::isfinite(edge_mm)) {
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("hull mesh: the edge length must be positive, not {} mm", edge_mm));
  }
  const Eigen::Vector3d cells = (workspace_mm.sizes() / edge_mm).array().ceil() + 2.0;
  if (cells.maxCoeff() > kLargestSide) {
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format("hull mesh: edges of {} mm need {:.0f} cells a side, more than 2^20; choose longer edges",
                    edge_mm, cells.maxCoeff()));
  }
  return {workspace_mm.center() - 0.5 * edge_mm * cells, edge_mm, cells.cast<int>()};
}

std::uint64_t MortonKey(const GridPoint& corner) {
  return SpreadBits(corner.x()) | SpreadBits(corner.y()) << 1U | SpreadBits(corner.z()) << 2U;
}

HullBlocks FindHullBlocks(const VisualHull& hull, const HullGrid& grid, const core::Progress& progress,
                          const std::stop_token& stop) {
  core::Require(hull.silhouettes().size() <= kMostCameras, "a hull of at most 255 cameras is meshed");
  HullBlocks found;
  Doubts all;
  all.is_seen = !ExteriorIsObject(hull.rig());
  for (std::size_t i = 0; i < hull.silhouettes().size(); ++i)
    all.cameras[all.camera_count++] = static_cast<std::uint8_t>(i);
  int size = kTaskCells;
  while (size < grid.cells.maxCoeff()) size *= 2;
  std::vector<OpenCube> cubes;
  Search coarse(hull, grid);
  coarse.Descend(GridPoint::Zero(), size, kTaskCells, all,
                 [&](const GridPoint& corner, const Doubts& doubts) {
                   cubes.push_back({corner, doubts});
                 });
  found.queries += coarse.queries();
  // A few cubes at a time: in between, the calling thread reports progress and obeys a stop.
  constexpr std::size_t kAtOnce = 256;
  for (std::size_t begin = 0; begin < cubes.size(); begin += kAtOnce) {
    core::ThrowIfStopped(stop, "meshing the hull");
    const std::size_t end = std::min(begin + kAtOnce, cubes.size());
    std::vector<std::vector<HullBlock>> parts(end - begin);
    std::vector<std::int64_t> queries(end - begin);
    tbb::parallel_for(begin, end, [&](std::size_t i) {
      Search fine(hull, grid);
      fine.Descend(cubes[i].corner, kTaskCells, kBlockCells, cubes[i].doubts,
                   [&](const GridPoint& corner, const Doubts& doubts) {
                     parts[i - begin].push_back(BlockAt(corner, doubts));
                   });
      queries[i - begin] = fine.queries();
    });
    for (std::size_t i = 0; i < parts.size(); ++i) {
      std::move(parts[i].begin(), parts[i].end(), std::back_inserter(found.blocks));
      found.queries += queries[i];
    }
    progress.Report(static_cast<std::int64_t>(end), static_cast<std::int64_t>(cubes.size()), "hull cells");
  }
  return found;
}

}  // namespace elbowroom::recon
