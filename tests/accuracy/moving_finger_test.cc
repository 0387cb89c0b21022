// The moving finger at a few places, held to closed forms.
#include "tests/accuracy/moving_finger.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/solids.h"
#include "tests/oracles/coverage_mask.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Polygon = std::vector<Vector2d>;

constexpr double kSmallestToleranceMm = 0.1;  // as MeasureSection promises
constexpr double kLargestToleranceMm = 0.5;

// What of a convex polygon lies where n . (p - on) <= 0.
Polygon Clipped(const Polygon& polygon, const Vector2d& on, const Vector2d& n) {
  Polygon clipped;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = n.dot(a - on), at_b = n.dot(b - on);
    if (at_a <= 0.0) clipped.push_back(a);
    if ((at_a <= 0.0) != (at_b <= 0.0)) clipped.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
  return clipped;
}

double Extent(const Polygon& polygon, const Vector2d& direction) {
  const auto along = [&](const Vector2d& p) { return p.dot(direction); };
  const auto [low, high] = std::ranges::minmax_element(polygon, {}, along);
  return along(*high) - along(*low);
}

// The smallest width is across a side, the largest between two corners.
SectionWidths WidthsOf(const Polygon& polygon) {
  SectionWidths widths{Extent(polygon, Vector2d::UnitX()), 1e9, 0.0, {}};
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d side = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (side.norm() > 1e-6)
      widths.smallest_mm =
          std::min(widths.smallest_mm, Extent(polygon, Vector2d(-side.y(), side.x()).normalized()));
    for (const Vector2d& corner : polygon)
      widths.largest_mm = std::max(widths.largest_mm, (corner - polygon[i]).norm());
  }
  return widths;
}

void ExpectNear(const SectionWidths& found, const SectionWidths& expected) {
  EXPECT_NEAR(found.seen_mm, expected.seen_mm, kLargestToleranceMm);
  EXPECT_NEAR(found.smallest_mm, expected.smallest_mm, kSmallestToleranceMm);
  EXPECT_NEAR(found.largest_mm, expected.largest_mm, kLargestToleranceMm);
}

// A convex polygon in the plane z = 5, as a hull.
SectionQueries QueriesOfPolygon(const Polygon& polygon) {
  const auto way_out_mm = [=](const recon::Ray& ray, double most_mm) {
    const Vector2d from = ray.origin_in_world.head<2>(), along = ray.direction_in_world.head<2>();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector2d side = polygon[(i + 1) % polygon.size()] - polygon[i];
      const Vector2d outwards(side.y(), -side.x());
      if (outwards.dot(along) > 0.0)
        most_mm = std::min(most_mm, outwards.dot(polygon[i] - from) / outwards.dot(along));
    }
    return most_mm;
  };
  const auto contains = [=](const Vector3d& x) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector2d side = polygon[(i + 1) % polygon.size()] - polygon[i];
      if (Vector2d(side.y(), -side.x()).dot(x.head<2>() - polygon[i]) > 0.0) return false;
    }
    return true;
  };
  return {contains, way_out_mm};
}

const SectionPlane kLevelPlane{{0.0, 0.0, 5.0}, Vector3d::UnitZ(), Vector3d::UnitX()};

TEST(MeasureSection, FindsTheWidthsOfPolygons) {
  const Polygon square = {{-5.0, -5.0}, {5.0, -5.0}, {5.0, 5.0}, {-5.0, 5.0}};
  const Polygon beside = {{2.0, 3.0}, {14.0, 4.0}, {9.0, 11.0}};
  const Polygon long_rhombus = {{-20.0, 0.0}, {0.0, -5.0}, {20.0, 0.0}, {0.0, 5.0}};
  for (const Polygon& polygon : {square, beside, long_rhombus}) {
    const auto widths = MeasureSection(QueriesOfPolygon(polygon), kLevelPlane);
    ASSERT_TRUE(widths);
    ExpectNear(*widths, WidthsOf(polygon));
  }
}

TEST(MeasureSection, ThereIsNoneWithoutHullNearBy) {
  const Polygon far = {{16.0, -5.0}, {26.0, -5.0}, {26.0, 5.0}, {16.0, 5.0}};
  EXPECT_FALSE(MeasureSection(QueriesOfPolygon(far), kLevelPlane));
}

TEST(SectionSeenFrom, IsAcrossTheFingerAndMeasuresAcrossTheLineOfSight) {
  const Vector3d eye(0.0, -900.0, 850.0), middle(100.0, 200.0, 300.0);
  const Vector3d axis = Vector3d(-1.0, 0.5, 0.2).normalized();
  const SectionPlane plane = SectionSeenFrom(eye, middle, axis);
  EXPECT_NEAR(plane.across_in_world.norm(), 1.0, 1e-12);
  EXPECT_NEAR(plane.across_in_world.dot(axis), 0.0, 1e-12);
  EXPECT_NEAR(plane.across_in_world.dot(middle - eye), 0.0, 1e-9);
  EXPECT_THROW((void)SectionSeenFrom(eye, middle, (middle - eye).normalized()), core::PreconditionError);
}

