// Heat against a hull of known shape.
#include "review/contact_heat.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "review/contacts.h"
#include "tests/core/solids.h"
#include "tests/review/box_hull.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using Hull = std::shared_ptr<const recon::VisualHull>;

// Half a pixel of its cameras, where the box's edges may lie.
constexpr double kEdgeMm = 0.5;
constexpr double kFloat = 1e-5;  // seconds and millimetres of this size in 32 bits

Hull Box(bool is_empty = false) { return std::make_shared<const recon::VisualHull>(BoxHull(is_empty)); }

// A plate of 200 x 200 mm, 4 mm thick: its middle part is in the hull, a box of +-50 mm.
core::TriangleTree Plate() {
  return core::TriangleTree(std::make_shared<const core::TriangleMesh>(
      core::Transformed(core::testing::Box({200.0, 200.0, 4.0}),
                        {Eigen::Matrix3d::Identity(), Vector3d(-100.0, -100.0, -2.0)})));
}

// Feeds frames at these times, in contact where a hull is given.
class Feed {
 public:
  explicit Feed(const core::TriangleTree& tree) : tree_(tree), heat_({&tree_, 1}) {}
  void Add(double time_s, const Hull& hull, const core::RigidTransform& pose = {}) {
    const core::PartContact contact = FindContacts(*hull, tree_, pose, 0);
    heat_.Add(time_s, hull, {&pose, 1}, {&contact, 1});
  }
  [[nodiscard]] std::vector<core::HeatMap> Maps() const { return heat_.Maps(); }

 private:
  const core::TriangleTree& tree_;
  ContactHeat heat_;
};

TEST(ContactHeat, IsWhereThePartIsInTheHull) {
  const core::TriangleTree tree = Plate();
  Feed feed(tree);
  const Hull hull = Box();
  feed.Add(0.0, hull);
  feed.Add(0.25, hull);
  const core::HeatMap map = feed.Maps().at(0);
  const core::SurfacePatches patches(tree.shared_mesh(), map.patch_mm);
  ASSERT_EQ(map.dwell_s.size(), patches.size());
  int hot = 0;
  for (std::size_t t = 0; t < tree.mesh().triangles.size(); ++t) {
    const std::vector<core::SurfacePatches::Corners> corners = patches.CornersOf(t);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const std::size_t i = patches.FirstOf(t) + k;
      const Vector3d x = corners[k].Centre();
      const double inside_mm = 50.0 - std::max(std::abs(x.x()), std::abs(x.y()));
      if (inside_mm > kEdgeMm) {
        ++hot;
        EXPECT_NEAR(map.dwell_s[i], 0.5, kFloat) << "two frames of a quarter second";
        EXPECT_LE(map.peak_depth_mm[i], inside_mm + kEdgeMm + map.patch_mm) << "of any point of the patch";
        EXPECT_GT(map.peak_depth_mm[i], 0.0F);
      } else if (inside_mm < -10.0) {
        EXPECT_EQ(map.dwell_s[i], 0.0F);
        EXPECT_EQ(map.peak_depth_mm[i], 0.0F);
      }
    }
  }
  EXPECT_GT(hot, 300);
}

TEST(ContactHeat, DwellsFromFrameToFrame) {
  const core::TriangleTree tree = Plate();
  Feed feed(tree);
  const Hull hull = Box(), nothing = Box(true);
  feed.Add(10.0, nothing);
  feed.Add(11.0, hull);
  feed.Add(11.5, nothing);
  feed.Add(14.0, hull);  // the last frame lasts as long as the mean: (14 - 10) / 3 s
  const core::HeatMap map = feed.Maps().at(0);
  const float most_s = *std::max_element(map.dwell_s.begin(), map.dwell_s.end());
  EXPECT_NEAR(most_s, 0.5 + 4.0 / 3.0, kFloat);
  EXPECT_EQ(feed.Maps().at(0).dwell_s, map.dwell_s) << "looking changes nothing";
}

