#include "app/control/segmentation/segmentation_settings.h"

#include <gtest/gtest.h>

#include <random>

#include "core/error.h"
#include "recon/images/mask_image.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

TEST(SegmentationSettings, ReadBackExactly) {
  const core::Rig rig = recon::FourCameraRig();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.01, 0.99);
  for (int i = 0; i < 50; ++i) {
    recon::SegmentationOptions options;
    options.method =
        i % 2 == 0 ? recon::SegmentationMethod::kThreshold : recon::SegmentationMethod::kAdaptive;
    options.shadows = i % 3 == 0 ? recon::ShadowRule::kKeep : recon::ShadowRule::kReject;
    options.k_sigma = 10.0 * share(random);
    options.floor_levels = 200.0 * share(random);
    options.min_blob_px = static_cast<int>(1000.0 * share(random));
    options.max_hole_px = static_cast<int>(1000.0 * share(random));
    options.edge_slack_px = share(random);
    options.shadow_darkest = share(random);
    options.shadow_chroma = share(random);
    options.cameras.push_back({rig.cameras[1].name(), share(random), std::nullopt, {}});
    options.cameras.push_back({rig.cameras[3].name(), std::nullopt, share(random), {}});
    const recon::SegmentationOptions read = OptionsFrom(SettingsOf(options), rig);
    EXPECT_EQ(SettingsOf(read), SettingsOf(options));
    EXPECT_EQ(read.k_sigma, options.k_sigma);
    EXPECT_EQ(read.ForCamera(rig.cameras[1].name()).k_sigma, options.cameras[0].k_sigma);
    EXPECT_EQ(read.ForCamera(rig.cameras[3].name()).floor_levels, options.cameras[1].floor_levels);
  }
  EXPECT_EQ(SettingsOf(OptionsFrom({}, rig)), SettingsOf(recon::SegmentationOptions()));
}

TEST(SegmentationSettings, RefuseWhatIsNone) {
  const core::Rig rig = recon::FourCameraRig();
  for (const auto& [key, value] : {std::pair{"segmentation.k_sigma", "5,0"},
                                   {"segmentation.method", "magic"},
                                   {"segmentation.min_blob_px", "2.5"},
                                   {"segmentation.k_sigma", "-1"}})
    EXPECT_THROW((void)OptionsFrom({{key, value}}, rig), core::Error) << key;
}

TEST(SegmentationSettings, KeepMasksOfIgnoredPixelsBesideFootage) {
  const core::Rig rig = recon::FourCameraRig();
  const test_support::TemporaryFolder folder;
  recon::SegmentationOptions options;
  core::BitMask mask(rig.cameras[2].width_px(), rig.cameras[2].height_px());
  mask.Set(3, 4, true);
  mask.Set(100, 50, true);
  options.cameras.push_back({rig.cameras[2].name(), std::nullopt, std::nullopt, mask});
  KeepIgnoredPixels(options, rig, folder.path());
  EXPECT_EQ(recon::ReadMaskImage(IgnoredPixelsFile(folder.path(), 2), "it"), mask);
  EXPECT_FALSE(exists(IgnoredPixelsFile(folder.path(), 0)));
  EXPECT_EQ(IgnoredPixelsOf(SettingsOf(options), rig.cameras[2]), 2);
  EXPECT_EQ(IgnoredPixelsOf(SettingsOf(options), rig.cameras[0]), 0);
}

}  // namespace
}  // namespace elbowroom::control
