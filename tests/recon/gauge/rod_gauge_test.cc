// What the gauge says of rods whose truth is known.
#include "recon/gauge/rod_gauge.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "recon/calibration/lens_projection.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/recon/gauge/rod_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;
using testing::Rod;
using testing::RodObject;
using testing::RodStage;
using testing::Silhouettes;

RodMeasurement Measured(const core::Rig& rig, const std::vector<core::SoftMask>& masks, double diameter_mm,
                        const Eigen::MatrixXd& covariance = {}) {
  RodGaugeResult result = GaugeRod(rig, MakeUndistortedPlanes(rig), masks, covariance, diameter_mm);
  if (!result.rod) throw core::Error(core::ErrorKind::kGeometry, result.reason);
  return *result.rod;
}

double Median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

bool IsWithin(const BoundedMm& measured, double true_mm) {
  return std::abs(measured.value_mm - true_mm) <= measured.bound.total_mm();
}

// Worst beside median of some measurements.
struct Tally {
  std::vector<double> errors_mm, bounds_mm, lengths_mm, bows_mm;
  int beyond = 0, disagree = 0;

  void Add(const RodMeasurement& rod, const Rod& truth) {
    errors_mm.push_back(std::abs(rod.diameter.value_mm - truth.diameter_mm));
    bounds_mm.push_back(rod.diameter.bound.total_mm());
    if (rod.length) {
      lengths_mm.push_back(std::abs(rod.length->value_mm - truth.length_mm));
      EXPECT_TRUE(IsWithin(*rod.length, truth.length_mm)) << rod.length->value_mm;
    }
    if (rod.straightness) bows_mm.push_back(rod.straightness->value_mm);
    if (!IsWithin(rod.diameter, truth.diameter_mm)) ++beyond;
    if (!rod.widths_agree || !rod.CamerasAgree()) ++disagree;
  }
  void Print(const char* title) const {
    const auto worst = [](const std::vector<double>& values) { return *std::ranges::max_element(values); };
    std::printf(
        "%-44s %3zu places: error %.3f, worst %.3f; bound %.3f, worst %.3f; length %.2f, worst %.2f; "
        "bow %.2f, worst %.2f mm; beyond %d, disagree %d\n",
        title, errors_mm.size(), Median(errors_mm), worst(errors_mm), Median(bounds_mm), worst(bounds_mm),
        Median(lengths_mm), worst(lengths_mm), Median(bows_mm), worst(bows_mm), beyond, disagree);
  }
};

TEST(GaugeRod, IsWithinItsBoundAt27PlacesOfThePaperRig) {
  const core::Rig rig = PaperRig();
  RodStage stage(rig, Silhouettes::kReady);
  for (const double diameter_mm : {10.0, 40.0}) {
    Tally tally;
    for (const Rod& rod : testing::TwentySevenRods(rig, 0.5, diameter_mm, 300.0)) {
      const RodMeasurement found = Measured(rig, stage.MasksOf({RodObject(rod)}), diameter_mm);
      tally.Add(found, rod);
      // Half a pixel is 1 to 2 mm here: the bound knows what all crossings together allow.
      EXPECT_LT(found.diameter.bound.total_mm(), 0.25);
      EXPECT_LT((found.position_in_world - rod.middle_in_world).norm(), 20.0);
      EXPECT_GT(std::abs(found.direction_in_world.dot(rod.direction_in_world)), 0.999);
      EXPECT_LE(found.straightness->value_mm, found.straightness->bound.total_mm());
    }
    EXPECT_EQ(tally.errors_mm.size(), 27U);
    EXPECT_EQ(tally.beyond, 0);
    EXPECT_EQ(tally.disagree, 0);
    EXPECT_EQ(tally.lengths_mm.size(), 27U);
    tally.Print(diameter_mm == 10.0 ? "paper rig, 10 mm, ready masks" : "paper rig, 40 mm, ready masks");
  }
}

