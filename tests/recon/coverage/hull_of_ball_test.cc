// The phantom share against the program's own hull of masks that show a ball.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdio>
#include <memory>
#include <numbers>

#include "core/triangle_mesh.h"
#include "recon/coverage/ball_hull.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/recon/coverage/ball_rigs.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// The mesh's chords of 6 mm cut a ball of 200 mm, the ball's share is counted with 40,000 points, and the 60
// rays are off by up to 0.004.
constexpr double kShareTolerance = 0.012;
constexpr double kRadiusMm = 100.0;
constexpr double kEdgeMm = 6.0;

// Of the ball, what is in the hull and in the workspace, by points.
double BallInHullMm3(const VisualHull& hull, const Vector3d& center_mm) {
  constexpr int kPoints = 40000;
  Random random(7);
  int inside = 0;
  for (int i = 0; i < kPoints; ++i) {
    const Vector3d x = center_mm + kRadiusMm * std::cbrt(random.Uniform(0.0, 1.0)) * random.Direction();
    inside += hull.Contains(x) ? 1 : 0;
  }
  return 4.0 / 3.0 * std::numbers::pi * std::pow(kRadiusMm, 3) * inside / kPoints;
}

struct Outcome {
  int asked = 0;
  double worst = 0.0;
};

void HoldToTheHull(const core::Rig& rig, const Vector3d& center_mm, Outcome* outcome) {
  BallHull::Scratch scratch;
  const auto volume = BallHull(rig).At(center_mm, kRadiusMm, &scratch);
  if (!volume) return;
  const auto shared = std::make_shared<const core::Rig>(rig);
  const VisualHull hull = MakeVisualHull(shared, MasksOfBall(rig, center_mm, kRadiusMm));
  const double hull_mm3 = core::VolumeMm3(MeshHull(hull, kEdgeMm).mesh);
  const double truth = 1.0 - BallInHullMm3(hull, center_mm) / hull_mm3;
  EXPECT_NEAR(volume->phantom_fraction(), truth, kShareTolerance)
      << rig.name << (rig.unseen == core::UnseenPolicy::kAbstain ? ", abstain" : "") << " at "
      << center_mm.transpose() << ": " << volume->hull_mm3 << " and " << hull_mm3 << " mm3";
  ++outcome->asked;
  outcome->worst = std::max(outcome->worst, std::abs(volume->phantom_fraction() - truth));
}

// The rig with the part of its workspace that is near the place.
core::Rig Around(core::Rig rig, const Vector3d& place_mm) {
  constexpr double kReachMm = 300.0;
  rig.workspace_mm = rig.workspace_mm.intersection(
      {place_mm - Vector3d::Constant(kReachMm), place_mm + Vector3d::Constant(kReachMm)});
  return rig;
}

TEST(BallHull, IsTheHullThatTheProgramMakesOfItsMasks) {
  Random random(11);
  Outcome outcome;
  for (core::Rig rig : {PaperRig(), FourCameraRig(), EightCameraRig()}) {
    for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
      rig.unseen = unseen;
      // The hulls of `abstain` reach to the workspace's end; most are looked at in a smaller space.
      const bool is_whole = unseen == core::UnseenPolicy::kOutside || rig.cameras.size() == 4;
      HoldToTheHull(is_whole ? rig : Around(rig, rig.workspace_mm.center()), rig.workspace_mm.center(),
                    &outcome);
      HoldToTheHull(Around(rig, rig.workspace_mm.min() + Vector3d::Constant(40.0)),
                    rig.workspace_mm.min() + Vector3d::Constant(40.0), &outcome);
      for (int i = 0; i < 4; ++i) {
        const Vector3d place = random.PointIn(rig.workspace_mm);
        HoldToTheHull(Around(rig, place), place, &outcome);
      }
    }
  }
  std::printf("%d balls: worst difference of the phantom share %.4f\n", outcome.asked, outcome.worst);
  EXPECT_GE(outcome.asked, 12);
}

TEST(BallHull, IsTheHullWherePicturesCutTheBall) {
  // Long lenses: the ball is in part outside of most pictures.
  Random random(12);
  Outcome outcome;
  for (int i = 0; i < 12; ++i) {
    std::vector<Vector3d> eyes;
    for (int camera = random.Whole(2, 5); camera > 0; --camera)
      eyes.push_back(random.Uniform(900.0, 1500.0) * random.Direction());
    const auto unseen = i % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    HoldToTheHull(RigAt(eyes, 4000.0, Cube(250.0), unseen), random.Uniform(60.0, 110.0) * random.Direction(),
                  &outcome);
  }
  std::printf("%d balls at pictures' borders: worst difference %.4f\n", outcome.asked, outcome.worst);
  EXPECT_GE(outcome.asked, 8);
}

}  // namespace
}  // namespace elbowroom::recon
