// The hull coloured by how well its rig knows it.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/rig.h"
#include "core/rig_quality.h"
#include "recon/appearance/hull_appearance.h"
#include "recon/exact_view/hull_view.h"
#include "recon/exact_view/view_rays.h"
#include "recon/hull/visual_hull_declared.h"
#include "recon/surface_quality/surface_coverage.h"
#include "recon/surface_quality/surface_uncertainty.h"

namespace elbowroom::control {

// What is known of a trial's rig. Immutable.
struct RigKnowledge {
  core::Rig rig;
  core::RigErrors errors;
  bool has_covariance = false;  // false: the cameras are taken as exact, and the true error is larger
  bool is_refuted = false;      // by its gauge
  double most_mm = 1.0;         // the end of the scale for the surface's uncertainty, a round number
};

using SharedRigKnowledge = std::shared_ptr<const RigKnowledge>;

// Without errors, or where the trial says itself what verdicts allow for, cameras are taken as exact. The
// scale ends at twice the uncertainty in the workspace's middle.
[[nodiscard]] SharedRigKnowledge KnowledgeOf(const core::Rig& rig, const core::RigQuality& quality);

// Whether the appearance shows what is known of the rig.
[[nodiscard]] bool ShowsKnowledge(recon::HullAppearance appearance);

// Keeps what the next picture can use again: the tables of a rig, and the hull as its cameras see it. Thread:
// one.
class HullColors {
 public:
  // One a pixel of `picture`, which has surfaces and normals: pale where most cameras see the place or the
  // uncertainty is small, dark red where none does or it is large, grey where no silhouette bounds the hull.
  // `whole`: the hull; `shown`: what of it the picture shows. Nothing for an appearance that doesn't
  // ShowsKnowledge, and for the hull of another rig.
  [[nodiscard]] std::vector<recon::CameraColor> Of(recon::HullAppearance appearance,
                                                   const SharedRigKnowledge& knowledge,
                                                   const std::shared_ptr<const recon::VisualHull>& whole,
                                                   const recon::VisualHull& shown,
                                                   const recon::HullView& picture,
                                                   const recon::ViewRays& rays);

  [[nodiscard]] std::int64_t looks() const { return looks_; }  // of all cameras at a hull, since the start

 private:
  SharedRigKnowledge knowledge_;  // that the next two are of
  std::optional<recon::SurfaceCoverage> coverage_;
  std::optional<recon::SurfaceUncertainty> uncertainty_;
  std::weak_ptr<const recon::VisualHull> looked_at_;
  std::int64_t looks_ = 0;
};

}  // namespace elbowroom::control