TEST(GaugeRod, IsWithinItsBoundForThreeToEightCameras) {
  for (int cameras = 3; cameras <= 8; ++cameras) {
    const core::Rig rig = testing::RingRig(cameras);
    RodStage stage(rig, Silhouettes::kReady);
    for (const double diameter_mm : {10.0, 40.0}) {
      Tally tally;
      for (const Rod& rod : testing::TwentySevenRods(rig, 0.6, diameter_mm, 160.0))
        tally.Add(Measured(rig, stage.MasksOf({RodObject(rod)}), diameter_mm), rod);
      EXPECT_EQ(tally.beyond, 0);
      EXPECT_EQ(tally.disagree, 0);
      tally.Print((std::to_string(cameras) + " cameras, " + std::to_string(diameter_mm).substr(0, 2) +
                   " mm, ready masks")
                      .c_str());
    }
  }
}

TEST(GaugeRod, IsWithinItsBoundInSegmentedPictures) {
  struct Case {
    const char* title;
    core::Rig rig;
    double diameter_mm;
    double length_mm;
    int most_refuted;  // thin rods far away fall below the segmentation's min_blob_px in some camera
  };
  const Case cases[] = {{"paper rig, 10 mm, segmented, 2 % noise", PaperRig(), 10.0, 300.0, 9},
                        {"paper rig, 40 mm, segmented, 2 % noise", PaperRig(), 40.0, 300.0, 0},
                        {"four cameras, 10 mm, segmented, 2 % noise", FourCameraRig(), 10.0, 200.0, 3},
                        {"four cameras, 40 mm, segmented, 2 % noise", FourCameraRig(), 40.0, 200.0, 0}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.title);
    RodStage stage(c.rig, Silhouettes::kSegmented);
    Tally tally;
    for (const Rod& rod : testing::TwentySevenRods(c.rig, 0.5, c.diameter_mm, c.length_mm))
      tally.Add(Measured(c.rig, stage.MasksOf({RodObject(rod)}), c.diameter_mm), rod);
    EXPECT_EQ(tally.beyond, 0);
    EXPECT_LE(tally.disagree, c.most_refuted);
    tally.Print(c.title);
  }
}

TEST(GaugeRod, MeasuresAWrongRodAsWhatItIs) {
  const core::Rig rig = PaperRig();
  RodStage stage(rig, Silhouettes::kReady);
  for (const Rod& rod : testing::TwentySevenRods(rig, 0.5, 12.0, 300.0)) {
    const RodMeasurement found = Measured(rig, stage.MasksOf({RodObject(rod)}), 10.0);
    EXPECT_TRUE(IsWithin(found.diameter, 12.0)) << found.diameter.value_mm;
    EXPECT_FALSE(IsWithin(found.diameter, 10.0)) << found.diameter.value_mm;
  }
}

int PlacesThatDisagree(RodStage* stage, const core::Rig& rig, const core::Rig& believed, double diameter_mm,
                       double length_mm) {
  int places = 0;
  for (const Rod& rod : testing::TwentySevenRods(rig, 0.5, diameter_mm, length_mm)) {
    const auto masks = stage->MasksOf({RodObject(rod)});
    const RodGaugeResult result = GaugeRod(believed, MakeUndistortedPlanes(believed), masks, {}, diameter_mm);
    if (!result.rod || !result.rod->CamerasAgree()) ++places;
  }
  return places;
}

TEST(GaugeRod, NoticesATurnedCamera) {
  struct Case {
    const char* title;
    core::Rig rig;
    double length_mm;
  };
  for (const Case& c : {Case{"paper rig", PaperRig(), 300.0}, Case{"four cameras", FourCameraRig(), 200.0}}) {
    RodStage stage(c.rig, Silhouettes::kReady);
    for (const double angle_deg : {0.1, 0.25, 0.5, 1.0}) {
      const Eigen::Matrix3d& axes = c.rig.cameras[1].cam_from_world().rotation;
      for (const auto& [name, axis] :
           {std::pair{"sideways", 1}, std::pair{"up", 0}, std::pair{"about its sight", 2}}) {
        const Vector3d about = axes.row(axis).transpose();
        const core::Rig turned = testing::WithTurnedCamera(c.rig, 1, angle_deg, about);
        const int places = PlacesThatDisagree(&stage, c.rig, turned, 10.0, c.length_mm);
        std::printf("%s, camera '%s' turned by %.2f deg %s: noticed at %d of 27 places\n", c.title,
                    c.rig.cameras[1].name().c_str(), angle_deg, name, places);
        if (angle_deg >= 0.5 && axis != 2) {
          EXPECT_GE(places, 20) << c.title << angle_deg << name;
        }
      }
    }
  }
}

