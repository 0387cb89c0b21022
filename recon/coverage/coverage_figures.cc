#include "recon/coverage/coverage_figures.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace elbowroom::recon {

CoverageFigures FiguresOf(std::span<const CoverageNode> nodes) {
  CoverageFigures figures;
  figures.nodes = nodes.size();
  if (nodes.empty()) return figures;
  std::vector<double> sigmas_mm, footprints_mm, cameras, phantoms;
  std::size_t unseen = 0, seen = 0, in_reach = 0;
  figures.fewest_cameras = nodes.front().cameras;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const CoverageNode& node = nodes[i];
    cameras.push_back(node.cameras);
    figures.fewest_cameras = std::min(figures.fewest_cameras, static_cast<int>(node.cameras));
    unseen += node.cameras == 0 ? 1 : 0;
    seen += node.cameras >= 2 ? 1 : 0;
    in_reach += node.in_reach ? 1 : 0;
    if (node.cameras > 0) footprints_mm.push_back(node.footprint_mm);
    if (node.has_sigma) {
      sigmas_mm.push_back(node.sigma_mm);
      if (!figures.worst_sigma || node.sigma_mm > nodes[*figures.worst_sigma].sigma_mm)
        figures.worst_sigma = i;
    }
    if (node.has_phantom) {
      phantoms.push_back(node.phantom);
      if (!figures.worst_phantom || node.phantom > nodes[*figures.worst_phantom].phantom)
        figures.worst_phantom = i;
    }
  }
  const auto count = static_cast<double>(nodes.size());
  figures.unseen_share = static_cast<double>(unseen) / count;
  figures.seen_share = static_cast<double>(seen) / count;
  figures.reach_share = static_cast<double>(in_reach) / count;
  figures.without_sigma = nodes.size() - sigmas_mm.size();
  figures.without_phantom = nodes.size() - phantoms.size();
  figures.uncertainty_mm = core::SpreadOf(std::move(sigmas_mm));
  figures.footprint_mm = core::SpreadOf(std::move(footprints_mm));
  figures.cameras_seeing = core::SpreadOf(std::move(cameras));
  figures.phantom_fraction = core::SpreadOf(std::move(phantoms));
  return figures;
}

}  // namespace elbowroom::recon
