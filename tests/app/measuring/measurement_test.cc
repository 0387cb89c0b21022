// Measurements follow their parts, and their intervals hold the truth.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "app/control/demo_parts.h"
#include "app/control/measuring/frame_dimensions.h"
#include "app/control/measuring/measurement.h"
#include "core/units.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "recon/synthetic/view_scene.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

FrameResult FrameAt(double gap_mm) {
  FrameResult result;
  auto layout = std::make_shared<core::Layout>(DemoLayout());
  const std::array spacing{gap_mm};
  result.world_from_parts = core::PosesAt(*layout, spacing);
  result.record.contacts.resize(layout->parts.size());
  result.layout = std::move(layout);
  return result;
}

// The PMT box's upper face, and payload A's lower one: the gap between them.
const SurfacePlace kTopOfPmt{0, {100, 50, kPmtHeightMm}, Vector3d::UnitZ()};
const SurfacePlace kBelowPayload{1, {-20, 30, 0}, -Vector3d::UnitZ()};

TEST(Measurement, OfParallelFacesIsTheGapAndFollowsIt) {
  for (const double gap_mm : {140.0, 63.25, 399.9}) {
    const auto dimension = MeasureNow({MeasurementKind::kFaces, kTopOfPmt, kBelowPayload}, FrameAt(gap_mm));
    ASSERT_TRUE(dimension);
    EXPECT_NEAR((dimension->to_in_world - dimension->from_in_world).norm(), gap_mm, 1e-9);
    EXPECT_NEAR((dimension->to_in_world - dimension->from_in_world).head<2>().norm(), 0.0, 1e-9);
  }
  EXPECT_EQ(MeasureNow({MeasurementKind::kFaces, kTopOfPmt, kBelowPayload}, FrameAt(140.0))->text,
            "140.00 mm, parallel");
}

TEST(Measurement, OfOtherFacesIsTheirAngle) {
  SurfacePlace slanted = kBelowPayload;
  slanted.normal_in_part =
      Vector3d(std::sin(core::RadiansFromDegrees(30.0)), 0.0, std::cos(core::RadiansFromDegrees(30.0)));
  const auto dimension = MeasureNow({MeasurementKind::kFaces, kTopOfPmt, slanted}, FrameAt(140.0));
  ASSERT_TRUE(dimension);
  EXPECT_EQ(dimension->text.substr(0, dimension->text.find(',')), "30.00°");
}

TEST(Measurement, OfPointsIsTheirDistance) {
  const auto dimension = MeasureNow({MeasurementKind::kPoints, kTopOfPmt, kBelowPayload}, FrameAt(140.0));
  ASSERT_TRUE(dimension);
  EXPECT_EQ(dimension->text, fmt::format("{:.2f} mm", Vector3d(120, 20, 140).norm()));
  SurfacePlace missing = kTopOfPmt;
  missing.part = 17;
  EXPECT_FALSE(MeasureNow({MeasurementKind::kPoints, missing, kBelowPayload}, FrameAt(140.0)));
}

// A ball stands on nothing, above the table; its hull holds it, so that the distance to the hull is at most
// that to the ball, and at least that to the hull's own nearest point of many that are looked at.
TEST(Measurement, ToTheHullIsAnIntervalThatHoldsTheDistance) {
  const auto rig = std::make_shared<const core::Rig>(recon::EightCameraRig());
  recon::Solid ball{recon::Sphere{60.0}, {}};
  ball.world_from_solid.translation_mm = {200.0, 0.0, 330.0};
  FrameResult frame = FrameAt(140.0);
  frame.hull = std::make_shared<const recon::VisualHull>(
      recon::MakeVisualHull(rig, recon::TrueMasks(*rig, {recon::SyntheticObject{"ball", {ball}}})));
  const auto dimension = MeasureToHull(kTopOfPmt, frame);
  ASSERT_TRUE(dimension);
  const Vector3d at = frame.world_from_parts[0] * kTopOfPmt.point_in_part;
  const double to_ball_mm = (ball.world_from_solid.translation_mm - at).norm() - 60.0;
  const double to_witness_mm = (dimension->to_in_world - at).norm();
  EXPECT_LE(to_witness_mm, to_ball_mm + 1.5);  // a pixel is 2 mm there; within the search's tolerance
  EXPECT_GT(to_witness_mm, 0.5 * to_ball_mm);
  EXPECT_TRUE(frame.hull->Contains(dimension->to_in_world));
  EXPECT_TRUE(dimension->text.ends_with(" mm"));
  SurfacePlace inside = kTopOfPmt;
  inside.point_in_part = {200.0, 0.0, 330.0};
  EXPECT_EQ(MeasureToHull(inside, frame)->text, "0 mm: in what is real");
  frame.hull.reset();
  EXPECT_FALSE(MeasureToHull(kTopOfPmt, frame));
}

TEST(FrameDimensions, SayClearancesAndDepthsAtThePlace) {
  FrameResult frame = FrameAt(140.0);
  core::PartContact& contact = frame.record.contacts[0];
  contact.verdict = core::Verdict::kContact;
  contact.deepest = core::ContactPoint{{1, 2, 3}, 16.47};
  core::PartContact& near = frame.record.contacts[1];
  near.verdict = core::Verdict::kNear;
  near.clearance.emplace();
  near.clearance->interval = {12.34, 14.01, {0, 0, 0}, {0, 0, 13}};
  near.clearance->has_witnesses = true;
  frame.record.contacts[2].clearance.emplace();  // far: no witnesses
  const std::vector<Dimension> dimensions = DimensionsOf(frame);
  ASSERT_EQ(dimensions.size(), 2U);
  EXPECT_EQ(dimensions[0].text, "≥ 16.4 mm deep");
  EXPECT_EQ(dimensions[0].from_in_world, dimensions[0].to_in_world);
  EXPECT_EQ(dimensions[1].text, "12.3 – 14.1 mm");  // rounded outwards
  EXPECT_EQ(dimensions[1].band, core::Verdict::kNear);
  EXPECT_EQ(dimensions[1].to_in_world, Vector3d(0, 0, 13));
}

}  // namespace
}  // namespace elbowroom::control