TEST(GaugeRod, NamesTheTurnedCameraWhereOthersOutvoteIt) {
  const core::Rig rig = testing::RingRig(5);
  RodStage stage(rig, Silhouettes::kReady);
  const core::Rig turned = testing::WithTurnedCamera(rig, 2, 1.0, Vector3d::UnitZ());
  const Rod rod{{0, 0, 200}, {0.2, 0.1, 1.0}, 10.0, 200.0};
  const RodMeasurement found = Measured(turned, stage.MasksOf({RodObject(rod)}), 10.0);
  ASSERT_EQ(found.cameras[2].sight, RodSight::kAstray);
  // A degree at 1.2 to 1.4 m.
  EXPECT_NEAR(std::abs(found.cameras[2].offset->value_mm), 22.5, 4.0);
  for (const std::size_t other : {0U, 1U, 3U, 4U}) EXPECT_EQ(found.cameras[other].sight, RodSight::kMeasured);
  EXPECT_TRUE(IsWithin(found.diameter, 10.0));
}

TEST(GaugeRod, IsWithinItsBoundWhereTheCalibrationIsAsWrongAsItSays) {
  const core::Rig rig = testing::RingRig(4);
  RodStage stage(rig, Silhouettes::kReady);
  const std::vector<Rod> rods = testing::TwentySevenRods(rig, 0.6, 40.0, 160.0);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const int lens = LensParametersOf(rig.cameras[0].calibration()).count(), size = lens + 7;
  Eigen::VectorXd sigma(size);
  sigma.setZero();
  sigma.head<4>().setConstant(0.5);             // px
  sigma.segment<3>(lens).setConstant(0.0005);   // rad: 0.03 degrees
  sigma.segment<3>(lens + 3).setConstant(0.7);  // mm
  const Eigen::VectorXd all = sigma.replicate(4, 1);
  const Eigen::MatrixXd covariance = all.cwiseAbs2().asDiagonal();
  Tally tally;
  for (const Rod& rod : rods) {
    core::Rig believed = rig;
    for (core::CameraModel& camera : believed.cameras) {
      core::CameraCalibration calibration = camera.calibration();
      LensParameters values = LensParametersOf(calibration);
      for (int i = 0; i < 4; ++i) values.values[i] += sigma[i] * normal(random);
      PutLens(values, &calibration);
      Vector3d turn, shift;
      for (int i = 0; i < 3; ++i) {
        turn[i] = sigma[lens + i] * normal(random);
        shift[i] = sigma[lens + 3 + i] * normal(random);
      }
      calibration.cam_from_world.rotation =
          Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() *
          calibration.cam_from_world.rotation;
      calibration.cam_from_world.translation_mm += shift;
      camera = core::CameraModel(calibration);
    }
    const auto masks = stage.MasksOf({RodObject(rod)});
    const RodMeasurement found = Measured(believed, masks, 40.0, covariance);
    EXPECT_GT(found.diameter.bound.calibration_mm, 0.0);
    tally.Add(found, rod);
  }
  tally.Print("4 cameras, 40 mm, calibration drawn anew");
  EXPECT_EQ(tally.beyond, 0);
  EXPECT_LE(tally.disagree, 1);  // 3 sigmas of four cameras and 27 draws
}

