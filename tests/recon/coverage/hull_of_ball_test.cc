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

// Pixels of 1 to 3 mm round a silhouette, and a hull's surface is meshed with steps of 10 mm: balls of 200 mm
// keep that below 2 % of the volume.
constexpr double kShareTolerance = 0.02;
constexpr double kRadiusMm = 100.0;
constexpr double kEdgeMm = 10.0;

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

TEST(BallHull, IsTheHullThatTheProgramMakesOfItsMasks) {
  Random random(11);
  Outcome outcome;
  for (core::Rig rig : {PaperRig(), FourCameraRig(), EightCameraRig()}) {
    for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
      rig.unseen = unseen;
      HoldToTheHull(rig, rig.workspace_mm.center(), &outcome);
      HoldToTheHull(rig, rig.workspace_mm.min() + Vector3d::Constant(40.0), &outcome);
      HoldToTheHull(rig, rig.workspace_mm.max() - Vector3d(30.0, 120.0, 20.0), &outcome);
      for (int i = 0; i < 2; ++i) HoldToTheHull(rig, random.PointIn(rig.workspace_mm), &outcome);
    }
  }
  std::printf("%d balls: worst difference of the phantom share %.4f\n", outcome.asked, outcome.worst);
  EXPECT_GE(outcome.asked, 20);
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
