// CP_hull, N_hull and their uncertainties on balls as sharp cameras see them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/units.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/view_scene.h"
#include "review/recovery.h"
#include "review/recovery_uncertainty.h"
#include "tests/oracles/coverage_mask.h"
#include "tests/oracles/mask_hull_oracle.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using recon::Random;

constexpr double kSmallestBallMm = 20.0, kLargestBallMm = 60.0;
constexpr double kOffCentre = 0.3;  // of the radius: how far CP_obj is from the centre, at most
constexpr double kReferenceMm = 250.0;
// The bounds are of first order; a round surface adds a little of second.
constexpr double kFirstOrder = 1.05;
constexpr double kSharpPicturePx = 2.0;  // a lens as sharp as its sensor

double DegreesBetween(const Vector3d& a, const Vector3d& b) {
  return core::DegreesFromRadians(std::atan2(a.cross(b).norm(), a.dot(b)));
}

struct Scene {
  explicit Scene(Random* random)
      : rig(std::make_shared<const core::Rig>(recon::MakeViewScene(recon::ViewSceneRig::kThree).rig)),
        center(random->Uniform(-150, 150), random->Uniform(-150, 150), random->Uniform(150, 350)),
        radius_mm(random->Uniform(kSmallestBallMm, kLargestBallMm)) {
    const std::vector<recon::Solid> solids = {
        {recon::Sphere{radius_mm}, {Eigen::Matrix3d::Identity(), center}, Vector3d::Constant(200.0)}};
    for (const core::CameraModel& camera : rig->cameras)
      masks.push_back(oracles::CoverageMask(camera, solids, kSharpPicturePx));
  }

  std::shared_ptr<const core::Rig> rig;
  Vector3d center;
  double radius_mm;
  std::vector<core::SoftMask> masks;
};

// Out of the ball's hull of perfect cameras; nothing within `edge_mm` of where another camera's cone ends it.
std::optional<Vector3d> NormalAt(const Scene& scene, const Vector3d& x, double edge_mm) {
  std::vector<std::pair<double, Vector3d>> cones;
  for (const core::CameraModel& camera : scene.rig->cameras) {
    const Vector3d sight = (x - camera.center_in_world()).normalized();
    const Vector3d from_center = camera.center_in_world() - scene.center;
    const Vector3d out = from_center - from_center.dot(sight) * sight;
    cones.emplace_back(out.norm() - scene.radius_mm, out.normalized());
  }
  std::ranges::sort(cones, [](const auto& a, const auto& b) { return a.first > b.first; });
  if (cones[1].first > cones[0].first - edge_mm) return std::nullopt;
  return cones[0].second;
}

TEST(RecoveryAccuracy, HullPointToAFiftiethOfAMillimetreAndNormalToADegree) {
  constexpr double kHullPointMm = 0.02, kMarchMm = 0.002, kEdgeMm = 3.0, kNormalDeg = 1.0;
  Random random(7601);
  std::vector<double> normal_deg;
  for (int ball = 0; ball < 4; ++ball) {
    const Scene scene(&random);
    const recon::VisualHull hull = recon::MakeVisualHull(scene.rig, scene.masks);
    const oracles::MaskHullOracle oracle(*scene.rig, scene.masks,
                                         oracles::BoundaryConvention::kMarchingSquares);
    for (int ray = 0; ray < 40; ++ray) {
      const Vector3d v_rec = random.Direction();
      const Vector3d cp_obj =
          scene.center + random.Uniform(0.0, kOffCentre) * scene.radius_mm * random.Direction();
      const Vector3d rp_obj = cp_obj + kReferenceMm * v_rec;
      const RecoveryAnswer answer = Recover(hull, cp_obj, {.rp_obj = rp_obj});
      ASSERT_EQ(answer.status, core::RecoveryStatus::kFound);
      const auto marched_mm = oracle.FirstSurface({rp_obj, -v_rec}, 0.0, {.step_mm = kMarchMm});
      ASSERT_TRUE(marched_mm);
      const Vector3d& cp_hull = answer.recovery->cp_hull_in_world_mm;
      EXPECT_LE((cp_hull - (rp_obj - *marched_mm * v_rec)).norm(), kHullPointMm);
      const std::optional<Vector3d> normal = NormalAt(scene, cp_hull, kEdgeMm);
      if (normal) normal_deg.push_back(DegreesBetween(answer.recovery->n_hull_in_world.value(), *normal));
    }
  }
  ASSERT_GT(normal_deg.size(), 80U);
  std::ranges::sort(normal_deg);
  EXPECT_LE(normal_deg.back(), kNormalDeg);
}

