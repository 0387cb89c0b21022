// Where a ray enters or leaves the hull, found by steps of certified radii: cheap where the answer is near.
#pragma once

#include <optional>

#include "recon/hull/ray.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::review {

// Distance along the ray to its first point found in the hull; 0 if it starts there. Nothing: there is none
// before `reach_mm`. Each step is the certified radius, but at least kEntryStepMm, so hull that is thinner
// along the ray may be missed. `recon::FirstInside` misses nothing and costs more. Thread: any.
inline constexpr double kEntryStepMm = 1.0;
[[nodiscard]] std::optional<double> EntryAlong(const recon::VisualHull& hull, const recon::Ray& ray,
                                               double reach_mm);

// Distance along the ray to its first point found outside of the hull; 0 if it starts there. That
// point is no more than kExitStepMm beyond the end of the hull. Nothing: there is none before `reach_mm`.
// Thread: any.
inline constexpr double kExitStepMm = 0.25;
[[nodiscard]] std::optional<double> ExitAlong(const recon::VisualHull& hull, const recon::Ray& ray,
                                              double reach_mm);

}  // namespace elbowroom::review