TEST(GaugeRod, MeasuresARodInAHand) {
  for (int cameras = 4; cameras <= 7; ++cameras) {
    const core::Rig rig = testing::RingRig(cameras);
    RodStage stage(rig, Silhouettes::kReady);
    int found_rods = 0;
    for (const Rod& rod : testing::TwentySevenRods(rig, 0.4, 10.0, 260.0)) {
      const auto masks = stage.MasksOf({RodObject(rod), testing::HandAtTheEnd(rod)});
      const RodGaugeResult result = GaugeRod(rig, MakeUndistortedPlanes(rig), masks, {}, 10.0);
      if (!result.rod) continue;  // hidden by the hand from all cameras but one
      ++found_rods;
      EXPECT_TRUE(IsWithin(result.rod->diameter, 10.0))
          << cameras << " cameras: " << result.rod->diameter.value_mm << " +- "
          << result.rod->diameter.bound.total_mm();
      EXPECT_TRUE(result.rod->CamerasAgree());
      EXPECT_TRUE(result.rod->widths_agree);
      if (!result.rod->widths_agree)
        for (const CameraOfGauge& camera : result.rod->cameras)
          if (camera.diameter)
            std::printf("   %s %.3f +- %.3f excess %.2f px\n", camera.name.c_str(), camera.diameter->value_mm,
                        camera.diameter->bound.total_mm(), camera.excess_px);
      EXPECT_FALSE(result.rod->length) << "an end is in the hand";
      EXPECT_GT(std::abs(result.rod->direction_in_world.dot(rod.direction_in_world)), 0.999);
    }
    std::printf("%d cameras, rod in a hand: found at %d of 27 places\n", cameras, found_rods);
    EXPECT_GE(found_rods, 25);
  }
}

TEST(GaugeRod, MeasuresARodOnTheTable) {
  const core::Rig rig = FourCameraRig();
  RodStage stage(rig, Silhouettes::kReady);
  for (const double diameter_mm : {10.0, 40.0}) {
    for (int k = 0; k < 6; ++k) {
      const double angle = 0.5 * k;
      const Rod rod{{50, 0, 0.5 * diameter_mm}, {std::cos(angle), std::sin(angle), 0}, diameter_mm, 220.0};
      const RodMeasurement found = Measured(rig, stage.MasksOf({RodObject(rod)}), diameter_mm);
      EXPECT_TRUE(IsWithin(found.diameter, diameter_mm));
      EXPECT_TRUE(found.CamerasAgree());
      ASSERT_TRUE(found.length);
      EXPECT_TRUE(IsWithin(*found.length, 220.0));
    }
  }
}

TEST(GaugeRod, GivesACameraThatTheRodPointsAtLittleWeight) {
  const core::Rig rig = testing::RingRig(4);
  RodStage stage(rig, Silhouettes::kReady);
  const Vector3d middle(0, 0, 200);
  for (const double aside : {0.0, 0.05, 0.1, 0.2}) {
    const Rod rod{middle,
                  (rig.cameras[0].center_in_world() - middle).normalized() + aside * Vector3d::UnitZ(), 20.0,
                  200.0};
    const RodMeasurement found = Measured(rig, stage.MasksOf({RodObject(rod)}), 20.0);
    EXPECT_TRUE(IsWithin(found.diameter, 20.0)) << aside;
    EXPECT_TRUE(found.CamerasAgree()) << aside;
    EXPECT_LT(found.diameter.bound.total_mm(), 0.2);
    const CameraOfGauge& pointed = found.cameras[0];
    EXPECT_NE(pointed.sight, RodSight::kAstray);
    EXPECT_NE(pointed.sight, RodSight::kRefutes);
    if (pointed.diameter) {
      EXPECT_GT(pointed.diameter->bound.total_mm(), found.diameter.bound.total_mm()) << aside;
    }
  }
}

