// Scenes under a changing light, and how wrong their silhouettes are against the exact truth.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/bit_mask.h"
#include "recon/footage/frame_set.h"
#include "recon/segmentation/segmentation.h"

namespace elbowroom::recon {

// What the light does over the frames of a run, against the light of the background reference.
enum class LightChange {
  kSteady,
  kFlicker,          // within 10 % from frame to frame
  kDrift,            // by 20 % in the run: down for cameras 0 and 2, up for the others
  kFlickerAndDrift,  // both
  kChannels,         // each channel has a gain (0.85 to 1.2) and an offset (-4 to 8 levels) of its own
};
inline constexpr LightChange kLightChanges[] = {LightChange::kSteady, LightChange::kFlicker,
                                                LightChange::kDrift, LightChange::kFlickerAndDrift,
                                                LightChange::kChannels};
[[nodiscard]] std::string_view ToString(LightChange change);

// Gain and offset of each channel.
struct Light {
  std::array<double, 3> gain{1.0, 1.0, 1.0};
  std::array<double, 3> offset_levels{0.0, 0.0, 0.0};
};
[[nodiscard]] Light LightAt(LightChange change, std::size_t camera, int frame, int frames);

// What four cameras of 640 x 480 see through a lens that blurs by 0.7 px, without noise: with objects and
// without.
struct LitScene {
  std::string name;
  std::vector<cv::Mat> empty_bgr, view_bgr;  // CV_32FC3
  std::vector<core::BitMask> truth;          // the pixels whose centre ray meets an object
  double object_share = 0.0;                 // of all pixels
};

// Flat, curved, hollow, tiny, crowded, dark, bright and large objects (a third of the picture), on the
// simulated cloth and on a texture of high contrast.
[[nodiscard]] std::vector<LitScene> LitScenes();

// CV_8UC3: a picture under a light with Gaussian noise, clipped as a sensor clips.
[[nodiscard]] cv::Mat Exposed(const cv::Mat& levels_bgr, const Light& light, double noise_levels,
                              std::uint64_t seed);

// One a camera, of 30 frames under steady light.
[[nodiscard]] std::vector<BackgroundReference> BackgroundsOf(const LitScene& scene, double noise_levels);

// Wrong pixels of all pixels of Segmenter::SegmentSoft over `frames` frames.
[[nodiscard]] double WrongShare(const LitScene& scene, const std::vector<Segmenter>& segmenters,
                                LightChange change, double noise_levels, int frames);

}  // namespace elbowroom::recon
