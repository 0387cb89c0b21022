#include "review/paper_methods/two_triangle_response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "recon/paper_methods/triangle_viewports.h"
#include "tests/core/solids.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using recon::CoverageHull;

constexpr double kStepMm = 0.125;  // the paper's
constexpr double kAway = 1e6;      // cameras are so far that rays are parallel, to 1e-4
constexpr double kPixelMm = 0.2;
constexpr int kPicturePx = 700;
constexpr double kLabelMm = 0.6 * kPixelMm;  // how far a hard mask's boundary is from the shape's

// The shapes that three far cameras along the axes see, `is_object` of the other two coordinates.
template <typename IsObject>
CoverageHull HullOf(const IsObject& is_object) {
  core::Rig rig;
  rig.name = "axes";
  rig.workspace_mm = {Vector3d::Constant(-70.0), Vector3d::Constant(70.0)};
  std::vector<core::SoftMask> masks;
  for (int axis = 0; axis < 3; ++axis) {
    core::CameraCalibration c;
    c.name = "far";
    c.image_width_px = c.image_height_px = kPicturePx;
    const double center_px = 0.5 * (kPicturePx - 1);
    c.camera_matrix << kAway / kPixelMm, 0.0, center_px, 0.0, kAway / kPixelMm, center_px, 0.0, 0.0, 1.0;
    c.cam_from_world = core::CamFromWorldLookingAt(kAway * Vector3d::Unit(axis), Vector3d::Zero());
    const core::RigidTransform world_from_cam = c.cam_from_world.Inverse();
    rig.cameras.emplace_back(std::move(c));
    core::BitMask mask(kPicturePx, kPicturePx);
    for (int y = 0; y < kPicturePx; ++y) {
      for (int x = 0; x < kPicturePx; ++x) {
        const Vector3d in_cam(kPixelMm * (x - center_px), kPixelMm * (y - center_px), kAway);
        const Vector3d in_world = world_from_cam * in_cam;
        mask.Set(x, y, is_object(Vector2d(in_world[(axis + 1) % 3], in_world[(axis + 2) % 3])));
      }
    }
    masks.push_back({std::move(mask), {}});
  }
  return {rig, masks};
}

// [-50, 50]^3.
const CoverageHull& BoxHull() {
  static const CoverageHull hull = HullOf([](const Vector2d& p) { return p.cwiseAbs().maxCoeff() <= 50.0; });
  return hull;
}

// What the three see of a ball of 50 mm: x^2 + y^2, y^2 + z^2 and z^2 + x^2 at most 50^2.
const CoverageHull& BallHull() {
  static const CoverageHull hull = HullOf([](const Vector2d& p) { return p.norm() <= 50.0; });
  return hull;
}

double DegreesBetween(const Vector3d& a, const Vector3d& b) {
  return core::DegreesFromRadians(std::atan2(a.cross(b).norm(), a.dot(b)));
}

// I and J are on lines 10 degrees apart, so they stand 2 d tan(5 degrees) apart at a depth of d, and either
// may be late by a step; likewise K and L.
double NormalBoundDeg(double depth_mm, double late_mm) {
  const double chord_mm = 2.0 * depth_mm * std::tan(core::RadiansFromDegrees(5.0));
  return core::DegreesFromRadians(std::atan(std::sqrt(2.0) * late_mm / chord_mm));
}

TEST(TwoTriangleResponse, BacksOutOfAFlatFace) {
  recon::Random random(7501);
  double worst_shallow_deg = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double depth_mm = random.LogUniform(0.5, 40.0);
    const Vector3d cp_obj(50.0 - depth_mm, random.Uniform(-20, 20), random.Uniform(-20, 20));
    Vector3d v_rec = Vector3d(1.0, random.Uniform(-0.3, 0.3), random.Uniform(-0.3, 0.3)).normalized();
    if (depth_mm / v_rec.x() > 48.0) continue;
    const TwoTriangleResponse response =
        RespondByTwoTriangles(BoxHull(), std::vector{cp_obj}, cp_obj + 120.0 * v_rec);
    ASSERT_EQ(response.status, TwoTriangleStatus::kFound);
    EXPECT_EQ(response.step_mm, kStepMm);
    const core::Recovery& recovery = *response.recovery;
    EXPECT_EQ(recovery.cp_obj_in_world_mm, cp_obj);
    EXPECT_LT((recovery.v_rec_in_world - v_rec).norm(), 1e-9);
    // The first sample inside: less than a step short of the face, never beyond it.
    const double short_mm = depth_mm / v_rec.x() - recovery.d_rec_mm;
    EXPECT_GT(short_mm, -kLabelMm);
    EXPECT_LT(short_mm, kStepMm + kLabelMm);
    if (!recovery.n_hull_in_world) continue;  // shallower than a step
    const double off_deg = DegreesBetween(*recovery.n_hull_in_world, Vector3d::UnitX());
    EXPECT_LT(off_deg, NormalBoundDeg(depth_mm, kStepMm / std::cos(0.6))) << depth_mm;
    if (depth_mm < 2.0) worst_shallow_deg = std::max(worst_shallow_deg, off_deg);
  }
  // What the paper doesn't say: at depths of a few steps its normal is next to nothing.
  EXPECT_GT(worst_shallow_deg, 10.0);
}