const core::Rig& FingerRig() {
  static const core::Rig rig = recon::PaperRig();
  return rig;
}

std::vector<FingerPlace> PlacesOf(int cameras) {
  std::vector<FingerPlace> places;
  for (const FingerPlace& place : FingerPlaces(FingerRig(), {4, 3, 2}))
    if (place.cameras == cameras) places.push_back(place);
  return places;
}

TEST(FingerPlaces, FillTheWorkspaceAndAreSeenFromTheSide) {
  const std::vector<FingerPlace> places = FingerPlaces(FingerRig(), {8, 7, 4});
  ASSERT_EQ(places.size(), 8U * 7U * 4U * 3U);
  Eigen::AlignedBox3d around;
  for (const FingerPlace& place : places) {
    around.extend(place.middle_in_world);
    EXPECT_TRUE(FingerRig().workspace_mm.contains(place.middle_in_world));
    const Vector3d sight = (place.middle_in_world - kEyeInWorld).normalized();
    EXPECT_GT(sight.cross(place.axis_in_world).norm(), std::sin(core::RadiansFromDegrees(20.0)));
  }
  const Vector3d cell_mm = FingerRig().workspace_mm.sizes().cwiseQuotient(Vector3d(8.0, 7.0, 4.0));
  EXPECT_LT((around.sizes() + cell_mm - FingerRig().workspace_mm.sizes()).norm(), 1e-9);
}

TEST(FingerSolids, TheFingerIsTenMillimetresAcrossAndStandsOutOfTheFist) {
  for (const FingerPlace& place : PlacesOf(3)) {
    const std::vector<recon::Solid> solids = FingerSolids(place, FingerHolder::kFist);
    const Vector3d middle = place.middle_in_world;
    EXPECT_NEAR(recon::SignedDistanceMm(solids[0], middle), -0.5 * kFingerMm, 1e-9);
    const Vector3d tip = middle + 0.5 * kFingerLengthMm * place.axis_in_world;
    EXPECT_NEAR(recon::SignedDistanceMm(solids[0], tip), 0.0, 1e-9);
    double fist_mm = 1e9;
    for (std::size_t i = 1; i < solids.size(); ++i)
      fist_mm = std::min(fist_mm, recon::SignedDistanceMm(solids[i], middle));
    EXPECT_GT(fist_mm, 30.0);
    EXPECT_LT(fist_mm, 0.5 * kFingerLengthMm + 5.0) << "the hand holds it";
  }
}

// The section of an endless finger in the hull of perfect cameras: each gives a wedge between the two lines
// that touch the finger's circle. Cameras that look along the finger are left out: they see its end.
struct Wedges {
  Polygon section;
  std::size_t cameras = 0;
};
Wedges WedgesAt(const FingerPlace& place) {
  constexpr double kLeastSine = 0.6;
  const SectionPlane plane = SectionAt(place);
  const Vector3d y_in_world = plane.axis_in_world.cross(plane.across_in_world);
  Wedges wedges{{{-1e3, -1e3}, {1e3, -1e3}, {1e3, 1e3}, {-1e3, 1e3}}, 0};
  for (const core::CameraModel& camera : FingerRig().cameras) {
    const Vector3d to_eye = camera.center_in_world() - plane.middle_in_world;
    const Vector2d eye(to_eye.dot(plane.across_in_world), to_eye.dot(y_in_world));
    if (eye.norm() < kLeastSine * to_eye.norm()) continue;
    ++wedges.cameras;
    const double half_rad = std::asin(0.5 * kFingerMm / eye.norm());
    for (const double side : {-1.0, 1.0}) {
      const Vector2d touching = Eigen::Rotation2Dd(side * half_rad) * (-eye.normalized());
      wedges.section = Clipped(wedges.section, eye, side * Vector2d(-touching.y(), touching.x()));
    }
  }
  return wedges;
}

TEST(PerfectCameras, MakeOfAFingerAloneTheWedgesBetweenItsTangents) {
  std::size_t whole = 0;
  const std::vector<FingerPlace> places = PlacesOf(3);
  const auto found = MeasureWidths(PerfectCameras(FingerRig(), FingerHolder::kNothing), places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    SCOPED_TRACE(i);
    const Wedges wedges = WedgesAt(places[i]);
    const SectionWidths expected = WidthsOf(wedges.section);
    ASSERT_TRUE(found[i].in_hull);
    EXPECT_LE(found[i].in_hull->seen_mm, expected.seen_mm + kLargestToleranceMm);
    EXPECT_LE(found[i].in_hull->smallest_mm, expected.smallest_mm + kSmallestToleranceMm);
    EXPECT_LE(found[i].in_hull->largest_mm, expected.largest_mm + kLargestToleranceMm);
    if (wedges.cameras < FingerRig().cameras.size()) continue;
    ExpectNear(*found[i].in_hull, expected);
    ++whole;
  }
  EXPECT_GE(whole, 3U) << "places where no camera looks along the finger";
}

