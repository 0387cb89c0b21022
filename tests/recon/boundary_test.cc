#include "recon/boundary.h"

#include <gtest/gtest.h>

#include <iostream>
#include <opencv2/core.hpp>
#include <vector>

#include "core/error.h"
#include "recon/segmentation.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "tests/recon/boundary_error.h"

namespace elbowroom::recon {
namespace {

struct Errors {
  BoundaryError located, detected;
};

// The demo's task at three moments, four cameras each, every pixel the mean of 64 rays.
Errors ErrorsWithNoise(double noise_sigma_levels, bool table_shadow) {
  SyntheticRigOptions options;
  options.noise_sigma_levels = noise_sigma_levels;
  options.flicker_share = 0.0;
  options.samples_per_pixel_side = 8;
  options.table_shadow = table_shadow;
  SyntheticRig rig(
      FourCameraRig(), [](double time_s) { return DemoSceneAt(time_s).objects; }, options);
  const auto backgrounds = rig.ReadBackgrounds({}, {});
  std::vector<BoundaryError> located, detected;
  for (const core::FrameIndex frame : {30, 100, 180}) {
    const FrameSet set = rig.Read(frame);
    const auto objects = rig.ObjectsAt(frame);
    const auto solids = AllSolids(objects);
    for (std::size_t i = 0; i < set.cameras.size(); ++i) {
      const Segmenter segmenter(backgrounds[i], {});
      const core::SoftMask soft = segmenter.SegmentSoft(set.cameras[i].image_bgr);
      soft.Validate();
      located.push_back(ErrorOfBoundary(soft, rig.rig().cameras[i], solids));
      detected.push_back(
          ErrorOfBoundary({segmenter.Segment(set.cameras[i].image_bgr), {}}, rig.rig().cameras[i], solids));
    }
  }
  const Errors errors{Pooled(located), Pooled(detected)};
  for (const auto& [name, error] : {std::pair{"located", errors.located}, {"detected", errors.detected}}) {
    std::cout << "noise " << noise_sigma_levels << (table_shadow ? ", shadow, " : ", ") << name << ": rms "
              << error.rms_px << " px, bias " << error.bias_px << " px, worst " << error.worst_px << " px, "
              << error.crossings << " crossings, " << error.unmatched << " unmatched\n";
  }
  return errors;
}

TEST(Boundary, IsLocatedBetweenPixelsThroughNoise) {
  const Errors errors = ErrorsWithNoise(0.02 * 255.0, false);  // the paper's 2 %
  EXPECT_LE(errors.located.rms_px, 0.15);
  EXPECT_LE(std::abs(errors.located.bias_px), 0.05);
  EXPECT_LT(errors.located.rms_px, errors.detected.rms_px / 2.0);
}

TEST(Boundary, IsExactToATwentiethOfAPixelWithoutNoise) {
  const Errors errors = ErrorsWithNoise(0.0, false);
  EXPECT_LE(errors.located.rms_px, 0.05);
  EXPECT_LT(errors.located.rms_px, errors.detected.rms_px / 4.0);
}

}  // namespace
}  // namespace elbowroom::recon