// A plate pushed into the ball's side, where the camera above bounds the hull: a cylinder about z.
TEST(TwoTriangleResponse, BallPushedIntoAPlate) {
  const Vector3d out = Vector3d(1, 1, 0).normalized(), along = Vector3d(-1, 1, 0).normalized();
  for (const double depth_mm : {4.0, 8.0, 16.0}) {
    const core::RigidTransform world_from_plate{
        (Eigen::Matrix3d() << out, along, Vector3d::UnitZ()).finished(),
        (50.0 - depth_mm) * out - 60.0 * along - Vector3d(0, 0, 6)};
    const core::TriangleMesh plate = core::testing::Box({60.0, 120.0, 12.0});
    const recon::SampledContacts sampled =
        recon::SampleTriangles(BallHull(), plate, world_from_plate, {100, 100});
    std::vector<Vector3d> contacts;
    for (const recon::ViewportContact& contact : sampled.contacts)
      contacts.push_back(contact.position_in_world_mm);
    ASSERT_GT(contacts.size(), 100U);
    const Vector3d rp_obj = world_from_plate * Vector3d(30.0, 60.0, 6.0);
    const TwoTriangleResponse response = RespondByTwoTriangles(BallHull(), contacts, rp_obj);
    ASSERT_EQ(response.status, TwoTriangleStatus::kFound);
    const core::Recovery& recovery = *response.recovery;
    for (const Vector3d& contact : contacts)
      EXPECT_LE((contact - rp_obj).norm(), (recovery.cp_obj_in_world_mm - rp_obj).norm() + 1e-9);
    // CP_hull on the cylinder, a step short of it at most.
    const Vector3d cp_hull = recovery.cp_hull_in_world_mm;
    EXPECT_NEAR(cp_hull.head<2>().norm(), 50.0, kStepMm + kLabelMm) << depth_mm;
    ASSERT_TRUE(recovery.n_hull_in_world);
    const Vector3d truth = Vector3d(cp_hull.x(), cp_hull.y(), 0.0).normalized();
    const double obliquity = recovery.v_rec_in_world.dot(truth);
    EXPECT_LT(DegreesBetween(*recovery.n_hull_in_world, truth),
              NormalBoundDeg(recovery.d_rec_mm, (kStepMm + 2.0 * kLabelMm) / obliquity))
        << depth_mm;
  }
}

TEST(TwoTriangleResponse, DeeperThanItsTriangle) {
  const Vector3d rp_obj(120.0, 0.0, 0.0);
  for (const double depth_mm : {45.0, 49.8, 50.3, 70.0}) {
    const TwoTriangleResponse response =
        RespondByTwoTriangles(BoxHull(), std::vector{Vector3d(50.0 - depth_mm, 0, 0)}, rp_obj);
    EXPECT_EQ(response.status,
              depth_mm < 50.0 ? TwoTriangleStatus::kFound : TwoTriangleStatus::kDeeperThanTriangle);
    EXPECT_EQ(response.recovery.has_value(), depth_mm < 50.0);
  }
  // A higher triangle reaches it.
  const TwoTriangleResponse higher = RespondByTwoTriangles(BoxHull(), std::vector{Vector3d(-20, 0, 0)},
                                                           rp_obj, {.height_mm = 100.0, .window_px = 800});
  ASSERT_EQ(higher.status, TwoTriangleStatus::kFound);
  EXPECT_NEAR(higher.recovery->d_rec_mm, 70.0, kStepMm + kLabelMm);
}

