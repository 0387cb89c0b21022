#include "tests/accuracy/hard/hard_hulls.h"

#include <cmath>
#include <variant>

#include "core/error.h"
#include "core/units.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "recon/synthetic/actors.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

const Vector3d kGrey = Vector3d::Constant(200.0);

recon::FingerBend Bend(double base_deg, double middle_deg, double tip_deg) {
  return {core::RadiansFromDegrees(base_deg), core::RadiansFromDegrees(middle_deg),
          core::RadiansFromDegrees(tip_deg)};
}

// The right hand before the cameras, its fingers towards -x, its back up.
recon::SyntheticObject HandAt(const Vector3d& wrist_in_world, const recon::HandShape& shape,
                              const Vector3d& elbow_in_world) {
  core::RigidTransform world_from_wrist{Eigen::Matrix3d::Identity(), wrist_in_world};
  world_from_wrist.rotation.diagonal() << -1.0, -1.0, 1.0;
  return recon::Hand(world_from_wrist, shape, elbow_in_world);
}

recon::SyntheticObject Fist() {
  recon::HandShape shape = recon::TongsPinch();  // its thumb lies across the fingers
  shape.fingers.fill(Bend(85.0, 95.0, 60.0));
  return HandAt({70.0, 0.0, 210.0}, shape, {330.0, 50.0, 250.0});
}

recon::SyntheticObject SpreadFingers() {
  recon::SyntheticObject hand{"fingers", {}};
  for (int i = 0; i < 5; ++i) {
    const double angle = 0.45 * (i - 2);
    const Vector3d along(std::cos(angle), std::sin(angle), 0.15);
    const Vector3d knuckle = Vector3d(60.0, 0.0, 150.0) + 40.0 * along;
    hand.solids.push_back(recon::CapsuleBetween(knuckle, knuckle + 90.0 * along, 8.0, kGrey));
  }
  return hand;
}

recon::SyntheticObject ReachingHand() {
  recon::HandShape shape;  // all joints stretched, the thumb as well
  shape.thumb.fill({core::RadiansFromDegrees(10.0), core::RadiansFromDegrees(10.0)});
  return HandAt({110.0, 0.0, 210.0}, shape, {340.0, 0.0, 200.0});
}

recon::SyntheticObject TwoPeople() {
  recon::SyntheticObject people{"people", {}};
  for (const double side : {-1.0, 1.0}) {
    const Vector3d hip(140.0, 130.0 * side, 60.0), neck(140.0, 130.0 * side, 260.0);
    people.solids.push_back(recon::CapsuleBetween(hip, neck, 60.0, kGrey));
    people.solids.push_back(recon::CapsuleBetween(neck, {20.0, 40.0 * side, 180.0}, 25.0, kGrey));
  }
  return people;
}

recon::SyntheticObject ThinObjectOf(HardHull hull) {
  switch (hull) {
    case HardHull::kFist:
      return Fist();
    case HardHull::kSpreadFingers:
      return SpreadFingers();
    case HardHull::kReachingHand:
      return ReachingHand();
    case HardHull::kTwoPeople:
      return TwoPeople();
  }
  throw core::PreconditionError("a hard hull");
}

// Of many seeded points of the box, the one that is sure to be deepest in the hull.
Vector3d MiddleOf(const recon::VisualHull& hull, const Eigen::AlignedBox3d& box_mm) {
  constexpr int kPoints = 4000;
  constexpr std::uint64_t kSeed = 551;
  recon::Random random(kSeed);
  Vector3d middle = box_mm.center();
  double deepest_mm = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const Vector3d x = random.PointIn(box_mm);
    const recon::PointAnswer answer = hull.Probe(x);
    if (!answer.is_inside || answer.radius_mm <= deepest_mm) continue;
    deepest_mm = answer.radius_mm;
    middle = x;
  }
  return middle;
}

}  // namespace

std::string_view ToString(HardHull hull) {
  switch (hull) {
    case HardHull::kFist:
      return "fist";
    case HardHull::kSpreadFingers:
      return "spread fingers";
    case HardHull::kReachingHand:
      return "reaching hand";
    case HardHull::kTwoPeople:
      return "two people";
  }
  throw core::PreconditionError("a hard hull");
}

recon::SyntheticObject ObjectOf(HardHull hull, double thicker_mm) {
  recon::SyntheticObject object = ThinObjectOf(hull);
  for (recon::Solid& solid : object.solids) std::get<recon::Capsule>(solid.shape).radius_mm += thicker_mm;
  return object;
}

SeenHull SeeHull(HardHull which, recon::ViewSceneRig rig) {
  constexpr double kMeshMm = 4.0;
  const auto shared = std::make_shared<const core::Rig>(recon::MakeViewScene(rig).rig);
  SeenHull seen;
  seen.which = which;
  seen.hull = std::make_shared<const recon::VisualHull>(
      recon::MakeVisualHull(shared, recon::TrueMasks(*shared, {ObjectOf(which)})));
  seen.surface_mm = recon::MeshHull(*seen.hull, kMeshMm).mesh.vertices_mm;
  for (const Vector3d& x : seen.surface_mm) seen.box_mm.extend(x);
  seen.middle_mm = MiddleOf(*seen.hull, seen.box_mm);
  return seen;
}

}  // namespace elbowroom::accuracy