// The same silhouettes as cameras see them whose principal points are off by just so much.
recon::VisualHull ShiftedHull(const Scene& scene, double shift_px, Random* random) {
  core::Rig rig = *scene.rig;
  rig.cameras.clear();
  for (const core::CameraModel& camera : scene.rig->cameras) {
    core::CameraCalibration calibration = camera.calibration();
    const double angle_rad = random->Uniform(-std::numbers::pi, std::numbers::pi);
    calibration.camera_matrix(0, 2) += shift_px * std::cos(angle_rad);
    calibration.camera_matrix(1, 2) += shift_px * std::sin(angle_rad);
    rig.cameras.emplace_back(std::move(calibration));
  }
  return recon::MakeVisualHull(std::make_shared<const core::Rig>(std::move(rig)), scene.masks);
}

core::PartContact ContactOf(const RecoveryAnswer& answer) {
  core::PartContact contact;
  contact.verdict = core::Verdict::kContact;
  contact.recovery_status = answer.status;
  contact.recovery = answer.recovery;
  return contact;  // of a part that is one point: nothing is lost to resolution
}

TEST(RecoveryAccuracy, ShiftedSilhouettesStayWithinTheUncertainty) {
  Random random(7602);
  int compared = 0, grazing = 0, at_edge = 0;
  double used = 0.0;
  for (int trial = 0; trial < 5; ++trial) {
    const Scene scene(&random);
    const recon::VisualHull hull = recon::MakeVisualHull(scene.rig, scene.masks);
    const double shift_px = random.Uniform(0.1, 1.0);
    const recon::VisualHull shifted = ShiftedHull(scene, shift_px, &random);
    for (int ray = 0; ray < 160; ++ray) {
      const Vector3d cp_obj =
          scene.center + random.Uniform(0.0, kOffCentre) * scene.radius_mm * random.Direction();
      const RecoveryWay way = ray % 2 == 0 ? RecoveryWay{.rp_obj = cp_obj + kReferenceMm * random.Direction()}
                                           : RecoveryWay{.kind = core::RecoveryKind::kDirection,
                                                         .rp_obj = scene.center,
                                                         .axis = random.Direction()};
      const RecoveryAnswer answer = Recover(hull, cp_obj, way), other = Recover(shifted, cp_obj, way);
      ASSERT_EQ(answer.status, core::RecoveryStatus::kFound);
      const RecoveryUncertainty bound = UncertaintyOf(hull, ContactOf(answer), way, shift_px);
      at_edge += bound.is_at_edge ? 1 : 0;
      if (!bound.cp_hull_mm) {
        ++grazing;
        continue;
      }
      ++compared;
      const core::Recovery &a = *answer.recovery, &b = *other.recovery;
      const double moved_mm = (a.cp_hull_in_world_mm - b.cp_hull_in_world_mm).norm();
      EXPECT_LE(moved_mm, *bound.cp_hull_mm * kFirstOrder)
          << trial << " " << ray << " at edge " << bound.is_at_edge;
      EXPECT_LE(std::abs(a.d_rec_mm - b.d_rec_mm), *bound.d_rec_mm * kFirstOrder);
      EXPECT_LE(core::RadiansFromDegrees(DegreesBetween(*a.n_hull_in_world, *b.n_hull_in_world)),
                *bound.n_hull_rad * kFirstOrder)
          << trial << " " << ray << " at edge " << bound.is_at_edge;
      used = std::max(used, moved_mm / *bound.cp_hull_mm);
    }
  }
  EXPECT_GT(compared, 500);
  EXPECT_GT(at_edge, 20);
  EXPECT_LT(grazing, compared / 10);
  EXPECT_GT(used, 0.5) << "a bound that nothing comes near says nothing";
}

}  // namespace
}  // namespace elbowroom::review
