// Where a straight way enters or leaves the hull, by certified balls: cheap where the answer is near.
#pragma once

#include <optional>

#include "recon/hull/ray.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::review {

// Distance along the ray of a first hull point, 0 if it starts in the hull; nothing before `reach_mm`. Each
// step is the certified radius, but at least kEntryStepMm: what is thinner along the ray may be stepped over.
// `recon::FirstInside` misses nothing and costs more. Thread: any.
inline constexpr double kEntryStepMm = 1.0;
[[nodiscard]] std::optional<double> EntryAlong(const recon::VisualHull& hull, const recon::Ray& ray,
                                               double reach_mm);

// Distance along the ray of a first point that isn't in the hull, no more than kExitStepMm beyond the hull's
// end; 0 if it starts outside; nothing before `reach_mm`. Thread: any.
inline constexpr double kExitStepMm = 0.25;
[[nodiscard]] std::optional<double> ExitAlong(const recon::VisualHull& hull, const recon::Ray& ray,
                                              double reach_mm);

}  // namespace elbowroom::review
