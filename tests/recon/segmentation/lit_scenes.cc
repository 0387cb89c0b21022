#include "tests/recon/segmentation/lit_scenes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "core/error.h"
#include "recon/footage/background.h"
#include "recon/synthetic/actors.h"
#include "recon/synthetic/camera_view.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/sensor_noise.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kClothSeed = 1;
constexpr double kBlurPx = 0.7;

core::RigidTransform At(const Vector3d& origin_in_world) {
  core::RigidTransform world_from_solid;
  world_from_solid.translation_mm = origin_in_world;
  return world_from_solid;
}

Solid BoxAt(const Vector3d& center, const Vector3d& size_mm, const Vector3d& color_bgr) {
  return {Box{size_mm}, At(center), color_bgr};
}
Solid BallAt(const Vector3d& center, double radius_mm, const Vector3d& color_bgr) {
  return {Sphere{radius_mm}, At(center), color_bgr};
}

const Vector3d kSkin(120, 150, 210), kBlack(7, 7, 8), kWhite(248, 250, 252);

std::vector<Solid> CurvedSolids(const Vector3d& color_bgr) {
  return {BallAt({-60, 40, 70}, 60.0, color_bgr),
          CapsuleBetween({60, -90, 40}, {120, 60, 120}, 32.0, color_bgr)};
}

struct Arrangement {
  std::string name;
  std::vector<Solid> solids;
  bool is_textured = false;
};

std::vector<Arrangement> Arrangements() {
  const std::vector<Solid> crowded = AllSolids(DemoSceneAt(12.0).objects);
  const std::vector<Solid> large{BoxAt({0, 0, 80}, {1000, 760, 160}, kSkin)};
  std::vector<Solid> hollow;
  for (const double x : {-90.0, 0.0, 90.0})
    hollow.push_back({Tube{36.0, 33.0, 140.0}, At({x, 0.4 * x, 4}), kSkin});
  return {{"flat", {BoxAt({0, 0, 6}, {260, 180, 12}, kSkin)}},
          {"curved", CurvedSolids(kSkin)},
          {"hollow", hollow},
          {"tiny", {BallAt({-80, 0, 20}, 18.0, kSkin), BallAt({70, 50, 30}, 18.0, kSkin)}},
          {"crowded", crowded},
          {"dark", CurvedSolids(kBlack)},
          {"bright", CurvedSolids(kWhite)},
          {"large", large},
          {"crowded, textured", crowded, true},
          {"dark, textured", CurvedSolids(kBlack), true},
          {"large, textured", large, true}};
}

// A patchwork of 20 to 220 levels with soft seams, as a lens shows it.
cv::Mat Texture(const cv::Size& size, std::uint64_t seed) {
  constexpr int kPatchPx = 29;
  cv::Mat texture(size, CV_32FC3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const std::uint64_t patch = StreamSeed(seed, x / kPatchPx, static_cast<std::uint64_t>(y / kPatchPx),
                                               static_cast<std::uint64_t>(c));
        texture.at<cv::Vec3f>(y, x)[c] = static_cast<float>(20.0 + 200.0 * UniformFrom(patch));
      }
    }
  }
  cv::GaussianBlur(texture, texture, cv::Size(9, 9), 1.6);
  return texture;
}

LitScene SceneOf(const Arrangement& arrangement, const std::vector<CameraView>& views) {
  LitScene scene{arrangement.name, {}, {}, {}, 0.0};
  double pixels = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    cv::Mat empty, view;
    views[i].Render({}, {}).convertTo(empty, CV_32FC3);
    views[i].Render(arrangement.solids, {}).convertTo(view, CV_32FC3);
    core::BitMask truth = views[i].TrueMask(arrangement.solids);
    if (arrangement.is_textured) {
      empty = Texture(empty.size(), i);
      for (int y = 0; y < view.rows; ++y)
        for (int x = 0; x < view.cols; ++x)
          if (!truth.At(x, y)) view.at<cv::Vec3f>(y, x) = empty.at<cv::Vec3f>(y, x);
    }
    for (cv::Mat* levels : {&empty, &view}) cv::GaussianBlur(*levels, *levels, cv::Size(5, 5), kBlurPx);
    scene.object_share += static_cast<double>(truth.CountObjectPixels());
    pixels += static_cast<double>(view.total());
    scene.empty_bgr.push_back(empty), scene.view_bgr.push_back(view), scene.truth.push_back(std::move(truth));
  }
  scene.object_share /= pixels;
  return scene;
}

}  // namespace

