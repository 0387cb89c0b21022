#include "tests/recon/light/light_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "recon/footage/background.h"
#include "recon/synthetic/sensor_noise.h"

namespace elbowroom::recon {
namespace {

constexpr int kWidthPx = 320, kHeightPx = 240;

// Smooth from one whole number to the next, 0 to 1.
double Wander(std::uint64_t seed, double at) {
  const double whole = std::floor(at), t = at - whole, u = t * t * (3.0 - 2.0 * t);
  const auto value = [&](double i) {
    return UniformFrom(StreamSeed(seed, static_cast<std::int64_t>(i), 0, 7));
  };
  return (1.0 - u) * value(whole) + u * value(whole + 1.0);
}

cv::Point2d HandAt(std::uint64_t seed, double time_s, double hover_s) {
  // A place to work at, left within two seconds for the next; around it, movements of a second or two, and a
  // tremble.
  constexpr double kMoveS = 2.0;
  const double stay = std::floor(time_s / hover_s), into_s = time_s - stay * hover_s;
  const auto place = [&](double of, std::uint64_t axis) {
    return 0.2 + 0.6 * UniformFrom(StreamSeed(seed + axis, static_cast<std::int64_t>(of), 1, 3));
  };
  const double share = std::min(into_s / kMoveS, 1.0);
  const auto along = [&](std::uint64_t axis) {
    const double work = 0.07 * (Wander(seed + 10 + axis, time_s / 1.5) - 0.5);
    const double tremble = 0.006 * (Wander(seed + 20 + axis, time_s * 9.0) - 0.5);
    return (1.0 - share) * place(stay - 1.0, axis) + share * place(stay, axis) + work + tremble;
  };
  return {along(0) * kWidthPx, along(1) * kHeightPx};
}

void DrawHand(std::uint64_t seed, double time_s, double hover_s, double from_x, cv::Mat* levels,
              cv::Mat* mask) {
  const cv::Point2d hand = HandAt(seed, time_s, hover_s);
  const cv::Scalar skin(115 + 10 * Wander(seed + 30, time_s), 145 + 8 * Wander(seed + 31, time_s), 200);
  const cv::Point palm(static_cast<int>(hand.x), static_cast<int>(hand.y));
  const cv::Point elbow(static_cast<int>(from_x * kWidthPx), kHeightPx + 30);
  for (cv::Mat* picture : {levels, mask}) {
    const cv::Scalar color = picture == mask ? cv::Scalar(255) : skin;
    cv::line(*picture, palm, elbow, color, 24);
    cv::circle(*picture, palm, 20, color, cv::FILLED);
    for (int finger = 0; finger < 4; ++finger) {
      const double angle = -2.2 + 0.4 * finger + 0.4 * Wander(seed + 40, time_s + finger);
      cv::line(
          *picture, palm,
          {palm.x + static_cast<int>(36 * std::cos(angle)), palm.y + static_cast<int>(36 * std::sin(angle))},
          color, 8);
    }
  }
}

}  // namespace

LightScene::LightScene(TableGround ground, double noise_levels, std::uint64_t seed, double hover_s)
    : noise_levels_(noise_levels), seed_(seed), hover_s_(hover_s), levels_(kHeightPx, kWidthPx, CV_32FC3) {
  for (int y = 0; y < kHeightPx; ++y) {
    for (int x = 0; x < kWidthPx; ++x) {
      auto& level = levels_.at<cv::Vec3f>(y, x);
      const auto cloth = static_cast<float>(
          8.0 * UniformFrom(StreamSeed(seed, x / 5, static_cast<std::uint64_t>(y / 5), 0)));
      const double patch = UniformFrom(StreamSeed(seed, x / 31, static_cast<std::uint64_t>(y / 31), 1));
      switch (ground) {
        case TableGround::kDarkCloth:
          level = cv::Vec3f(38, 30, 26) + cv::Vec3f::all(cloth);
          break;
        case TableGround::kGreyTable:
          level = cv::Vec3f(120, 122, 118) + cv::Vec3f::all(0.2F * cloth);
          break;
        case TableGround::kPatchwork:
          level = cv::Vec3f::all(static_cast<float>(30.0 + 150.0 * patch));
          break;
      }
    }
  }
  cv::GaussianBlur(levels_, levels_, cv::Size(5, 5), 0.8);
}

BackgroundReference LightScene::Background() const {
  BackgroundAccumulator background;
  for (int frame = 1; frame <= 30; ++frame) background.Add(At(-frame, {1.0, 1.0, 1.0}, false).image_bgr);
  return background.Reference();
}

DrawnPicture LightScene::At(double time_s, std::array<double, 3> gain_bgr, bool hands,
                            const cv::Rect& thing_px) const {
  cv::Mat levels = levels_.clone(), mask(levels.size(), CV_8U, cv::Scalar(0));
  if (!thing_px.empty()) levels(thing_px).setTo(cv::Scalar(90, 70, 60)), mask(thing_px).setTo(255);
  if (hands) {
    DrawHand(seed_ + 100, time_s, hover_s_, 0.2, &levels, &mask);
    DrawHand(seed_ + 200, time_s, hover_s_, 0.8, &levels, &mask);
  }
  DrawnPicture picture{cv::Mat(levels.size(), CV_8UC3), core::BitMask(kWidthPx, kHeightPx)};
  std::vector<float> draws(3 * kWidthPx);
  const std::uint64_t noise_seed = StreamSeed(seed_, std::bit_cast<std::int64_t>(time_s), 0, 0);
  for (int y = 0; y < kHeightPx; ++y) {
    DrawRowNoise(StreamSeed(noise_seed, 0, 0, static_cast<std::uint64_t>(y)), draws);
    const auto* level = levels.ptr<float>(y);
    auto* out = picture.image_bgr.ptr<std::uint8_t>(y);
    std::array<float, 3> gain{};
    for (std::size_t c = 0; c < 3; ++c) gain[c] = static_cast<float>(gain_bgr[c]);
    const auto noise = static_cast<float>(noise_levels_);
    for (std::size_t i = 0; i < draws.size(); ++i)
      out[i] = static_cast<std::uint8_t>(
          std::clamp(gain[i % 3] * level[i] + noise * draws[i] + 0.5F, 0.0F, 255.0F));
    for (int x = 0; x < kWidthPx; ++x)
      if (mask.at<std::uint8_t>(y, x) != 0) picture.mask.Set(x, y, true);
  }
  return picture;
}

}  // namespace elbowroom::recon
