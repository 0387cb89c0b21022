// Bounds of hulls in a few bytes: what they cost, and how many hulls they would spare when a part changes.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "recon/hull/visual_hull_declared.h"
#include "tests/accuracy/scale/measured_sweep.h"

namespace elbowroom::accuracy {

// Boxes (world, mm) that hold all of a hull: the leaves of an octree over the workspace that the hull's own
// queries don't show to be outside. They are certain, since these queries are.
struct HullBound {
  std::vector<Eigen::AlignedBox3d> boxes;
  std::int64_t nodes = 0;  // of the octree; each is outside, whole or split: two bits

  [[nodiscard]] std::int64_t bytes() const { return (2 * nodes + 7) / 8; }
  [[nodiscard]] Eigen::AlignedBox3d Around() const;
  // Of the nearest box; infinite without boxes.
  [[nodiscard]] double DistanceMm(const Eigen::AlignedBox3d& to_mm) const;
};
// `edge_mm`: of the smallest boxes, at most.
[[nodiscard]] HullBound BoundOf(const recon::VisualHull& hull, double edge_mm);

// docs/scale.md, "hulls": a frame's hull, its bounds and its grids in time and bytes; "hull_bounds": hulls
// that a changed bracket needs with and without bounds. Of a few sessions of the cohort.
void MeasureHullBounds(const std::filesystem::path& docs, const SimulatedCohort& cohort);

}  // namespace elbowroom::accuracy
