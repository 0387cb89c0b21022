// A share of what `./dev bench hard` measures, held to slow checks; no times.
#include <gtest/gtest.h>

#include <string>

#include "review/contacts.h"
#include "tests/accuracy/hard/hard_assembly.h"
#include "tests/accuracy/hard/hard_errors.h"

namespace elbowroom::accuracy {
namespace {

constexpr HardOptions kFew{.triangles = 3000, .scan_triangles = 20'000, .places_each = 1, .seed = 77};
constexpr double kDepthShare = 1e-6;    // the exact view's float32
constexpr double kGrazingShare = 1e-3;  // of rays: they pass within rounding of the hull

class HardShapes : public testing::TestWithParam<HardHull> {
 protected:
  const SeenHull seen_ = SeeHull(GetParam(), recon::ViewSceneRig::kFour);
};

TEST_P(HardShapes, ContactsAndHeatAgreeWithAllPatchesAndBoundsHold) {
  std::vector<HardPart> parts = PartsForAll(kFew);
  for (HardPart& part : PartsAround(seen_, kFew)) parts.push_back(std::move(part));
  int in_contact = 0;
  for (const HardCase& at : CasesOf(seen_, parts, kFew)) {
    SCOPED_TRACE(at.part.name + ", " + std::string(ToString(at.place)));
    const core::TriangleTree& tree = *at.part.tree;
    const core::PartContact contact = review::FindContacts(*seen_.hull, tree, at.world_from_part, 0);
    std::vector<review::TouchedPatch> touched;
    const bool is_contact = contact.verdict == core::Verdict::kContact;
    if (is_contact)
      touched = review::FindTouchedPatches(*seen_.hull, tree, at.world_from_part, *at.part.patches, contact);
    EXPECT_EQ(ErrorsOf(contact, touched, *seen_.hull, at).sum(), 0);
    if (at.place == HardPlace::kTouching) {
      EXPECT_TRUE(is_contact);
    }
    if (at.place == HardPlace::kClose || at.place == HardPlace::kFar) {
      EXPECT_FALSE(is_contact);
    }
    in_contact += is_contact ? 1 : 0;
    const review::Clearance clearance = review::FindClearance(*seen_.hull, tree, at.world_from_part);
    EXPECT_TRUE(ErrorsOf(clearance.interval, *seen_.hull, tree, at.world_from_part).bounds_hold);
  }
  EXPECT_GE(in_contact, 11) << "seven parts touch, and four are amid the hull";
}

TEST_P(HardShapes, FinerContactsFindNoTouchThatIsMissed) {
  for (const HardCase& at : CasesOf(seen_, PartsForAll(kFew), kFew)) {
    SCOPED_TRACE(at.part.name + ", " + std::string(ToString(at.place)));
    const core::PartContact usual = review::FindContacts(*seen_.hull, *at.part.tree, at.world_from_part, 0);
    review::ContactOptions finer;
    finer.resolution_mm = 0.25 * usual.resolution_mm;
    const core::PartContact fine =
        review::FindContacts(*seen_.hull, *at.part.tree, at.world_from_part, 0, finer);
    if (fine.deepest && fine.deepest->depth_mm > usual.resolution_mm) {
      EXPECT_EQ(usual.verdict, core::Verdict::kContact);
    }
    if (usual.verdict == core::Verdict::kContact) {
      EXPECT_EQ(fine.verdict, core::Verdict::kContact);
    }
  }
}

TEST_P(HardShapes, ViewAgreesWithRays) {
  constexpr int kEvery = 8;
  const recon::ViewScene scene = recon::MakeViewScene(recon::ViewSceneRig::kFour);
  const ViewErrors errors = ErrorsOfView(*seen_.hull, scene.view, kEvery);
  EXPECT_GT(errors.hits, 50);
  EXPECT_LE(errors.depth_share, kDepthShare);
  EXPECT_LE(static_cast<double>(errors.wrong), kGrazingShare * static_cast<double>(errors.rays));
}

TEST_P(HardShapes, PartsOfAnAssemblyHaveTrueBounds) {
  static const HardAssembly assembly = ImportHardAssembly(kFew.seed);
  constexpr std::size_t kCheckEvery = 4;  // of three bodies in turns
  recon::Random random(kFew.seed);
  for (const HardPlace place : {HardPlace::kTouching, HardPlace::kAmid}) {
    const core::RigidTransform at = PlaceOf(seen_, assembly.whole, place, &random);
    int in_contact = 0;
    for (std::size_t i = 0; i < assembly.instances.size(); ++i) {
      review::InsideCells inside(assembly.TreeOf(i));
      const core::PartContact answer = ReviewOf(*seen_.hull, assembly, at, i, &inside);
      in_contact += answer.verdict == core::Verdict::kContact ? 1 : 0;
      ASSERT_TRUE(answer.clearance);
      if (i % kCheckEvery != 0) continue;
      EXPECT_TRUE(ErrorsOf(answer.clearance->interval, *seen_.hull, assembly.TreeOf(i),
                           at * assembly.instances[i].assembly_from_part)
                      .bounds_hold)
          << i;
    }
    EXPECT_GE(in_contact, 1) << ToString(place);
  }
}

INSTANTIATE_TEST_SUITE_P(Hulls, HardShapes, testing::ValuesIn(kHardHulls), [](const auto& test) {
  std::string name(ToString(test.param));
  std::erase(name, ' ');
  return name;
});

}  // namespace
}  // namespace elbowroom::accuracy