TEST(PerfectCameras, NeverMakeTheFingerThinner) {
  for (const FingerHolder holder : {FingerHolder::kNothing, FingerHolder::kFist}) {
    for (const FingerWidths& widths : MeasureWidths(PerfectCameras(FingerRig(), holder), PlacesOf(3))) {
      ASSERT_TRUE(widths.in_hull);
      EXPECT_GE(widths.in_hull->smallest_mm, kFingerMm - kSmallestToleranceMm);
      EXPECT_GE(widths.in_hull->seen_mm, widths.in_hull->smallest_mm - 1e-9);
      EXPECT_GE(widths.in_hull->largest_mm, widths.in_hull->seen_mm - kSmallestToleranceMm);
    }
  }
}

// One in `step` of the places, in turns of all three orientations.
std::vector<FingerPlace> SomeOf(const std::vector<FingerPlace>& places, std::size_t step) {
  std::vector<FingerPlace> some;
  for (std::size_t i = 0; i < places.size(); i += step) some.push_back(places[i]);
  return some;
}

// Wedges that are wider by a share make a section that is larger by that share, whatever its shape.
TEST(PerfectMasks, AreWithinAFifthOfAPixelOnEitherSideOfPerfectCameras) {
  constexpr double kPixelMm = 5.8, kAllowedShare = 2.0 * 0.2 * kPixelMm / kFingerMm;
  const std::vector<FingerPlace> places = SomeOf(PlacesOf(3), 4);
  ASSERT_GT(places.size(), 6U);
  const auto perfect = MeasureWidths(PerfectCameras(FingerRig(), FingerHolder::kFist), places);
  const auto found = MeasureWidths(PerfectMasks(FingerRig(), PerfectMasksOf(FingerRig(), places)), places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    SCOPED_TRACE(i);
    ASSERT_TRUE(perfect[i].in_hull && found[i].in_hull);
    EXPECT_NEAR(found[i].in_hull->smallest_mm / perfect[i].in_hull->smallest_mm, 1.0, kAllowedShare);
    EXPECT_NEAR(found[i].in_hull->seen_mm / perfect[i].in_hull->seen_mm, 1.0, kAllowedShare);
    EXPECT_LE(found[i].on_planes_mm.value_or(0.0), (1.0 + kAllowedShare) * found[i].in_hull->seen_mm);
  }
}

// A finger alone, which is nearly a cylinder.
recon::VisualHull HullOfFingerAlone(const FingerPlace& place) {
  const std::vector<recon::Solid> solids = FingerSolids(place, FingerHolder::kNothing);
  std::vector<core::SoftMask> masks;
  for (const core::CameraModel& camera : FingerRig().cameras)
    masks.push_back(oracles::CoverageMask(camera, solids));
  return recon::MakeVisualHull(std::make_shared<const core::Rig>(FingerRig()), masks);
}

TEST(WidthOnPlanes, IsTheSeenWidthOnPlanesCloseTogetherAndLessOnPlanesFarApart) {
  constexpr double kCloseMm = 0.25, kAllowedShare = 0.1;
  for (const FingerPlace& place : SomeOf(PlacesOf(3), 5)) {
    SCOPED_TRACE(place.number);
    const recon::VisualHull hull = HullOfFingerAlone(place);
    const SectionPlane plane = SectionAt(place);
    const auto section = MeasureSection(QueriesOf(hull), plane);
    ASSERT_TRUE(section);
    const auto on_planes_mm = [&](double spacing_mm) {
      return WidthOnPlanes(hull, plane, *section, kEyeInWorld, spacing_mm).value_or(0.0);
    };
    EXPECT_NEAR(on_planes_mm(kCloseMm) / section->seen_mm, 1.0, kAllowedShare);
    EXPECT_LE(on_planes_mm(15.0), on_planes_mm(kCloseMm) + 1e-9) << "each of its planes is one of those";
    EXPECT_EQ(on_planes_mm(1e5), 0.0) << "no plane there";
  }
}

