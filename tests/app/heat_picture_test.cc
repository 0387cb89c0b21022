// A part's heat as pixels: where it is, how strong, and that the rest stays grey.
#include "app/control/heat_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/surface_patches.h"
#include "tests/core/solids.h"

namespace elbowroom::control {
namespace {

constexpr int kColourful = 40;  // between a pixel's red and blue: grey has a few

struct Halves {
  int left = 0;
  int right = 0;
};

Halves CountColoured(const recon::Image& image) {
  Halves count;
  for (int y = 0; y < 560; ++y) {  // above the bars
    for (int x = 0; x < image.width_px; ++x) {
      const std::uint8_t* rgb = &image.rgb[3 * static_cast<std::size_t>(y * image.width_px + x)];
      if (rgb[0] - rgb[2] > kColourful) ++(x < image.width_px / 2 ? count.left : count.right);
    }
  }
  return count;
}

// A box whose lower or upper face is hot.
class HeatPictureTest : public testing::Test {
 protected:
  [[nodiscard]] core::HeatMap HotFace(double z_mm, float dwell_s, float depth_mm) const {
    const core::SurfacePatches patches(mesh_, core::kHeatPatchMm);
    core::HeatMap map;
    map.dwell_s.assign(patches.size(), 0.0F);
    map.peak_depth_mm.assign(patches.size(), 0.0F);
    for (std::size_t t = 0; t < mesh_->triangles.size(); ++t) {
      std::size_t patch = patches.FirstOf(t);
      for (const core::SurfacePatches::Corners& corners : patches.CornersOf(t)) {
        const bool is_hot = std::abs(corners.Centre().z() - z_mm) < 1e-6;
        map.dwell_s[patch] = is_hot ? dwell_s : 0.0F;
        map.peak_depth_mm[patch++] = is_hot ? depth_mm : 0.0F;
      }
    }
    return map;
  }
  const core::SharedMesh mesh_ =
      std::make_shared<const core::TriangleMesh>(core::testing::Box({100.0, 80.0, 20.0}));
  recon::gl::SceneRenderer renderer_;
};

TEST_F(HeatPictureTest, ShowsTheTouchedFaceFromWhicheverSideItIs) {
  for (const double z_mm : {0.0, 20.0}) {
    const recon::Image image = HeatPicture(renderer_, mesh_, HotFace(z_mm, 2.0F, 5.0F));
    ASSERT_EQ(image.width_px, 1200);
    const Halves hot = CountColoured(image);
    EXPECT_GT(hot.left, 20'000) << "the face fills much of the picture";
    EXPECT_NEAR(hot.left, hot.right, 0.02 * hot.left) << "dwell and depth in the same places";
  }
}

TEST_F(HeatPictureTest, WhatWasNotTouchedIsGrey) {
  const Halves cold = CountColoured(HeatPicture(renderer_, mesh_, HotFace(1e9, 0.0F, 0.0F)));
  EXPECT_EQ(cold.left, 0);
  EXPECT_EQ(cold.right, 0);
  const Halves only_deep = CountColoured(HeatPicture(renderer_, mesh_, HotFace(20.0, 0.0F, 5.0F)));
  EXPECT_EQ(only_deep.left, 0);
  EXPECT_GT(only_deep.right, 0);
}

TEST_F(HeatPictureTest, IsTheSameEachTime) {
  const core::HeatMap map = HotFace(0.0, 1.0F, 1.0F);
  EXPECT_EQ(HeatPicture(renderer_, mesh_, map), HeatPicture(renderer_, mesh_, map));
}

}  // namespace
}  // namespace elbowroom::control
