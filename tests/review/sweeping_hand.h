// A hand of analytic solids before the demo's cameras, in the way of a curtain.
#pragma once

#include <memory>
#include <vector>

#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::review {

// Where the curtain (curtain.h) hangs in the tests: over the table's middle, lower edge 40 mm above it.
[[nodiscard]] core::RigidTransform WorldFromCurtain();

// The open hand and its forearm, upright fingers, its palm facing along y, at y_mm; the forearm comes from
// the right (+x).
[[nodiscard]] std::vector<recon::SyntheticObject> HandAt(double y_mm);
// An upright pipe 20 mm across, end first: along y, its front end at y_mm.
[[nodiscard]] std::vector<recon::SyntheticObject> RodAt(double x_mm, double y_mm, double z_mm);

// The demo's hand as its four cameras see it, its fingers towards -x, pushed 90 mm along them and back in
// `frames` frames.
[[nodiscard]] std::vector<std::shared_ptr<const recon::VisualHull>> PokingHand(int frames);

// What the four cameras of the demo's rig make of it.
[[nodiscard]] std::shared_ptr<const recon::VisualHull> HullOf(
    const std::vector<recon::SyntheticObject>& objects);

}  // namespace elbowroom::review
