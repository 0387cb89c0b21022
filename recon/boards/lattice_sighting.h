// From a lattice of found points to a sighting.
#pragma once

#include <opencv2/core/types.hpp>
#include <optional>

#include "recon/boards/board.h"
#include "recon/boards/board_sighting.h"
#include "recon/boards/point_lattice.h"

namespace elbowroom::recon {

// Finds each point once more, at its own place and with the squares that its neighbours give. Points that
// aren't found again are left out.
void RefineLattice(PointLattice* lattice, const CellTrial& trial);

// The points with their numbers, as far as they agree with one plane (seen_plane.h). Nothing: fewer than
// `least_share` of the points that `numbering` has agree, or fewer than four points, or points on a line.
[[nodiscard]] std::optional<BoardSighting> SightingOf(const PointLattice& lattice,
                                                      const LatticeNumbering& numbering, const Board& board,
                                                      const cv::Size& picture, double least_share);

// The same of points that already have their numbers; square_mm is `board`'s.
[[nodiscard]] std::optional<BoardSighting> AgreeingSighting(std::vector<SightedPoint> points,
                                                            const Board& board, const cv::Size& picture,
                                                            double least_share);

}  // namespace elbowroom::recon
