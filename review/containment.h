// A hull that stands inside a closed part without touching any of its faces.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"
#include "review/inside_cells.h"

namespace elbowroom::review {

// A point of the hull inside a closed part. The caller knows that the hull reaches no face of the part.
// Nothing if there is no such point or the part isn't closed. The part's cells are divided down to `cell_mm`:
// a hull thinner than that may be missed. Adds its queries of the hull to `*queries`.
[[nodiscard]] std::optional<Eigen::Vector3d> FindHullInside(const recon::VisualHull& hull,
                                                            const core::RigidTransform& world_from_part,
                                                            double cell_mm, InsideCells* cells,
                                                            std::int64_t* queries);

}  // namespace elbowroom::review
