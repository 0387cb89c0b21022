// The paper's error budget, one term at a time, on the paper's rig and a hand in the middle of it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/synthetic/solids.h"
#include "recon/synthetic/view_scene.h"
#include "tests/accuracy/depth_error.h"
#include "tests/accuracy/surface_picture.h"
#include "tests/oracles/analytic_hull.h"

namespace elbowroom::accuracy {

// What the terms are measured on. Thread: any.
struct BudgetScene {
  core::Rig rig;  // PaperRig()
  std::vector<recon::Solid> solids;
  core::CameraModel view;
  oracles::AnalyticHull hull;
  SurfacePicture hull_surface;    // of the analytic hull: the reference of all terms but the first
  SurfacePicture object_surface;  // of the solids
};

// Casts an analytic ray through every pixel of the view: 640 x 480 takes ten seconds.
[[nodiscard]] BudgetScene MakeBudgetScene(int view_width_px, int view_height_px);

enum class Convention { kNone, kSquares, kMarching };  // docs/accuracy.md, "Conventions"

struct BudgetTerm {
  std::string name;
  std::string paper;  // what the paper says of it, and where; empty: nothing
  Convention convention = Convention::kNone;
  bool is_random = false;          // worth several draws
  bool is_against_object = false;  // the reference is the object, not its hull
  double ceiling_mm = 0.0;         // root mean square distance to the surface that it stays below
  std::function<recon::DepthMap(const BudgetScene&, std::uint64_t seed, int stride)> view;
};

[[nodiscard]] std::vector<BudgetTerm> BudgetTerms();

struct BudgetEffort {
  int stride = 2;  // every so many-th pixel of the view in both directions
  int draws = 4;   // of random terms
};

// The same for the same effort, whatever the number of threads.
[[nodiscard]] DepthError MeasureTerm(const BudgetTerm& term, const BudgetScene& scene,
                                     const BudgetEffort& effort);

}  // namespace elbowroom::accuracy