TEST(GaugeRod, MeasuresARodThatLeavesAPicture) {
  core::Rig rig = testing::RingRig(4);
  // The first camera looks to the side: a third of the rod is out of its picture.
  rig = testing::WithTurnedCamera(rig, 0, 20.0, Vector3d::UnitZ());
  RodStage stage(rig, Silhouettes::kReady);
  int cut = 0;
  for (const double x : {-60.0, 0.0, 60.0}) {
    const Rod rod{{x, 0, 200}, {0.1, 1.0, 0.1}, 20.0, 400.0};
    const auto masks = stage.MasksOf({RodObject(rod)});
    for (int y = 0; y < 480; ++y) cut += masks[0].mask.At(0, y) || masks[0].mask.At(639, y) ? 1 : 0;
    const RodMeasurement found = Measured(rig, masks, 20.0);
    EXPECT_TRUE(IsWithin(found.diameter, 20.0));
    EXPECT_TRUE(found.CamerasAgree());
    ASSERT_TRUE(found.length);
    EXPECT_TRUE(IsWithin(*found.length, 400.0)) << found.length->value_mm;
  }
  EXPECT_GT(cut, 0) << "no rod crosses the picture's border";
}

TEST(GaugeRod, MeasuresHowFarARodIsBowed) {
  const core::Rig rig = testing::RingRig(5);
  RodStage stage(rig, Silhouettes::kReady);
  for (const double bow_mm : {0.0, 1.0, 3.0, 5.0}) {
    const Rod rod{{0, 0, 200}, {0.3, 1.0, 0.4}, 20.0, 300.0};
    const auto masks = stage.MasksOf({testing::BowedRod(rod, bow_mm)});
    const RodMeasurement found = Measured(rig, masks, 20.0);
    ASSERT_TRUE(found.straightness) << bow_mm;
    // The ends are cut off, and with them a part of the bow.
    const double seen = std::pow(found.seen_mm / rod.length_mm, 2);
    EXPECT_NEAR(found.straightness->value_mm, bow_mm * seen, found.straightness->bound.total_mm()) << bow_mm;
    EXPECT_NEAR(found.straightness->value_mm, bow_mm * seen, 0.1 + 0.1 * bow_mm) << bow_mm;
    EXPECT_EQ(found.straightness->value_mm > found.straightness->bound.total_mm(), bow_mm > 0.5) << bow_mm;
  }
}

std::string ReasonFor(const core::Rig& rig, const std::vector<core::SoftMask>& masks, double diameter_mm) {
  const RodGaugeResult result = GaugeRod(rig, MakeUndistortedPlanes(rig), masks, {}, diameter_mm);
  EXPECT_FALSE(result.rod);
  return result.reason;
}

TEST(GaugeRod, SaysWhatItSawWhereThereIsNoRod) {
  const core::Rig rig = testing::RingRig(4);
  RodStage stage(rig, Silhouettes::kReady);
  EXPECT_NE(ReasonFor(rig, stage.MasksOf({}), 10.0).find("no camera sees anything"), std::string::npos);
  SyntheticObject ball{"ball", {{Sphere{60.0}, {}, Vector3d::Constant(200.0)}}};
  ball.solids[0].world_from_solid.translation_mm = {0, 0, 200};
  EXPECT_NE(ReasonFor(rig, stage.MasksOf({ball}), 10.0).find("none sees two straight edges"),
            std::string::npos);
  auto masks = stage.MasksOf({RodObject({{0, 0, 200}, {0.2, 0.3, 1.0}, 10.0, 200.0})});
  for (std::size_t i : {0U, 2U, 3U}) masks[i].mask = core::BitMask(640, 480);
  EXPECT_NE(ReasonFor(rig, masks, 10.0).find("only 'cam2' sees two straight edges"), std::string::npos);
}

TEST(GaugeRod, RefusesWhatCannotBe) {
  const core::Rig rig = testing::RingRig(3);
  const UndistortedPlanes planes = MakeUndistortedPlanes(rig);
  const std::vector<core::SoftMask> masks(3, {core::BitMask(640, 480), {}});
  EXPECT_THROW((void)GaugeRod(rig, planes, masks, {}, 0.0), core::PreconditionError);
  EXPECT_THROW((void)GaugeRod(rig, planes, std::vector<core::SoftMask>(2, masks[0]), {}, 10.0),
               core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
