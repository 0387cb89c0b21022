// Real matter that stands inside a closed part without touching any of its faces.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/rigid_transform.h"
#include "recon/hull/visual_hull.h"
#include "review/inside_cells.h"

namespace elbowroom::review {

// A point of the hull inside a closed part no face of which the hull reaches; nothing if there is none, or
// the part isn't closed. The part's cells are refined by the ball query down to `cell_mm`: a hull thinner
// than that may be missed. Counts its queries in `*queries`.
[[nodiscard]] std::optional<Eigen::Vector3d> FindHullInside(const recon::VisualHull& hull,
                                                            const core::RigidTransform& world_from_part,
                                                            double cell_mm, InsideCells* cells,
                                                            std::int64_t* queries);

}  // namespace elbowroom::review
