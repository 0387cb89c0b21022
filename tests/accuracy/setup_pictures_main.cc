// draw_setup FOLDER: the pictures of "Set up the table" in the user guide. The demo's hand and pipe, as the
// simulated rig's front camera sees them, before good and bad backgrounds; below each the silhouette that the
// program's own segmentation finds: green where it is right, red where background counts as object, blue
// where object is missed.
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "recon/footage/background.h"
#include "recon/segmentation/segmentation.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/sensor_noise.h"
#include "recon/synthetic/synthetic_rig.h"

namespace {

using namespace elbowroom;
namespace fs = std::filesystem;

constexpr std::size_t kFrontCamera = 3;
constexpr double kTimeS = 5.0;        // the hand lowers the pipe
constexpr double kNoiseLevels = 2.0;  // 2 % of a middle grey, as the paper's cameras
constexpr int kBackgroundPictures = 30;
const cv::Rect kShownPx(90, 130, 352, 264);  // around hand and pipe

struct Subject {
  cv::Mat image_bgr;
  cv::Mat is_object;  // 255 or 0
};

Subject HandAndPipe() {
  recon::SyntheticRigOptions options;
  options.noise_sigma_levels = 0.0;
  options.flicker_share = 0.0;
  recon::SyntheticRig simulated(
      recon::FourCameraRig(), [](double t) { return recon::DemoSceneAt(t).objects; }, options);
  const auto frame = static_cast<core::FrameIndex>(kTimeS * options.frame_rate_hz);
  const auto objects = simulated.ObjectsAt(frame);
  const core::BitMask mask = simulated.TrueMasks(objects)[kFrontCamera];
  Subject subject{simulated.Read(frame).cameras[kFrontCamera].image_bgr,
                  cv::Mat(mask.height_px(), mask.width_px(), CV_8U, cv::Scalar(0))};
  for (int y = 0; y < mask.height_px(); ++y)
    for (int x = 0; x < mask.width_px(); ++x)
      if (mask.At(x, y)) subject.is_object.at<std::uint8_t>(y, x) = 255;
  return subject;
}

// A table: its level at a pixel, in the order blue, green, red.
using Cloth = std::function<cv::Vec3f(int x, int y)>;

cv::Mat Drawn(const Cloth& cloth, const cv::Size& size) {
  cv::Mat levels(size, CV_32FC3);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) levels.at<cv::Vec3f>(y, x) = cloth(x, y);
  return levels;
}

// What a camera makes of these levels; `shake_px`: how far it moved to the right.
cv::Mat Photographed(const cv::Mat& levels, int number, double shake_px = 0.0) {
  cv::Mat moved;
  const cv::Mat shift = (cv::Mat_<double>(2, 3) << 1, 0, shake_px, 0, 1, 0);
  cv::warpAffine(levels, moved, shift, levels.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::Mat noise(levels.size(), CV_32FC3), picture;
  for (int y = 0; y < levels.rows; ++y) {
    const std::uint64_t seed = recon::StreamSeed(1, number, 0, static_cast<std::uint64_t>(y));
    recon::DrawRowNoise(seed, {noise.ptr<float>(y), static_cast<std::size_t>(3 * levels.cols)});
  }
  cv::Mat noisy = moved + kNoiseLevels * noise;
  noisy.convertTo(picture, CV_8U);
  return picture;
}

// The camera's view while somebody works, before the table whose background was taken as `before` and is now
// `now`; and the silhouette below it.
cv::Mat Column(const Subject& subject, const cv::Mat& before, const cv::Mat& now, double shake_px = 0.0) {
  recon::BackgroundAccumulator accumulator;
  for (int i = 0; i < kBackgroundPictures; ++i) accumulator.Add(Photographed(before, i));
  cv::Mat levels = now.clone(), object;
  subject.image_bgr.convertTo(object, CV_32F);
  object.copyTo(levels, subject.is_object);
  const cv::Mat picture = Photographed(levels, kBackgroundPictures, shake_px);
  const recon::Segmenter segmenter(accumulator.Reference(), recon::SegmentationOptions());
  const core::BitMask found = segmenter.Segment(picture);
  cv::Mat verdict(picture.size(), CV_8UC3, cv::Scalar(24, 24, 24));
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const bool is = subject.is_object.at<std::uint8_t>(y, x) != 0, says = found.At(x, y);
      if (!is && !says) continue;
      verdict.at<cv::Vec3b>(y, x) = is && says ? cv::Vec3b(120, 190, 90)
                                    : says     ? cv::Vec3b(70, 70, 220)
                                               : cv::Vec3b(220, 130, 60);
    }
  }
  cv::Mat column;
  cv::vconcat(picture(kShownPx), verdict(kShownPx), column);
  return column;
}

