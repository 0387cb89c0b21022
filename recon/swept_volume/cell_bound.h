// What a hull asks of the values at a cell's corners so that all of it in the cell has an interpolated value
// of at most 0.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "recon/hull/visual_hull_declared.h"
#include "recon/swept_volume/kuhn_cell.h"

namespace elbowroom::recon {

// By corner, in mm. A corner's value must be at most this; infinite: may be anything.
using CornerLimits = std::array<double, kCellCorners>;

// A cell: the box from `low` on, with its sides along the world's axes.
struct CellBox {
  Eigen::Vector3d low_in_world;
  Eigen::Vector3d sides_mm;
};

struct BoundOptions {
  double rounding_mm = 0.0;  // limits are lower by this
  double least_mm = 0.0;     // a limit nearer to 0 than this becomes -least_mm
};

// One camera's contour, or a face of the workspace, has a plane beyond which a cell holds nothing of the
// hull: the distances of the corners to it are limits. Of all planes that are tried the one that lowers
// `values`, which the corners have so far, least, where values below 0 count a twentieth. Nothing: the cell
// holds no point of the hull. A cell of which no plane cuts off anything is taken as all hull. Cameras that
// `open` doesn't ask give no plane. Derivation in docs/keep_out.md. Thread: any.
[[nodiscard]] std::optional<CornerLimits> LimitsOf(const VisualHull& hull, const CellBox& cell,
                                                   const UndecidedCameras& open, const CornerLimits& values,
                                                   const BoundOptions& options);

// The limits of a cell that is all hull.
[[nodiscard]] CornerLimits LimitsOfWholeCell(const BoundOptions& options);

}  // namespace elbowroom::recon
