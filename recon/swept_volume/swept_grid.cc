#include "recon/swept_volume/swept_grid.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr double kMostCellsASide = 1 << 20;

// More than what float32 and the arithmetic of the planes take from a coordinate, as a share of it: 32 times
// float32's rounding, since a vertex moves as far as its value changes times the steepness of the values.
constexpr double kRoundingShare = 2e-6;

// The lowest 21 bits, two zeros between each and the next.
std::uint64_t Spread(std::uint64_t bits) {
  bits = (bits | bits << 32U) & 0x001F00000000FFFFU;
  bits = (bits | bits << 16U) & 0x001F0000FF0000FFU;
  bits = (bits | bits << 8U) & 0x100F00F00F00F00FU;
  bits = (bits | bits << 4U) & 0x10C30C30C30C30C3U;
  return (bits | bits << 2U) & 0x1249249249249249U;
}

}  // namespace

SweptGrid MakeSweptGrid(const Eigen::AlignedBox3d& workspace_mm, double edge_mm) {
  if (!(edge_mm > 0.0) || !std::isfinite(edge_mm)) {
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("swept volume: the edge must be positive, not {} mm", edge_mm));
  }
  const Eigen::Vector3d cells = (workspace_mm.sizes() / edge_mm).array().ceil().max(1.0);
  if (cells.maxCoeff() >= kMostCellsASide) {
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format(
            "swept volume: edges of {} mm need {:.0f} cells a side, more than 2^20; choose --edge {:.3g}",
            edge_mm, cells.maxCoeff(), 2.0 * workspace_mm.sizes().maxCoeff() / kMostCellsASide));
  }
  const double largest_mm =
      std::max(workspace_mm.min().cwiseAbs().maxCoeff(), workspace_mm.max().cwiseAbs().maxCoeff());
  return {workspace_mm.min(), workspace_mm.sizes().cwiseQuotient(cells), cells.cast<int>(),
          kRoundingShare * largest_mm};
}

std::uint64_t CurveKey(const GridCell& cube) {
  const auto bits = [](int number) { return Spread(static_cast<std::uint64_t>(number + 1)); };
  return bits(cube.x()) | bits(cube.y()) << 1U | bits(cube.z()) << 2U;
}

}  // namespace elbowroom::recon
