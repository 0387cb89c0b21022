// The stated uncertainty of a distance against distances to hulls of redrawn rigs and silhouettes.
#include "recon/error_budget/hull_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "recon/calibration/rotation.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/solids.h"
#include "review/clearance.h"
#include "tests/core/solids.h"
#include "tests/oracles/coverage_mask.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;
const Vector3d kGrey = Vector3d::Constant(200.0);
using SharedRig = std::shared_ptr<const core::Rig>;

// Four cameras of 320 x 240 around the origin, 700 to 1,000 mm away, with lenses of their own.
SharedRig TestRig() {
  core::Rig rig;
  rig.workspace_mm = {Vector3d::Constant(-250.0), Vector3d::Constant(250.0)};
  const std::vector<Vector3d> eyes = {
      {900.0, 100.0, 300.0}, {-100.0, 800.0, 200.0}, {-700.0, -300.0, 500.0}, {150.0, -250.0, 800.0}};
  for (std::size_t i = 0; i < eyes.size(); ++i) {
    core::CameraCalibration camera;
    camera.name = "cam" + std::to_string(i + 1);
    camera.image_width_px = 320;
    camera.image_height_px = 240;
    const double focal_px = 330.0 + 20.0 * static_cast<double>(i);
    camera.camera_matrix << focal_px, 0.0, 158.0, 0.0, 1.002 * focal_px, 121.0, 0.0, 0.0, 1.0;
    camera.distortion_coefficients = {-0.08, 0.01, 1e-4, -2e-4, 0.0};
    camera.cam_from_world = core::CamFromWorldLookingAt(eyes[i], Vector3d::Zero());
    rig.cameras.emplace_back(camera);
  }
  return std::make_shared<const core::Rig>(std::move(rig));
}

double Normal(Random* random) {
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) sum += random->Uniform(-0.5, 0.5);
  return sum;
}

// A factor L of the parameters' covariance L L^T: errors of calibration as they are, correlated within a
// camera and between cameras.
Eigen::MatrixXd DrawFactor(const core::Rig& rig, Random* random) {
  std::vector<double> sigmas;
  for (const core::CameraModel& camera : rig.cameras) {
    sigmas.insert(sigmas.end(), {0.5, 0.5, 0.6, 0.6});
    for (const double coefficient : camera.calibration().distortion_coefficients) {
      (void)coefficient;
      sigmas.push_back(1e-3);
    }
    sigmas.insert(sigmas.end(), {6e-4, 6e-4, 6e-4, 0.5, 0.5, 0.5, 0.0});
  }
  const auto count = static_cast<Eigen::Index>(sigmas.size());
  Eigen::MatrixXd factor = Eigen::MatrixXd::Identity(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < i; ++j) factor(i, j) = 0.15 * Normal(random);
  for (Eigen::Index i = 0; i < count; ++i) factor.row(i) *= sigmas[static_cast<std::size_t>(i)];
  return factor;
}

// The rig with its parameters changed.
SharedRig Changed(const core::Rig& rig, const Eigen::VectorXd& change) {
  core::Rig changed;
  changed.workspace_mm = rig.workspace_mm;
  Eigen::Index at = 0;
  for (const core::CameraModel& camera : rig.cameras) {
    core::CameraCalibration calibration = camera.calibration();
    LensParameters lens = LensParametersOf(calibration);
    lens.values += change.segment(at, lens.count());
    PutLens(lens, &calibration);
    at += lens.count();
    core::RigidTransform& cam_from_world = calibration.cam_from_world;
    cam_from_world.rotation = RotationFromVector(change.segment<3>(at)) * cam_from_world.rotation;
    cam_from_world.translation_mm += change.segment<3>(at + 3);
    at += 7;
    changed.cameras.emplace_back(calibration);
  }
  return std::make_shared<const core::Rig>(std::move(changed));
}

struct Case {
  const char* title;
  Solid solid;
  Vector3d part_at;
};