TEST(WidthOnPlanes, CountsThePlanesThatCutTheSectionAndNoOthers) {
  constexpr double kBesideMm = 4.0;  // so that the section isn't as deep before the middle as behind it
  constexpr double kMarginMm = 0.5;  // the finger's hull is nearly a cylinder
  const FingerPlace place = PlacesOf(3).front();
  const recon::VisualHull hull = HullOfFingerAlone(place);
  SectionPlane plane = SectionAt(place);
  plane.middle_in_world += kBesideMm * plane.across_in_world.cross(plane.axis_in_world);
  const auto section = MeasureSection(QueriesOf(hull), plane);
  ASSERT_TRUE(section);
  const Vector3d sight = plane.middle_in_world - kEyeInWorld;
  const double slant = sight.normalized().cross(plane.axis_in_world).norm();
  const double before_mm = section->bounds_mm.min().y() / slant;
  const double behind_mm = section->bounds_mm.max().y() / slant;
  EXPECT_LT(before_mm + behind_mm, -kBesideMm);
  const auto is_seen_at = [&](double depth_mm) {  // on one plane alone
    return WidthOnPlanes(hull, plane, *section, kEyeInWorld, sight.norm() + depth_mm).has_value();
  };
  EXPECT_TRUE(is_seen_at(before_mm + kMarginMm));
  EXPECT_TRUE(is_seen_at(behind_mm - kMarginMm));
  EXPECT_FALSE(is_seen_at(before_mm - kMarginMm));
  EXPECT_FALSE(is_seen_at(behind_mm + kMarginMm));

  // Of two planes, one through the section's near tip and the next through the middle, the wider counts.
  const double step_mm = -(before_mm + kMarginMm);
  const Vector3d eye = plane.middle_in_world - 50.0 * step_mm * sight.normalized();
  const auto at_middle_mm = WidthOnPlanes(hull, plane, *section, eye, 50.0 * step_mm);
  const auto at_both_mm = WidthOnPlanes(hull, plane, *section, eye, step_mm);
  ASSERT_TRUE(at_middle_mm && at_both_mm);
  EXPECT_GE(*at_both_mm, *at_middle_mm);
}

TEST(PerfectMasks, LoseUnderOutsideWhatACameraMissesAndWidenItUnderAbstain) {
  core::Rig abstaining = FingerRig();
  abstaining.unseen = core::UnseenPolicy::kAbstain;
  const std::vector<FingerPlace> places = SomeOf(PlacesOf(2), 4);
  ASSERT_GT(places.size(), 2U);
  const FingerMasks masks = PerfectMasksOf(FingerRig(), places);
  for (const FingerWidths& widths : MeasureWidths(PerfectMasks(FingerRig(), masks), places))
    EXPECT_FALSE(widths.in_hull || widths.on_planes_mm);
  for (const FingerWidths& widths : MeasureWidths(PerfectMasks(abstaining, masks), places)) {
    ASSERT_TRUE(widths.in_hull);
    EXPECT_GT(widths.in_hull->largest_mm, kFingerMm);
  }
}

// The paper: "The finger reconstruction was relatively constant throughout most of the working volume", with
// an estimate of 5 mm: in the narrowest direction, to which the hull's corners add nothing. Cameras that are
// off by half a degree lose fingers.
TEST(DisturbedRig, KeepsFingersWithinThePapersEstimate) {
  constexpr double kLeastShare =
      0.8;  // 0.97 of all draws and places; this draw has cameras far apart in time
  constexpr double kMostShrinkMm = 2.0;
  const std::vector<FingerPlace> places = SomeOf(PlacesOf(3), 4);
  std::vector<std::optional<double>> smallest_mm;
  for (const FingerWidths& widths : MeasureWidths(DisturbedRig(FingerRig(), 1), places))
    smallest_mm.push_back(widths.in_hull ? std::optional(widths.in_hull->smallest_mm) : std::nullopt);
  const WidthSummary summary = Summarise(smallest_mm, kPaperHullMm);
  EXPECT_EQ(summary.measured, static_cast<int>(places.size()));
  EXPECT_EQ(summary.lost, 0);
  EXPECT_GE(summary.within_share, kLeastShare);
  EXPECT_NEAR(summary.median_mm, kFingerMm, kMostShrinkMm);
}

TEST(Summarise, CountsTheLostAndTheWorstOnBothSides) {
  const std::vector<std::optional<double>> widths_mm = {10.0, 4.0, std::nullopt, 12.0, 15.0};
  const WidthSummary summary = Summarise(widths_mm, 5.0);
  EXPECT_EQ(summary.measured, 5);
  EXPECT_EQ(summary.lost, 1);
  EXPECT_EQ(summary.median_mm, 10.0);
  EXPECT_EQ(summary.worst_mm, 4.0);
  EXPECT_DOUBLE_EQ(summary.within_share, 0.6) << "the lost one isn't within anything";
  EXPECT_EQ(Summarise({}, 5.0).measured, 0);
}

}  // namespace
}  // namespace elbowroom::accuracy
