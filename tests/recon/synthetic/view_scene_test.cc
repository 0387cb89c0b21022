#include "recon/synthetic/view_scene.h"

#include <gtest/gtest.h>

#include <memory>
#include <ostream>

#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {

void PrintTo(ViewSceneRig rig, std::ostream* out) {
  constexpr const char* kNames[] = {"Paper", "Three", "Four", "Eight"};
  *out << kNames[static_cast<std::size_t>(rig)];
}

namespace {

class ViewScenes : public testing::TestWithParam<ViewSceneRig> {};

TEST_P(ViewScenes, ShowTheHullOnAboutSixPercentOfTheView) {
  // Hulls of different rigs differ in size; "about 6 %" is what the figures in docs/performance.md are told
  // for.
  constexpr double kLeastShare = 0.045, kLargestShare = 0.075;
  for (const auto& [width_px, height_px] : {std::pair{640, 480}, {160, 120}}) {
    const ViewScene scene = MakeViewScene(GetParam(), width_px, height_px);
    const auto rig = std::make_shared<const core::Rig>(scene.rig);
    const HullView view = ViewHull(MakeVisualHull(rig, TrueMasks(scene.rig, scene.objects)), scene.view);
    const double share = static_cast<double>(view.hit_pixels) / (width_px * height_px);
    EXPECT_GT(share, kLeastShare);
    EXPECT_LT(share, kLargestShare);
  }
}

INSTANTIATE_TEST_SUITE_P(OfEveryRig, ViewScenes,
                         testing::Values(ViewSceneRig::kPaper, ViewSceneRig::kThree, ViewSceneRig::kFour,
                                         ViewSceneRig::kEight),
                         [](const auto& rig) { return testing::PrintToString(rig.param); });

}  // namespace
}  // namespace elbowroom::recon