std::vector<Case> Cases() {
  const auto at = [](const Vector3d& x) { return core::RigidTransform{Eigen::Matrix3d::Identity(), x}; };
  const core::RigidTransform turned{RotationFromVector({0.3, 0.5, 0.2}), {10.0, -20.0, 5.0}};
  return {
      {"ball, from above", {Sphere{60.0}, at({5.0, 10.0, -15.0}), kGrey}, {0.0, 0.0, 90.0}},
      {"ball, from the side", {Sphere{40.0}, at({30.0, -20.0, 10.0}), kGrey}, {120.0, -90.0, 20.0}},
      {"rod", CapsuleBetween({-60.0, -50.0, -30.0}, {70.0, 40.0, 60.0}, 12.0, kGrey), {40.0, -60.0, 20.0}},
      {"box, before a face", {Box{{80.0, 60.0, 40.0}}, turned, kGrey}, {130.0, -30.0, 0.0}},
      {"box, beside an edge", {Box{{90.0, 50.0, 50.0}}, turned, kGrey}, {10.0, 90.0, -80.0}},
      {"flat box", {Box{{120.0, 100.0, 6.0}}, at({0.0, 0.0, -40.0}), kGrey}, {20.0, 30.0, 25.0}}};
}

core::TriangleTree PartAt(const Vector3d& x) {
  const Vector3d size_mm = Vector3d::Constant(10.0);
  return core::TriangleTree(std::make_shared<const core::TriangleMesh>(
      core::Transformed(core::testing::Box(size_mm), {Eigen::Matrix3d::Identity(), x - 0.5 * size_mm})));
}

review::Clearance DistanceTo(const VisualHull& hull, const core::TriangleTree& part) {
  review::ClearanceOptions options;
  options.tolerance_mm = 0.02;
  return review::FindClearance(hull, part, {}, options);
}

std::vector<core::SoftMask> MasksOf(const core::Rig& rig, const Solid& solid) {
  std::vector<core::SoftMask> masks;
  for (const core::CameraModel& camera : rig.cameras)
    masks.push_back(oracles::CoverageMask(camera, std::vector<Solid>{solid}, 2.0));
  return masks;
}

TEST(HullErrors, OfCalibrationAreThoseOfRedrawnRigs) {
  // The square root of a mean of squares over n draws is known to 1 / sqrt(2 n); the rest is the second
  // order, and normals that are fitted to vertices.
  const int draws = 120 * test_support::SoakScale();
  const double margin = 4.0 / std::sqrt(2.0 * draws) + 0.1;
  const SharedRig rig = TestRig();
  Random random(8201);
  for (const Case& c : Cases()) {
    const Eigen::MatrixXd factor = DrawFactor(*rig, &random);
    const HullErrors errors(*rig, {factor * factor.transpose(), 0.0});
    const core::TriangleTree part = PartAt(c.part_at);
    const std::vector<core::SoftMask> masks = MasksOf(*rig, c.solid);
    const VisualHull hull = MakeVisualHull(rig, masks);
    const review::Clearance found = DistanceTo(hull, part);
    ASSERT_TRUE(found.has_witnesses) << c.title;
    const core::ErrorBudget stated =
        errors.At(hull, found.interval.witness_hull_in_world_mm, found.interval.witness_part_in_world_mm);
    double sum = 0.0;
    for (int draw = 0; draw < draws; ++draw) {
      Eigen::VectorXd normal(factor.rows());
      for (Eigen::Index i = 0; i < normal.size(); ++i) normal[i] = Normal(&random);
      const VisualHull redrawn = MakeVisualHull(Changed(*rig, factor * normal), masks);
      sum += std::pow(DistanceTo(redrawn, part).interval.upper_mm - found.interval.upper_mm, 2);
    }
    const double measured_mm = std::sqrt(sum / draws);
    const core::ErrorBudget worst = errors.WorstAt(found.interval.witness_hull_in_world_mm);
    std::printf("%-20s distance %6.1f mm, stated %.3f mm, of %d draws %.3f mm, worst of a camera %.3f mm\n",
                c.title, found.interval.upper_mm, stated.calibration_mm, draws, measured_mm,
                worst.calibration_mm);
    EXPECT_NEAR(stated.calibration_mm / measured_mm, 1.0, margin) << c.title;
    EXPECT_EQ(stated.skew_mm, 0.0);
  }
}

