// A hull as the points of a grid see it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "recon/hull_blocks.h"
#include "recon/point_labels.h"
#include "recon/visual_hull.h"

namespace elbowroom::recon {

class HullLattice {
 public:
  // `hull` and `grid` must outlive the lattice.
  HullLattice(const VisualHull& hull, const HullGrid& grid);

  // Which of a block's grid points the hull contains; of a point the same in each of its blocks. `queries`
  // grows by the labels asked, of one camera each.
  [[nodiscard]] BlockBits LabelsOf(const HullBlock& block, std::int64_t* queries) const;

  // Where the way from an inside grid point of a block to an outside neighbour first leaves the hull.
  [[nodiscard]] Eigen::Vector3d Exit(const HullBlock& block, const GridPoint& inside,
                                     const GridPoint& outside) const;

 private:
  [[nodiscard]] BlockBits InWorkspace(const GridPoint& corner) const;
  std::int64_t KeepSeen(const GridPoint& corner, BlockBits* bits) const;
  [[nodiscard]] std::optional<double> FirstExit(const HullBlock& block, const GridPoint& inside,
                                                const GridPoint& outside) const;
  [[nodiscard]] double BisectedExit(const GridPoint& inside, const GridPoint& outside) const;

  const VisualHull& hull_;
  const HullGrid& grid_;
  std::vector<PointProjection> projections_;  // by camera, as these
  std::vector<LabelRaster> rasters_;
  std::vector<LabelRaster> outlines_;  // empty where the rig doesn't ask for sight
  // The grid points in the workspace: along each axis from `first` to `last`.
  GridPoint first_, last_;
};

}  // namespace elbowroom::recon
