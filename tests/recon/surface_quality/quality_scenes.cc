#include "tests/recon/surface_quality/quality_scenes.h"

#include <array>
#include <map>
#include <utility>

#include "recon/appearance/orbit_camera.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/solids.h"
#include "tests/oracles/coverage_mask.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;
const Vector3d kGrey = Vector3d::Constant(200.0);
constexpr std::array<const char*, kQualityShapes> kShapes = {"hand and rod", "two boxes", "ball and plate"};

std::vector<Solid> SolidsOf(const std::string& what, const Vector3d& middle) {
  const auto at = [&](const Vector3d& x) {
    return core::RigidTransform{Eigen::Matrix3d::Identity(), middle + x};
  };
  const auto finger = [&](const Vector3d& a, const Vector3d& b, double radius_mm) {
    return CapsuleBetween(middle + a, middle + b, radius_mm, kGrey);
  };
  if (what == "hand and rod")
    return {finger({-70, 0, 0}, {-10, 0, 0}, 38.0), finger({0, -25, 0}, {75, -35, 10}, 11.0),
            finger({0, 0, 0}, {85, 0, 15}, 11.0), finger({0, 25, 0}, {70, 35, 10}, 11.0),
            finger({20, -120, 60}, {90, 130, 20}, 16.0)};
  if (what == "two boxes")
    return {{Box{{60, 160, 120}}, at({-70, 0, 0}), kGrey}, {Box{{50, 120, 90}}, at({80, 20, 10}), kGrey}};
  return {{Sphere{60.0}, at({-60, -30, 10}), kGrey}, {Box{{20, 220, 160}}, at({60, 0, 0}), kGrey}};
}

core::Rig RigOf(int rig) {
  if (rig == 0) return PaperRig();
  return rig == 1 ? FourCameraRig() : EightCameraRig();
}

struct Seen {
  std::shared_ptr<const core::Rig> rig;
  std::vector<core::SoftMask> masks;
};

const Seen& SeenBy(int rig, int shape) {
  static std::map<std::pair<int, int>, Seen> made;
  Seen& seen = made[{rig, shape}];
  if (seen.rig != nullptr) return seen;
  seen.rig = std::make_shared<const core::Rig>(RigOf(rig));
  const std::vector<Solid> solids =
      SolidsOf(kShapes.at(static_cast<std::size_t>(shape)), seen.rig->workspace_mm.center());
  for (const core::CameraModel& camera : seen.rig->cameras)
    seen.masks.push_back(oracles::CoverageMask(camera, solids, 2.0));
  return seen;
}

}  // namespace

QualityScene MakeQualityScene(int rig, int shape, bool is_soft) {
  const Seen& seen = SeenBy(rig, shape);
  std::vector<core::SoftMask> masks = seen.masks;
  if (!is_soft)
    for (core::SoftMask& mask : masks) mask.levels.clear();
  return {
      std::to_string(seen.rig->cameras.size()) + " cameras, " + kShapes.at(static_cast<std::size_t>(shape)),
      seen.rig, std::make_shared<const VisualHull>(MakeVisualHull(seen.rig, masks)),
      seen.rig->workspace_mm.center()};
}

std::vector<QualityScene> QualityScenes(bool is_soft) {
  std::vector<QualityScene> scenes;
  for (int rig = 0; rig < kQualityRigs; ++rig)
    for (int shape = 0; shape < kQualityShapes; ++shape)
      scenes.push_back(MakeQualityScene(rig, shape, is_soft));
  return scenes;
}

std::vector<ViewRays> ViewsOf(const QualityScene& scene) {
  std::vector<ViewRays> views;
  for (const double azimuth_rad : {-0.9, 1.7}) {
    OrbitCamera camera;
    camera.target_in_world = scene.middle_in_world;
    camera.distance_mm = 900.0;
    camera.azimuth_rad = azimuth_rad;
    camera.elevation_rad = 0.45;
    camera.vertical_fov_rad = 0.4;
    views.emplace_back(CameraOf(ViewFrom(camera, 160, 120)));
  }
  return views;
}

Eigen::MatrixXd DrawCovariance(const core::Rig& rig, Random* random) {
  std::vector<double> sigmas;
  for (const core::CameraModel& camera : rig.cameras) {
    sigmas.insert(sigmas.end(), {0.5, 0.5, 0.6, 0.6});
    sigmas.insert(sigmas.end(), camera.calibration().distortion_coefficients.size(), 1e-3);
    sigmas.insert(sigmas.end(), {6e-4, 6e-4, 6e-4, 0.5, 0.5, 0.5, 0.0});
  }
  const auto count = static_cast<Eigen::Index>(sigmas.size());
  Eigen::MatrixXd factor = Eigen::MatrixXd::Identity(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < i; ++j) factor(i, j) = random->Uniform(-0.25, 0.25);
  for (Eigen::Index i = 0; i < count; ++i) factor.row(i) *= sigmas[static_cast<std::size_t>(i)];
  return factor * factor.transpose();
}

}  // namespace elbowroom::recon
