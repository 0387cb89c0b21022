// Whether the squares between found corners have the colours that a board gives them.
#pragma once

#include <opencv2/core/mat.hpp>

#include "recon/boards/point_lattice.h"

namespace elbowroom::recon {

// The share of places inside the squares around the lattice's points that are light or dark as expected, of
// all places that are in the picture. `sign`: as SaddleFitOptions has it, of the point in cell (0, 0). Looks
// at the dark squares, and at the light ones too if they are `empty`.
[[nodiscard]] double ShareOfRightColors(const cv::Mat& grey, const PointLattice& lattice, int sign,
                                        bool empty);

// The sign of the point in a cell when that of cell (0, 0) is given.
[[nodiscard]] inline int SignAt(LatticeCell cell, int sign_at_origin) {
  return (cell.column + cell.row) % 2 == 0 ? sign_at_origin : -sign_at_origin;
}

}  // namespace elbowroom::recon
