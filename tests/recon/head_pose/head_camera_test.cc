// A head camera registered by marked points and by steps of the hand.
#include "recon/head_pose/head_camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector2d;
using Eigen::Vector3d;

double TurnBetween(const HeadCamera& a, const HeadCamera& b) {
  return AngleAxisd(a.head_from_camera.rotation.transpose() * b.head_from_camera.rotation).angle();
}

// A camera as it is worn: some centimetres above the eyes, turned by some degrees.
HeadCamera AsWorn(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  HeadCamera camera;
  camera.head_from_camera = {
      AngleAxisd(0.12 * any(random), Vector3d(any(random), any(random), any(random)).normalized())
          .toRotationMatrix(),
      {20.0 * any(random), -60.0 + 20.0 * any(random), 40.0 + 20.0 * any(random)}};
  camera.focal_px = 620.0 + 80.0 * any(random);
  return camera;
}

// Corners of parts on a table before the head, of different heights.
std::vector<SeenPoint> PointsOf(const HeadCamera& camera, int count, double noise_px, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<SeenPoint> points;
  while (static_cast<int>(points.size()) < count) {
    SeenPoint point;
    point.x_in_head = {220.0 * any(random), 160.0 * any(random), 700.0 + 200.0 * any(random)};
    point.pixel = PixelOf(camera, point.x_in_head);
    if (point.pixel.x() < 0 || point.pixel.y() < 0 || point.pixel.x() > 639 || point.pixel.y() > 479)
      continue;
    point.pixel += noise_px * Vector2d(noise(random), noise(random));
    points.push_back(point);
  }
  return points;
}

// Without noise the camera is found from that which nobody has registered: at the eyes, looking straight on.
TEST(HeadCamera, IsFoundFromExactPoints) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const HeadCamera truth = AsWorn(random);
    const auto fit = FitHeadCamera(HeadCamera(), PointsOf(truth, 8, 0.0, random));
    EXPECT_EQ(fit.fitted, 7);
    EXPECT_LT(fit.rms_px, 1e-6);
    EXPECT_LT((fit.camera.head_from_camera.translation_mm - truth.head_from_camera.translation_mm).norm(),
              1e-3);
    EXPECT_LT(TurnBetween(fit.camera, truth), 1e-6);
    EXPECT_NEAR(fit.camera.focal_px, truth.focal_px, 1e-3);
  }
}

// Clicks of half a pixel: other points of the scene are then where they belong to within a pixel or two.
TEST(HeadCamera, ClicksOfHalfAPixelRegisterTheScene) {
  // The worst of 4,000 points lies farther out than all that were clicked.
  constexpr double kClickPx = 0.5, kWorstPx = 4.0, kUsualPx = 1.0;
  std::mt19937 random(2);
  int all = 0, usual = 0;
  for (int i = 0; i < 200; ++i) {
    const HeadCamera truth = AsWorn(random);
    const auto fit = FitHeadCamera(HeadCamera(), PointsOf(truth, 10, kClickPx, random));
    EXPECT_LT(fit.rms_px, 4.0 * kClickPx);
    for (const SeenPoint& other : PointsOf(truth, 20, 0.0, random)) {
      const double off_px = (PixelOf(fit.camera, other.x_in_head) - other.pixel).norm();
      EXPECT_LT(off_px, kWorstPx);
      ++all;
      usual += off_px < kUsualPx ? 1 : 0;
    }
  }
  EXPECT_GT(usual, all * 9 / 10);
}

// With fewer points less is fitted, and they are met.
TEST(HeadCamera, FewPointsFitLess) {
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const HeadCamera truth = AsWorn(random);
    for (const int count : {1, 2, 3}) {
      HeadCamera start;
      if (count == 3) start.focal_px = truth.focal_px;  // three points don't tell it
      const auto fit = FitHeadCamera(start, PointsOf(truth, count, 0.0, random));
      EXPECT_EQ(fit.fitted, 2 * count);
      EXPECT_LT(fit.rms_px, 1e-3);
      if (count < 3) {
        EXPECT_EQ(fit.camera.head_from_camera.translation_mm, start.head_from_camera.translation_mm);
      }
      if (count != 2) {
        EXPECT_EQ(fit.camera.focal_px, start.focal_px);
      }
    }
  }
}

TEST(HeadCamera, StepsMoveWhatIsSeenAsTheySay) {
  const HeadCamera camera;
  const Vector3d ahead(0.0, 0.0, 800.0);
  const Vector2d middle = PixelOf(camera, ahead);
  EXPECT_LT((PixelOf(Turned(camera, {10.0, 0.0}), ahead) - middle - Vector2d(10.0, 0.0)).norm(), 1e-9);
  EXPECT_LT((PixelOf(Turned(camera, {0.0, 7.0}), ahead) - middle - Vector2d(0.0, 7.0)).norm(), 1e-9);
  // Clockwise: what is above goes to the right.
  const Vector2d above = PixelOf(Rolled(camera, 0.1), {0.0, -100.0, 800.0}) - middle;
  EXPECT_GT(above.x(), 5.0);
  EXPECT_LT(above.y(), 0.0);
  // The camera moves to the right: what it sees goes to the left.
  EXPECT_NEAR(PixelOf(Moved(camera, {8.0, 0.0, 0.0}), ahead).x() - middle.x(), -6.0, 1e-9);
  const Vector2d right = PixelOf(Scaled(camera, 1.1), {100.0, 0.0, 800.0}) - middle;
  EXPECT_NEAR(right.x(), 1.1 * 75.0, 1e-9);
}

TEST(HeadCamera, AnotherSizeSeesTheSame) {
  const HeadCamera camera, large = ResizedTo(camera, 1280, 960);
  const Vector3d point(100.0, 50.0, 700.0);
  EXPECT_LT((PixelOf(large, point) + Vector2d(0.5, 0.5) - 2.0 * (PixelOf(camera, point) + Vector2d(0.5, 0.5)))
                .norm(),
            1e-9);
}

TEST(HeadCamera, RefusesWhatCannotBe) {
  EXPECT_THROW((void)FitHeadCamera(HeadCamera(), {}), core::Error);
  const SeenPoint behind{{0.0, 0.0, -500.0}, {300.0, 200.0}};
  EXPECT_THROW((void)FitHeadCamera(HeadCamera(), std::span(&behind, 1)), core::Error);
  HeadCamera camera;
  camera.focal_px = 0.0;
  EXPECT_THROW(camera.Validate(), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