std::string_view ToString(LightChange change) {
  switch (change) {
    case LightChange::kSteady:
      return "steady";
    case LightChange::kFlicker:
      return "flicker";
    case LightChange::kDrift:
      return "drift";
    case LightChange::kFlickerAndDrift:
      return "flicker and drift";
    case LightChange::kChannels:
      return "channels";
  }
  throw core::PreconditionError("a change of light");
}

Light LightAt(LightChange change, std::size_t camera, int frame, int frames) {
  Light light;
  const double part = frames > 1 ? static_cast<double>(frame) / (frames - 1) : 0.0;
  // A lamp's 100 pulses a second seen at 30 Hz: a third of a turn from frame to frame, shifted a little.
  const double flicker = 1.0 + 0.1 * std::sin(2.0 * std::numbers::pi * (frame / 3.0 + 0.15));
  const double drift = camera % 2 == 0 ? 1.0 - 0.2 * part : 1.0 + 0.2 * part;
  if (change == LightChange::kFlicker || change == LightChange::kFlickerAndDrift)
    for (double& gain : light.gain) gain *= flicker;
  if (change == LightChange::kDrift || change == LightChange::kFlickerAndDrift)
    for (double& gain : light.gain) gain *= drift;
  if (change == LightChange::kChannels) {
    light.gain = {0.85 + 0.1 * part, 1.05 - 0.1 * part, 1.1 + 0.1 * part};
    light.offset_levels = {8.0 * part, -4.0 * part, 6.0 - 4.0 * part};
  }
  return light;
}

std::vector<LitScene> LitScenes() {
  std::vector<CameraView> views;
  for (const core::CameraModel& camera : FourCameraRig().cameras) views.emplace_back(camera, kClothSeed);
  std::vector<LitScene> scenes;
  for (const Arrangement& arrangement : Arrangements()) scenes.push_back(SceneOf(arrangement, views));
  return scenes;
}

cv::Mat Exposed(const cv::Mat& levels_bgr, const Light& light, double noise_levels, std::uint64_t seed) {
  cv::Mat picture(levels_bgr.size(), CV_8UC3);
  std::vector<float> draws(static_cast<std::size_t>(levels_bgr.cols) * 3);
  for (int y = 0; y < levels_bgr.rows; ++y) {
    DrawRowNoise(StreamSeed(seed, 0, 0, static_cast<std::uint64_t>(y)), draws);
    const auto* levels = levels_bgr.ptr<float>(y);
    auto* out = picture.ptr<std::uint8_t>(y);
    for (std::size_t i = 0; i < draws.size(); ++i) {
      const double level = light.gain[i % 3] * static_cast<double>(levels[i]) + light.offset_levels[i % 3] +
                           noise_levels * static_cast<double>(draws[i]);
      out[i] = static_cast<std::uint8_t>(std::clamp(level + 0.5, 0.0, 255.0));
    }
  }
  return picture;
}

std::vector<BackgroundReference> BackgroundsOf(const LitScene& scene, double noise_levels) {
  constexpr int kFrames = 30;
  std::vector<BackgroundReference> backgrounds;
  for (std::size_t camera = 0; camera < scene.empty_bgr.size(); ++camera) {
    BackgroundAccumulator background;
    for (int frame = 0; frame < kFrames; ++frame)
      background.Add(Exposed(scene.empty_bgr[camera], {}, noise_levels, StreamSeed(2, frame, camera, 0)));
    backgrounds.push_back(background.Reference());
  }
  return backgrounds;
}

double WrongShare(const LitScene& scene, const std::vector<Segmenter>& segmenters, LightChange change,
                  double noise_levels, int frames) {
  double wrong = 0.0, pixels = 0.0;
  for (int frame = 0; frame < frames; ++frame) {
    for (std::size_t camera = 0; camera < segmenters.size(); ++camera) {
      const Light light = LightAt(change, camera, frame, frames);
      const cv::Mat picture =
          Exposed(scene.view_bgr[camera], light, noise_levels, StreamSeed(3, frame, camera, 0));
      const core::SoftMask found = segmenters[camera].SegmentSoft(picture);
      const auto words = found.mask.words(), true_words = scene.truth[camera].words();
      for (std::size_t i = 0; i < words.size(); ++i) wrong += std::popcount(words[i] ^ true_words[i]);
      pixels += static_cast<double>(picture.total());
    }
  }
  return wrong / pixels;
}

}  // namespace elbowroom::recon