TEST(TwoTriangleResponse, ReferenceInsideTheHull) {
  const std::vector<Vector3d> contacts = {{40, 0, 0}, {45, 3, 0}};
  const TwoTriangleResponse response = RespondByTwoTriangles(BoxHull(), contacts, {10, 0, 0});
  EXPECT_EQ(response.status, TwoTriangleStatus::kReferenceInsideHull);
  EXPECT_FALSE(response.recovery);
  EXPECT_EQ(response.pixels, 0);
  // With a direction of the part's own the reference only chooses CP_obj: (45, 3, 0).
  const TwoTriangleResponse given =
      RespondByTwoTriangles(BoxHull(), contacts, {10, 0, 0}, {.v_rec_in_world = Vector3d::UnitX()});
  ASSERT_EQ(given.status, TwoTriangleStatus::kFound);
  EXPECT_EQ(given.recovery->cp_obj_in_world_mm, Vector3d(45, 3, 0));
  EXPECT_NEAR(given.recovery->d_rec_mm, 5.0, kStepMm + kLabelMm);
}

TEST(TwoTriangleResponse, NoDirectionNoContact) {
  EXPECT_EQ(RespondByTwoTriangles(BoxHull(), {}, {60, 0, 0}).status, TwoTriangleStatus::kNoContact);
  EXPECT_EQ(RespondByTwoTriangles(BoxHull(), std::vector{Vector3d(40, 0, 0)}, {40, 0, 0}).status,
            TwoTriangleStatus::kNoDirection);
}

// The search begins at a reference that is nearer than the base: what is behind it doesn't count.
TEST(TwoTriangleResponse, WhatIsBehindTheReferenceDoesNotCount) {
  const CoverageHull bars = HullOf([](const Vector2d& p) {
    return std::abs(p.x()) <= 50.0 && std::abs(p.y()) <= 50.0 && (p.cwiseAbs().array() >= 20.0).any();
  });
  // Hollow: along x through y = 35 it is in the hull from -50 to -20 and from 20 to 50.
  ASSERT_TRUE(bars.Contains({-30, 35, 35}));
  ASSERT_FALSE(bars.Contains({0, 35, 0}));
  const TwoTriangleResponse response =
      RespondByTwoTriangles(bars, std::vector{Vector3d(-25, 35, 0)}, {10, 35, 0});
  ASSERT_EQ(response.status, TwoTriangleStatus::kFound);
  EXPECT_NEAR(response.recovery->cp_hull_in_world_mm.x(), -20.0, kStepMm + kLabelMm);
}

// Near the box's edge one side of a triangle leaves through another face.
TEST(TwoTriangleResponse, ASideThatStaysInsideLeavesNoNormal) {
  // Out through y = 50 at a slant: V_rec leaves, the side towards -y stays in the hull along all of its
  // length.
  const Vector3d cp_obj(-30, 45.5, 0), v_rec = Vector3d(1, 0.1, 0).normalized();
  const TwoTriangleResponse response =
      RespondByTwoTriangles(BoxHull(), std::vector{cp_obj}, cp_obj + 200.0 * v_rec);
  ASSERT_EQ(response.status, TwoTriangleStatus::kFound);
  EXPECT_FALSE(response.recovery->n_hull_in_world);
}

TEST(TwoTriangleResponse, CountsWorkAsThePaperDoes) {
  const TwoTriangleResponse response =
      RespondByTwoTriangles(BoxHull(), std::vector{Vector3d(40, 0, 0)}, {120, 0, 0});
  EXPECT_EQ(response.triangles, 2);
  EXPECT_EQ(response.pixels, 480'000);  // the paper's figure, for three cameras
}

TEST(TwoTriangleResponse, RefusesOptionsOutOfRange) {
  const auto refused = [](const TwoTriangleOptions& options) {
    EXPECT_THROW((void)RespondByTwoTriangles(BoxHull(), {}, Vector3d::Zero(), options),
                 core::PreconditionError);
  };
  refused({.apex_rad = 0.0});
  refused({.apex_rad = 1.6});
  refused({.height_mm = 0.0});
  refused({.window_px = 1});
  refused({.v_rec_in_world = Vector3d(1, 1, 0)});
}

TEST(TwoTriangleStatus, SaysWhatItIs) {
  EXPECT_EQ(ToString(TwoTriangleStatus::kFound), "found");
  EXPECT_EQ(ToString(TwoTriangleStatus::kNoContact), "no contact");
  EXPECT_EQ(ToString(TwoTriangleStatus::kNoDirection), "no direction");
  EXPECT_EQ(ToString(TwoTriangleStatus::kReferenceInsideHull), "reference inside hull");
  EXPECT_EQ(ToString(TwoTriangleStatus::kDeeperThanTriangle), "deeper than the triangle");
}

}  // namespace
}  // namespace elbowroom::review
