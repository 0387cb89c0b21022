#include "recon/gl/paper_methods/triangle_viewports_gl.h"

#include <gtest/gtest.h>

#include <iostream>
#include <utility>
#include <vector>

#include "core/error.h"
#include "tests/recon/scenes/part_samples.h"
#include "tests/support/soak.h"

namespace elbowroom::recon::gl {
namespace {

// The whole way in single precision, from the triangle on (docs/paper_collision.md, "Rounding").
constexpr SweepBand kGlBand{64.0, kGlFilterCoverage};

std::vector<core::SoftMask> WithLevels(Random* random, const std::vector<core::BitMask>& masks) {
  std::vector<core::SoftMask> soft;
  for (const core::BitMask& mask : masks) {
    soft.push_back(random->Chance(0.5) ? WithRandomLevels(random, mask) : core::SoftMask{mask, {}});
  }
  return soft;
}

TEST(TriangleViewportsGl, IsTheOraclesOnRandomScenes) {
  Random random(7401);
  TriangleViewportsGl viewports;
  std::cout << viewports.driver() << '\n';
  int hull_samples = 0;
  for (int i = 0; i < 60 * test_support::SoakScale(); ++i) {
    const auto unseen = i % 4 == 1 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene =
        i % 2 == 0 ? MakeRandomScene(&random) : MakeRingScene(&random, 2 + i % 4, unseen);
    const auto masks = WithLevels(&random, scene.masks);
    const core::TriangleMesh part = RandomTriangles(&random, scene.rig->workspace_mm, 60);
    const TriangleViewportOptions options{random.Whole(2, 24), random.Whole(2, 24)};
    const SampledContacts sampled = viewports.Sample(CoverageHull(*scene.rig, masks), part, {}, options);
    const SampleCheck check = CheckSamples(*scene.rig, masks, part, {}, options, sampled, kGlBand);
    ASSERT_EQ(check.wrong_samples, 0) << "scene " << i << ": " << check.first_wrong;
    hull_samples += check.hull_samples;
  }
  EXPECT_GT(hull_samples, 5'000);
}

// Sample by sample; where they differ, rounding decides, and that is seldom.
TEST(TriangleViewportsGl, AgreesWithTheCpu) {
  constexpr double kMostInTheBand = 0.02;  // of the contacts
  Random random(7402);
  TriangleViewportsGl viewports;
  std::int64_t contacts = 0, differing = 0;
  for (int i = 0; i < 12; ++i) {
    const auto unseen = i % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene = MakeRingScene(&random, 3 + i % 3, unseen);
    const CoverageHull hull(*scene.rig, WithLevels(&random, scene.masks));
    const core::TriangleMesh part = RandomTriangles(&random, scene.rig->workspace_mm, 300);
    const core::RigidTransform world_from_part{random.Rotation(), 10.0 * random.Direction()};
    const SampledContacts cpu = SampleTriangles(hull, part, world_from_part);
    const SampledContacts gl = viewports.Sample(hull, part, world_from_part);
    EXPECT_EQ(gl.samples, cpu.samples);
    EXPECT_EQ(gl.work.triangles, cpu.work.triangles);
    EXPECT_EQ(gl.work.pixels, cpu.work.pixels);
    EXPECT_EQ(gl.work.read_backs, 1);
    const SampleComparison comparison = CompareSamples(hull, cpu, gl);
    EXPECT_EQ(comparison.unexplained_samples, 0);
    contacts += static_cast<std::int64_t>(cpu.contacts.size());
    differing += comparison.differing_samples;
  }
  EXPECT_GT(contacts, 3000);
  EXPECT_LT(static_cast<double>(differing), kMostInTheBand * static_cast<double>(contacts));
}

// Where all is hull, the driver has covered the pixels that the processor counts: no more, no fewer.
TEST(TriangleViewportsGl, CoversTheVeryPixels) {
  Random random(7403);
  RandomScene scene = MakeRingScene(&random, 2, core::UnseenPolicy::kAbstain);
  for (core::BitMask& mask : scene.masks)
    for (int p = 0; p < mask.width_px() * mask.height_px(); ++p)
      mask.Set(p % mask.width_px(), p / mask.width_px(), true);
  const Eigen::AlignedBox3d middle(Eigen::Vector3d::Constant(-1.0), Eigen::Vector3d::Constant(1.0));
  TriangleViewportsGl viewports;
  for (const auto& [width_px, height_px] : {std::pair{10, 10}, {2, 2}, {7, 13}, {33, 5}, {400, 400}}) {
    const CoverageHull hull(*scene.rig, WithLevels(&random, scene.masks));
    const core::TriangleMesh part = RandomTriangles(&random, middle, width_px > 100 ? 9 : 2000);
    const SampledContacts gl = viewports.Sample(hull, part, {}, {width_px, height_px});
    EXPECT_EQ(static_cast<std::int64_t>(gl.contacts.size()), gl.samples);
    EXPECT_EQ(
        CompareSamples(hull, gl, SampleTriangles(hull, part, {}, {width_px, height_px})).differing_samples,
        0);
  }
}

TEST(TriangleViewportsGl, ManyTrianglesTakeMorePages) {
  Random random(7404);
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
  const CoverageHull hull(*scene.rig, WithLevels(&random, scene.masks));
  const core::TriangleMesh part = RandomTriangles(&random, scene.rig->workspace_mm, 1500);
  TriangleViewportsGl viewports;
  const TriangleViewportOptions options{40, 40};  // 25 x 25 a page
  const SampledContacts gl = viewports.Sample(hull, part, {}, options);
  EXPECT_EQ(gl.work.read_backs, 3);
  EXPECT_EQ(CompareSamples(hull, SampleTriangles(hull, part, {}, options), gl).unexplained_samples, 0);
  const SampledContacts paper = viewports.Sample(hull, part, {});
  EXPECT_EQ(paper.work.read_backs, 1);
  EXPECT_EQ(paper.work.read_back_pixels, 390 * 390);  // the paper's window of 400 x 400 holds 1600
}

TEST(TriangleViewportsGl, NothingToDraw) {
  Random random(7405);
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
  TriangleViewportsGl viewports;
  const SampledContacts none =
      viewports.Sample(CoverageHull(*scene.rig, WithLevels(&random, scene.masks)), {}, {});
  EXPECT_TRUE(none.contacts.empty());
  EXPECT_EQ(none.work.read_backs, 0);
}

TEST(TriangleViewportsGl, MovedFromIsNotUsed) {
  TriangleViewportsGl first;
  const TriangleViewportsGl second = std::move(first);
  EXPECT_FALSE(second.driver().empty());
  // NOLINTNEXTLINE(bugprone-use-after-move, clang-analyzer-cplusplus.Move)
  EXPECT_THROW((void)first.driver(), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon::gl