TEST(HullErrors, OfPixelsCoverWhatReadyMasksAreOffBy) {
  const int draws = 8 * test_support::SoakScale();
  const SharedRig rig = TestRig();
  const Eigen::Index parameters = DrawFactor(*rig, std::make_unique<Random>(1).get()).rows();
  const HullErrors errors(*rig, {Eigen::MatrixXd::Zero(parameters, parameters), core::kBoundarySigmaPx});
  Random random(8202);
  int inside = 0, count = 0;
  for (const Case& c : Cases()) {
    for (int draw = 0; draw < draws; ++draw) {
      // Another place of the object on the pixels' grid.
      Solid solid = c.solid;
      const Vector3d moved = 5.0 * Vector3d(Normal(&random), Normal(&random), Normal(&random));
      solid.world_from_solid.translation_mm += moved;
      const core::TriangleTree part = PartAt(c.part_at + moved);
      const double true_mm = DistanceTo(MakeVisualHull(rig, MasksOf(*rig, solid)), part).interval.upper_mm;
      std::vector<core::SoftMask> masks;
      for (const core::CameraModel& camera : rig->cameras)
        masks.push_back({oracles::CenterMask(camera, std::vector<Solid>{solid}), {}});
      const VisualHull hull = MakeVisualHull(rig, masks);
      const review::Clearance found = DistanceTo(hull, part);
      ASSERT_TRUE(found.has_witnesses) << c.title;
      const core::ErrorBudget stated =
          errors.At(hull, found.interval.witness_hull_in_world_mm, found.interval.witness_part_in_world_mm);
      EXPECT_EQ(stated.segmentation_mm, 0.0);
      EXPECT_GT(stated.footprint_mm, 0.0);
      inside += std::abs(found.interval.upper_mm - true_mm) <= stated.ExpandedMm() ? 1 : 0;
      ++count;
    }
  }
  std::printf("%d of %d distances are within the stated bound\n", inside, count);
  EXPECT_GE(inside, 0.95 * count);
}

TEST(HullErrors, AreLessNearACameraAndWorstSomewhereInABox) {
  const SharedRig rig = TestRig();
  Random random(8203);
  const Eigen::MatrixXd factor = DrawFactor(*rig, &random);
  const HullErrors errors(*rig, {factor * factor.transpose(), core::kBoundarySigmaPx});
  const Eigen::AlignedBox3d box(Vector3d(-100.0, -80.0, -60.0), Vector3d(120.0, 90.0, 70.0));
  const double worst_mm = errors.WorstIn(box).CombinedMm();
  EXPECT_GE(worst_mm, errors.WorstAt(box.center()).CombinedMm());
  EXPECT_GE(worst_mm, errors.WorstAt(box.min()).CombinedMm());
  for (int i = 0; i < 1000; ++i) EXPECT_LE(errors.WorstAt(random.PointIn(box)).CombinedMm(), 1.02 * worst_mm);
  // Nothing is known of what no camera sees, and a part outside the workspace meets the hull inside.
  EXPECT_EQ(errors.WorstAt({0.0, 0.0, 5000.0}), core::ErrorBudget());
  EXPECT_GT(errors.WorstIn({Vector3d(300.0, 0.0, 0.0), Vector3d(400.0, 10.0, 10.0)}).CombinedMm(), 0.0);
  EXPECT_EQ(errors.WorstIn({}), core::ErrorBudget());
}

TEST(HullErrors, FacesOfTheWorkspaceAreExact) {
  const SharedRig rig = TestRig();
  Random random(8204);
  const Eigen::MatrixXd factor = DrawFactor(*rig, &random);
  const HullErrors errors(*rig, {factor * factor.transpose(), core::kBoundarySigmaPx});
  // A rod through the workspace's floor, and a part below it.
  const Solid rod = CapsuleBetween({0.0, 0.0, -400.0}, {0.0, 0.0, 100.0}, 60.0, kGrey);
  const VisualHull hull = MakeVisualHull(rig, MasksOf(*rig, rod));
  const core::TriangleTree part = PartAt({0.0, 0.0, -290.0});
  const review::Clearance found = DistanceTo(hull, part);
  ASSERT_TRUE(found.has_witnesses);
  ASSERT_NEAR(found.interval.witness_hull_in_world_mm.z(), -250.0, 1e-3);
  EXPECT_EQ(errors.At(hull, found.interval.witness_hull_in_world_mm, found.interval.witness_part_in_world_mm)
                .CombinedMm(),
            0.0);
}

TEST(HullErrors, RefusesACovarianceOfAnotherRig) {
  const SharedRig rig = TestRig();
  EXPECT_THROW(HullErrors(*rig, {Eigen::MatrixXd::Zero(3, 3), 0.2}), core::PreconditionError);
  EXPECT_THROW(HullErrors(*rig, {Eigen::MatrixXd::Zero(64, 64), -1.0}), core::Error);
}

}  // namespace
}  // namespace elbowroom::recon
