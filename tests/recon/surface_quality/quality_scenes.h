// Hulls of known solids seen by rigs of three, four and eight cameras: the ground for what is said of a
// surface.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "core/rig.h"
#include "recon/exact_view/view_rays.h"
#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {

struct QualityScene {
  std::string name;
  std::shared_ptr<const core::Rig> rig;
  std::shared_ptr<const VisualHull> hull;
  Eigen::Vector3d middle_in_world;
};

// A hand and a rod, two boxes one behind the other, a ball beside a plate.
inline constexpr int kQualityShapes = 3;
// The paper's three cameras, the demo's four, and eight.
inline constexpr int kQualityRigs = 3;

// Made once a process. `is_soft`: silhouettes located between pixels.
[[nodiscard]] QualityScene MakeQualityScene(int rig, int shape, bool is_soft = true);
[[nodiscard]] std::vector<QualityScene> QualityScenes(bool is_soft = true);

// Two views of the scene, one from between the cameras.
[[nodiscard]] std::vector<ViewRays> ViewsOf(const QualityScene& scene);

// Errors of calibration as they are, correlated within a camera and between cameras.
[[nodiscard]] Eigen::MatrixXd DrawCovariance(const core::Rig& rig, Random* random);

}  // namespace elbowroom::recon
