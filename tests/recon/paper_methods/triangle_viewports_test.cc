#include "recon/paper_methods/triangle_viewports.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <vector>

#include "core/error.h"
#include "tests/recon/scenes/part_samples.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// Double precision throughout: a hundred of its roundings, in units of single precision's.
constexpr SweepBand kDoubleBand{100.0 * 0x1p-29, 0.0};

TriangleViewport ViewportOf(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                            const TriangleViewportOptions& options = {}) {
  return {{a, b, c}, options};
}

std::vector<core::SoftMask> SoftMasks(Random* random, const std::vector<core::BitMask>& masks) {
  std::vector<core::SoftMask> soft;
  for (const core::BitMask& mask : masks) {
    soft.push_back(random->Chance(0.5) ? WithRandomLevels(random, mask) : core::SoftMask{mask, {}});
  }
  return soft;
}

TEST(TriangleViewport, TwoCentimetresAreSampledEveryTwoMillimetres) {
  // The paper: "0.2 cm x 0.2 cm collision point detection error".
  const TriangleViewport half_square = ViewportOf({5, 5, 5}, {25, 5, 5}, {5, 25, 5});
  EXPECT_DOUBLE_EQ(half_square.StepMm(), 2.0);
  const TriangleViewport equilateral = ViewportOf({0, 0, 0}, {20, 0, 0}, {10, 10 * std::sqrt(3.0), 0});
  EXPECT_DOUBLE_EQ(equilateral.StepMm(), 2.0);
}

TEST(TriangleViewport, CornersKeepTheirPlaces) {
  Random random(7301);
  for (int i = 0; i < 200; ++i) {
    TriangleViewportOptions options;
    options.width_px = random.Whole(2, 40);
    options.height_px = random.Whole(2, 40);
    const std::array<Vector3d, 3> corners = {100.0 * random.Direction(), 100.0 * random.Direction(),
                                             100.0 * random.Direction()};
    const TriangleViewport viewport(corners, options);
    const auto at = [&](double x, double y) -> Vector3d {
      return viewport.origin_mm() + x * viewport.along_x_mm() + y * viewport.along_y_mm();
    };
    for (const Vector3d& place :
         {at(0, 0), at(options.width_px, 0), at(viewport.apex_x_px(), options.height_px)}) {
      const auto is_there = [&](const Vector3d& corner) { return (corner - place).norm() < 1e-11; };
      EXPECT_TRUE(std::ranges::any_of(corners, is_there));
    }
    // Seen along its normal, but for the sixteenth that the apex' column is rounded by, and the one that it
    // may stand beside its base.
    const double shear = viewport.along_x_mm().dot(viewport.along_y_mm()) * options.height_px /
                         viewport.along_x_mm().squaredNorm();
    EXPECT_LE(std::abs(shear), 1.0 / 8.0 + 1e-9);
  }
}

TEST(TriangleViewport, WithoutAreaItIsStillOnItsPoints) {
  const Vector3d a(10, 20, 30), b(50, 20, 30);
  const std::array<std::array<Vector3d, 3>, 4> flat = {
      {{a, a, a}, {a, b, a}, {a, b, 0.3 * a + 0.7 * b}, {a, a + Vector3d(1e-200, 0, 0), a}}};
  for (const auto& corners : flat) {
    const TriangleViewport viewport(corners, {});
    for (int row = 0; row < 10; ++row) {
      const TriangleViewport::Columns columns = viewport.ColumnsOf(row);
      for (int column = columns.begin; column < columns.end; ++column) {
        const Vector3d x = viewport.PositionOf(column, row);
        EXPECT_LT((b - a).cross(x - a).norm(), 1e-9);
        EXPECT_GE(x.x(), a.x() - 1e-9);
        EXPECT_LE(x.x(), b.x() + 1e-9);
      }
    }
  }
}

TEST(TriangleViewport, CoversHalfOfIt) {
  Random random(7302);
  constexpr double kMostBesideHalf = 2.5;  // either way half a sample of a row, of ten, half of them alike
  std::int64_t samples = 0;
  constexpr int kTriangles = 400;
  for (int i = 0; i < kTriangles; ++i) {
    const TriangleViewport viewport = ViewportOf(random.Direction(), random.Direction(), random.Direction());
    for (int row = 0; row < 10; ++row) {
      const TriangleViewport::Columns columns = viewport.ColumnsOf(row);
      ASSERT_GE(columns.begin, 0);
      ASSERT_LE(columns.begin, columns.end);
      ASSERT_LE(columns.end, 10);
      samples += columns.end - columns.begin;
    }
  }
  EXPECT_NEAR(static_cast<double>(samples) / kTriangles, 50.0, kMostBesideHalf);  // u v / 2
}

