#include "tests/recon/scenes/carve.h"

#include <tbb/parallel_for.h>

#include <atomic>

#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {

double CarvedVolumeMm3(const VisualHull& hull, const Eigen::AlignedBox3d& box_mm, int side) {
  const Eigen::Vector3d voxel_mm = box_mm.sizes() / side;
  std::atomic<std::int64_t> inside = 0;
  tbb::parallel_for(0, side, [&](int z) {
    std::int64_t count = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const Eigen::Vector3d at(x + 0.5, y + 0.5, z + 0.5);
        count += hull.Contains(box_mm.min() + voxel_mm.cwiseProduct(at)) ? 1 : 0;
      }
    }
    inside += count;
  });
  return static_cast<double>(inside) * voxel_mm.prod();
}

}  // namespace elbowroom::recon