TEST(FindTouchedPatches, AreThoseOfThePartHoweverItStands) {
  const core::TriangleTree tree = Plate();
  const core::SurfacePatches patches(tree.shared_mesh(), core::kHeatPatchMm);
  const Hull hull = Box();
  // Half a turn about z, which neither the box nor the plate's faces notice.
  const Vector3d off_center(1.3, 0.7, 0.0);  // no patch's middle is on the box's faces then
  const core::RigidTransform straight{Eigen::Matrix3d::Identity(), off_center};
  const core::RigidTransform turned = core::FromPositionAndRollPitchYaw(off_center, {0.0, 0.0, M_PI});
  const std::vector<TouchedPatch> here = FindTouchedPatches(*hull, tree, straight, patches, {}),
                                  there = FindTouchedPatches(*hull, tree, turned, patches, {});
  // The faces' halves have their patches elsewhere: those along the box's faces may be others.
  EXPECT_NEAR(static_cast<double>(here.size()), static_cast<double>(there.size()), 30.0);
  ASSERT_GT(here.size(), 300U);
  const core::RigidTransform shifted{Eigen::Matrix3d::Identity(), {200.0, 0.0, 0.0}};
  EXPECT_TRUE(FindTouchedPatches(*hull, tree, shifted, patches, {}).empty());
}

// Every patch's middle, asked alone.
std::vector<TouchedPatch> AskedOneByOne(const recon::VisualHull& hull, const core::TriangleTree& tree,
                                        const core::RigidTransform& pose,
                                        const core::SurfacePatches& patches) {
  std::vector<TouchedPatch> touched;
  for (std::size_t t = 0; t < tree.mesh().triangles.size(); ++t) {
    std::size_t patch = patches.FirstOf(t);
    for (const core::SurfacePatches::Corners& corners : patches.CornersOf(t)) {
      const Vector3d middle = pose * corners.Centre();
      if (hull.Contains(middle)) touched.push_back({patch, hull.Probe(middle).radius_mm});
      ++patch;
    }
  }
  return touched;
}

TEST(FindTouchedPatches, AreThoseOfAskingEachPatchAlone) {
  const core::TriangleTree tree = Plate();
  const core::SurfacePatches patches(tree.shared_mesh(), core::kHeatPatchMm);
  const Hull hull = Box();
  std::mt19937 random(4);
  std::uniform_real_distribution<double> shift_mm(-90.0, 90.0), angle(-M_PI, M_PI);
  std::vector<double> peak_mm(patches.size(), 0.0);
  std::size_t all = 0, known = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const core::RigidTransform pose =
        core::FromPositionAndRollPitchYaw({shift_mm(random), shift_mm(random), shift_mm(random)},
                                          {angle(random), angle(random), angle(random)});
    const std::vector<TouchedPatch> expected = AskedOneByOne(*hull, tree, pose, patches),
                                    found = FindTouchedPatches(*hull, tree, pose, patches, {}),
                                    deeper = FindTouchedPatches(*hull, tree, pose, patches, {}, peak_mm);
    ASSERT_EQ(found.size(), expected.size());
    ASSERT_EQ(deeper.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(found[i].patch, expected[i].patch);
      EXPECT_EQ(found[i].depth_mm, expected[i].depth_mm);
      double& peak = peak_mm[expected[i].patch];
      EXPECT_EQ(std::max(deeper[i].depth_mm, peak), std::max(expected[i].depth_mm, peak));
      known += deeper[i].depth_mm == 0.0 ? 1 : 0;
      peak = std::max(peak, expected[i].depth_mm);
    }
    all += expected.size();
  }
  EXPECT_GT(all, 5000U);
  EXPECT_GT(known, all / 4) << "depths that can't be a patch's largest aren't worked out";
}

TEST(ContactHeat, ANarrowContactShowsByItsPoints) {
  const core::TriangleTree tree = Plate();
  const Hull hull = Box();
  // Only a corner of the plate is in the hull, by less than a patch.
  const core::RigidTransform pose{Eigen::Matrix3d::Identity(), Vector3d(148.0, 148.0, 0.0)};
  Feed feed(tree);
  feed.Add(0.0, hull, pose);
  ASSERT_EQ(FindContacts(*hull, tree, pose, 0).verdict, core::Verdict::kContact);
  ASSERT_EQ(feed.Maps().size(), 1U);
  const std::vector<float> depth_mm = feed.Maps()[0].peak_depth_mm;
  EXPECT_GT(*std::max_element(depth_mm.begin(), depth_mm.end()), 0.0F);
}

TEST(ContactHeat, APartThatIsNeverTouchedHasNoMap) {
  const core::TriangleTree tree = Plate();
  Feed feed(tree);
  feed.Add(0.0, Box(true));
  EXPECT_TRUE(feed.Maps().empty());
}

}  // namespace
}  // namespace elbowroom::review