void Write(const cv::Mat& good, const cv::Mat& bad, const fs::path& path) {
  constexpr int kGapPx = 12;
  cv::Mat both;
  cv::hconcat(std::vector<cv::Mat>{good, cv::Mat(good.rows, kGapPx, CV_8UC3, cv::Scalar::all(255)), bad},
              both);
  if (!cv::imwrite(path.string(), both)) std::cerr << path << ": can't be written\n";
}

cv::Vec3f DarkCloth(int x, int y) {
  const double weave = recon::UniformFrom(recon::StreamSeed(2, x / 4, static_cast<std::uint64_t>(y / 4), 0));
  return cv::Vec3f(34, 28, 26) + cv::Vec3f::all(static_cast<float>(5.0 * weave));
}

// Checks of 6 pixels, as a patterned table top.
cv::Vec3f PatternedCloth(int x, int y) {
  return (x / 6 + y / 6) % 2 == 0 ? cv::Vec3f(190, 195, 200) : cv::Vec3f(60, 60, 66);
}

// The mean colour of the hand: of those pixels that are much redder than blue.
cv::Vec3f SkinColour(const Subject& subject) {
  constexpr int kRedder = 30;
  cv::Mat channels[3], is_skin;
  cv::split(subject.image_bgr, channels);
  is_skin = (channels[2] > channels[0] + kRedder) & subject.is_object;
  const cv::Scalar skin = cv::mean(subject.image_bgr, is_skin);
  return {static_cast<float>(skin[0]), static_cast<float>(skin[1]), static_cast<float>(skin[2])};
}

// A patch of sun through a window, and the rest of the room a little brighter.
cv::Mat WithSun(const cv::Mat& levels) {
  cv::Mat lit = levels * 1.1, patch(levels.size(), CV_8U, cv::Scalar(0));
  const std::vector<cv::Point> window = {{200, 230}, {380, 200}, {425, 330}, {220, 375}};
  cv::fillConvexPoly(patch, window, cv::Scalar(255));
  cv::Mat bright = levels * 2.6;
  bright.copyTo(lit, patch);
  return lit;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: draw_setup FOLDER\n";
    return 2;
  }
  const fs::path folder = argv[1];
  const Subject subject = HandAndPipe();
  const cv::Size size = subject.image_bgr.size();
  const cv::Mat dark = Drawn(DarkCloth, size), patterned = Drawn(PatternedCloth, size);
  const cv::Vec3f skin = SkinColour(subject);
  const cv::Mat alike = Drawn([&](int, int) { return skin; }, size);
  constexpr double kShakePx = 1.5;  // a tripod that was knocked
  const cv::Mat good = Column(subject, dark, dark);
  Write(Column(subject, dark, dark, kShakePx), Column(subject, patterned, patterned, kShakePx),
        folder / "setup_cloth.png");
  Write(good, Column(subject, alike, alike), folder / "setup_colour.png");
  Write(good, Column(subject, dark, WithSun(dark)), folder / "setup_light.png");
  return 0;
}
