#include "tests/review/sweeping_hand.h"

#include <cmath>
#include <numbers>

#include "recon/hull/visual_hull.h"
#include "recon/synthetic/actors.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/view_scene.h"

namespace elbowroom::review {

using Eigen::Vector3d;

core::RigidTransform WorldFromCurtain() { return {Eigen::Matrix3d::Identity(), Vector3d(0.0, 0.0, 400.0)}; }

std::vector<recon::SyntheticObject> HandAt(double y_mm) {
  // Wrist frame: x along the fingers, here up; z out of the back of the hand, here along y.
  core::RigidTransform world_from_wrist;
  world_from_wrist.rotation.col(0) = Vector3d(-0.6, 0.0, 0.8);
  world_from_wrist.rotation.col(2) = Vector3d(0.0, 1.0, 0.0);
  world_from_wrist.rotation.col(1) = world_from_wrist.rotation.col(2).cross(world_from_wrist.rotation.col(0));
  world_from_wrist.translation_mm = Vector3d(60.0, y_mm, 130.0);
  return {recon::Hand(world_from_wrist, recon::OpenHand(), {260.0, y_mm, 60.0})};
}

std::vector<recon::SyntheticObject> RodAt(double x_mm, double y_mm, double z_mm) {
  const Vector3d end_in_world(x_mm, y_mm, z_mm);
  constexpr double kRadiusMm = 8.0, kLengthMm = 250.0;
  return {{"rod",
           {recon::CapsuleBetween(end_in_world, end_in_world - kLengthMm * Vector3d::UnitY(), kRadiusMm,
                                  Vector3d::Constant(200.0))}}};
}

std::vector<std::shared_ptr<const recon::VisualHull>> PokingHand(int frames) {
  constexpr double kReachMm = 90.0;
  constexpr double kHandIsInS = 5.0;  // of the demo's task
  std::vector<std::shared_ptr<const recon::VisualHull>> hulls;
  for (int i = 0; i < frames; ++i) {
    std::vector<recon::SyntheticObject> objects = recon::DemoSceneAt(kHandIsInS).objects;
    const double along_mm = 0.5 * kReachMm * (1.0 - std::cos(2.0 * std::numbers::pi * i / frames));
    for (recon::SyntheticObject& object : objects)
      for (recon::Solid& solid : object.solids) solid.world_from_solid.translation_mm.x() -= along_mm;
    hulls.push_back(HullOf(objects));
  }
  return hulls;
}

std::shared_ptr<const recon::VisualHull> HullOf(const std::vector<recon::SyntheticObject>& objects) {
  static const auto rig = std::make_shared<const core::Rig>(recon::FourCameraRig());
  return std::make_shared<const recon::VisualHull>(
      recon::MakeVisualHull(rig, recon::TrueMasks(*rig, objects)));
}

}  // namespace elbowroom::review
