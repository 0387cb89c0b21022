#include "recon/synthetic/camera_view.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "recon/synthetic/rig_presets.h"

namespace elbowroom::recon {
namespace {

// Shading hardly changes within a pixel of one solid, so a ray through its centre tells as much as nine; on
// the edge of the silhouette it takes all of them.
TEST(CameraView, LevelsByEdgesAreThoseOfAllRays) {
  constexpr int kSamples = 3;
  constexpr double kMostLevels =
      2.0;  // at the rim, where shading changes the fastest; rounding is half a level of it
  const CameraView view(FourCameraRig().cameras[0], 1);
  const Solid balls[] = {{Sphere{60.0}, {Eigen::Matrix3d::Identity(), {-80.0, 0.0, 150.0}}},
                         {Sphere{25.0}, {Eigen::Matrix3d::Identity(), {120.0, 30.0, 80.0}}}};
  cv::Mat rendered, difference;
  view.Render(balls, {.samples_per_pixel_side = kSamples}).convertTo(rendered, CV_32FC3);
  cv::absdiff(view.DrawLevels(balls, kSamples), rendered, difference);
  double most = 0.0;
  cv::minMaxLoc(difference.reshape(1), nullptr, &most);
  EXPECT_LT(most, kMostLevels);
  cv::absdiff(view.DrawLevels({}, kSamples), rendered, difference);
  cv::minMaxLoc(difference.reshape(1), nullptr, &most);
  EXPECT_GT(most, 50.0) << "the balls are seen";
}

}  // namespace
}  // namespace elbowroom::recon