TEST(SampleTriangles, IsTheOraclesOnRandomScenes) {
  Random random(7303);
  int hull_samples = 0, unsure = 0;
  for (int i = 0; i < 60 * test_support::SoakScale(); ++i) {
    const RandomScene scene =
        i % 2 == 0 ? MakeRandomScene(&random)
                   : MakeRingScene(&random, 2 + i % 4,
                                   i % 4 == 1 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain);
    const auto masks = SoftMasks(&random, scene.masks);
    const core::TriangleMesh part = RandomTriangles(&random, scene.rig->workspace_mm, 40);
    const TriangleViewportOptions options{random.Whole(2, 24), random.Whole(2, 24)};
    const CoverageHull hull(*scene.rig, masks);
    const SampledContacts sampled = SampleTriangles(hull, part, {}, options);
    const SampleCheck check = CheckSamples(*scene.rig, masks, part, {}, options, sampled, kDoubleBand);
    ASSERT_EQ(check.wrong_samples, 0) << "scene " << i << ": " << check.first_wrong;
    hull_samples += check.hull_samples;
    unsure += check.unsure_samples;
  }
  EXPECT_GT(hull_samples, 5'000);
  EXPECT_LT(unsure, hull_samples / 100);
}

TEST(SampleTriangles, CountsWorkAsThePaperDoes) {
  Random random(7305);
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
  const core::TriangleMesh part = RandomTriangles(&random, scene.rig->workspace_mm, 720);
  const SampledContacts sampled =
      SampleTriangles(CoverageHull(*scene.rig, SoftMasks(&random, scene.masks)), part, {});
  EXPECT_EQ(sampled.work.triangles, 3 * 720);  // n m
  EXPECT_EQ(sampled.work.pixels, 3 * sampled.samples);
  EXPECT_NEAR(static_cast<double>(sampled.work.pixels), 108'000.0,
              0.05 * 3 * 720 * 50);  // n m u v / 2
  EXPECT_EQ(sampled.work.read_backs, 0);
}

TEST(SampleTriangles, OneThreadGivesTheSameContacts) {
  Random random(7306);
  const RandomScene scene = MakeRingScene(&random, 4, core::UnseenPolicy::kAbstain);
  const CoverageHull hull(*scene.rig, SoftMasks(&random, scene.masks));
  const core::TriangleMesh part = RandomTriangles(&random, scene.rig->workspace_mm, 200);
  const core::RigidTransform world_from_part{random.Rotation(), 10.0 * random.Direction()};
  const SampledContacts many = SampleTriangles(hull, part, world_from_part);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  const SampledContacts one = SampleTriangles(hull, part, world_from_part);
  ASSERT_GT(one.contacts.size(), 50U);
  ASSERT_EQ(one.contacts.size(), many.contacts.size());
  for (std::size_t i = 0; i < one.contacts.size(); ++i) {
    EXPECT_EQ(one.contacts[i].triangle, many.contacts[i].triangle);
    EXPECT_EQ(one.contacts[i].position_in_world_mm, many.contacts[i].position_in_world_mm);
  }
}

TEST(CompareSamples, ExplainsRoundingAndNothingElse) {
  Random random(7307);
  const RandomScene scene = MakeRingScene(&random, 4, core::UnseenPolicy::kOutside);
  const CoverageHull hull(*scene.rig, SoftMasks(&random, scene.masks));
  const core::TriangleMesh part = RandomTriangles(&random, scene.rig->workspace_mm, 200);
  const SampledContacts right = SampleTriangles(hull, part, {});
  EXPECT_EQ(CompareSamples(hull, right, right).differing_samples, 0);
  SampledContacts wrong = right;
  std::int64_t unexplained = 0;
  std::erase_if(wrong.contacts, [&](const ViewportContact& contact) {
    const bool is_erased = contact.column == 3;
    unexplained += is_erased && !hull.IsMatterOfRounding(contact.position_in_world_mm) ? 1 : 0;
    return is_erased;
  });
  EXPECT_GT(unexplained, 0);
  const SampleComparison comparison = CompareSamples(hull, right, wrong);
  EXPECT_EQ(comparison.differing_samples,
            static_cast<std::int64_t>(right.contacts.size() - wrong.contacts.size()));
  EXPECT_EQ(comparison.unexplained_samples, unexplained);
}

TEST(SampleTriangles, NothingToSample) {
  Random random(7308);
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
  const CoverageHull hull(*scene.rig, SoftMasks(&random, scene.masks));
  const SampledContacts none = SampleTriangles(hull, {}, {});
  EXPECT_TRUE(none.contacts.empty());
  EXPECT_EQ(none.samples, 0);
  EXPECT_THROW((void)SampleTriangles(hull, {}, {}, {1, 10}), core::PreconditionError);
  EXPECT_THROW((void)SampleTriangles(hull, {}, {}, {10, 401}), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
