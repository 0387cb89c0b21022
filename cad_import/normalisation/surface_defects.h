// Where a model's surfaces are open, ambiguous or run through themselves: the places behind the counts of an
// import.
#pragma once

#include <Eigen/Core>
#include <array>
#include <stop_token>
#include <utility>
#include <vector>

#include "cad_import/model/cad_model.h"
#include "core/progress.h"

namespace elbowroom::cad_import {

// All in the model's frame, mm.
struct SurfaceDefects {
  using Segment = std::pair<Eigen::Vector3d, Eigen::Vector3d>;
  std::vector<Segment> open_edges;                       // of one triangle
  std::vector<Segment> non_manifold_edges;               // of three or more
  std::vector<Segment> inconsistent_edges;               // of two triangles that face different ways
  std::vector<std::array<Eigen::Vector3d, 3>> crossing;  // they meet others elsewhere than in shared corners
};

// Holds the defects of every instance. Crossing triangles are looked for in shapes that are known to have
// some, or that weren't looked through yet. Throws: Error{kCancelled}.
[[nodiscard]] SurfaceDefects FindDefects(const CadModel& model, const core::Progress& progress = {},
                                         const std::stop_token& stop = {});

}  // namespace elbowroom::cad_import
