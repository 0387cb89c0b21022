// Segmentation of four 640 x 480 pictures on one thread, by part, beside OpenCV's ways; IoU on real footage
// and boundary error on simulated scenes as counters, of the same code with the same options as the times.
#include <benchmark/benchmark.h>

#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video.hpp>
#include <optional>
#include <string>
#include <vector>

#include "recon/footage/recorded_rig.h"
#include "recon/images/mask_image.h"
#include "recon/segmentation/boundary.h"
#include "recon/segmentation/coverage.h"
#include "recon/segmentation/difference_kernel.h"
#include "recon/segmentation/frame_segmenter.h"
#include "recon/segmentation/mask_regions.h"
#include "recon/segmentation/segmentation.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "tests/recon/segmentation/boundary_error.h"
#include "tests/support/places.h"

namespace elbowroom::recon {
namespace {

constexpr core::FrameIndex kFrame = 180;  // hand, tongs, cable and pipe
constexpr std::size_t kCameras = 4;

// The demo's scene with the paper's noise, every pixel the mean of 16 rays.
struct SimulatedScene {
  core::Rig rig = FourCameraRig();
  std::vector<Solid> solids;
  std::vector<BackgroundReference> backgrounds;
  FrameSet frames;
  std::vector<Segmenter> segmenters;
  std::vector<core::BitMask> detected;
};

const SimulatedScene& Simulated() {
  static const SimulatedScene scene = [] {
    SimulatedScene made;
    SyntheticRigOptions options;
    options.noise_sigma_levels = 0.02 * 255.0;
    options.flicker_share = 0.0;
    options.samples_per_pixel_side = 4;
    SyntheticRig rig(
        made.rig, [](double time_s) { return DemoSceneAt(time_s).objects; }, options);
    made.backgrounds = rig.ReadBackgrounds({}, {});
    made.frames = rig.Read(kFrame);
    const auto objects = rig.ObjectsAt(kFrame);
    made.solids = AllSolids(objects);
    for (std::size_t i = 0; i < kCameras; ++i) {
      made.segmenters.emplace_back(made.backgrounds[i], SegmentationOptions());
      made.detected.push_back(made.segmenters[i].Segment(made.frames.cameras[i].image_bgr));
    }
    return made;
  }();
  return scene;
}

const cv::Mat& Picture(std::size_t camera) { return Simulated().frames.cameras[camera].image_bgr; }

SegmentationOptions Bare(ShadowRule shadows) {
  SegmentationOptions options;
  options.shadows = shadows;
  options.min_blob_px = options.max_hole_px = 0;
  return options;
}

void CountBoundaryError(benchmark::State& state, const std::vector<core::SoftMask>& masks) {
  std::vector<BoundaryError> errors;
  std::size_t boundary_pixels = 0;
  for (std::size_t i = 0; i < kCameras; ++i) {
    errors.push_back(ErrorOfBoundary(masks[i], Simulated().rig.cameras[i], Simulated().solids));
    boundary_pixels += core::BoundaryPixels(masks[i].mask).CountObjectPixels();
  }
  const BoundaryError all = Pooled(errors);
  state.counters["boundary_pixels"] = static_cast<double>(boundary_pixels);
  state.counters["boundary_rms_px"] = all.rms_px;
  state.counters["boundary_bias_px"] = all.bias_px;
}

void Kernel(benchmark::State& state, ShadowRule shadows) {
  std::vector<Segmenter> segmenters;
  for (const BackgroundReference& background : Simulated().backgrounds)
    segmenters.emplace_back(background, Bare(shadows));
  for (auto _ : state)
    for (std::size_t i = 0; i < kCameras; ++i) benchmark::DoNotOptimize(segmenters[i].Segment(Picture(i)));
}
void SegmentKernel(benchmark::State& state) { Kernel(state, ShadowRule::kKeep); }
void SegmentKernelAndShade(benchmark::State& state) { Kernel(state, ShadowRule::kReject); }

void SegmentCleanUp(benchmark::State& state) {
  const SegmentationOptions options;
  std::vector<core::BitMask> raw;
  for (std::size_t i = 0; i < kCameras; ++i)
    raw.push_back(Segmenter(Simulated().backgrounds[i], Bare(ShadowRule::kReject)).Segment(Picture(i)));
  for (auto _ : state) {
    for (std::size_t i = 0; i < kCameras; ++i) {
      core::BitMask mask = raw[i];
      CleanUp(mask, options.min_blob_px, options.max_hole_px);
      benchmark::DoNotOptimize(mask);
    }
  }
}

void SegmentDetect(benchmark::State& state) {
  const SimulatedScene& scene = Simulated();
  for (auto _ : state)
    for (std::size_t i = 0; i < kCameras; ++i)
      benchmark::DoNotOptimize(scene.segmenters[i].Segment(Picture(i)));
  std::vector<core::SoftMask> masks;
  for (const core::BitMask& mask : scene.detected) masks.push_back({mask, {}});
  CountBoundaryError(state, masks);
}

void SegmentBoundary(benchmark::State& state) {
  const SegmentationOptions options;
  std::vector<cv::Mat> means;
  for (const BackgroundReference& background : Simulated().backgrounds)
    means.push_back(PackedMean(background.mean_bgr));
  for (auto _ : state) {
    for (std::size_t i = 0; i < kCameras; ++i) {
      benchmark::DoNotOptimize(
          LocateBoundary(Simulated().detected[i], Picture(i), means[i], options.floor_levels));
    }
  }
}

void SegmentWhole(benchmark::State& state) {
  std::vector<core::SoftMask> masks(kCameras);
  for (auto _ : state)
    for (std::size_t i = 0; i < kCameras; ++i) masks[i] = Simulated().segmenters[i].SegmentSoft(Picture(i));
  CountBoundaryError(state, masks);
}

void SegmentAdaptive(benchmark::State& state) {
  SegmentationOptions options;
  options.method = SegmentationMethod::kAdaptive;
  std::vector<Segmenter> segmenters;
  for (const BackgroundReference& background : Simulated().backgrounds)
    segmenters.emplace_back(background, options);
  for (auto _ : state)
    for (std::size_t i = 0; i < kCameras; ++i)
      benchmark::DoNotOptimize(segmenters[i].SegmentSoft(Picture(i)));
}

void ConfirmBlobs(benchmark::State& state) {
  const CrossCameraBlobs cross_camera_blobs(Simulated().rig);
  std::vector<const core::BitMask*> masks;
  for (const core::BitMask& mask : Simulated().detected) masks.push_back(&mask);
  for (auto _ : state) benchmark::DoNotOptimize(cross_camera_blobs.Confirm(masks));
}

// OpenCV's plain way: |I - B|, the largest channel, one threshold.
cv::Mat PlainDifference(const cv::Mat& image_bgr, const cv::Mat& mean_bgr) {
  constexpr double kThresholdLevels = 40.0;  // the best of 28 and 40 on the real footage
  cv::Mat difference, mask;
  cv::absdiff(image_bgr, mean_bgr, difference);
  std::array<cv::Mat, 3> channels;
  cv::split(difference, channels.data());
  cv::max(channels[0], channels[1], mask);
  cv::max(mask, channels[2], mask);
  cv::threshold(mask, mask, kThresholdLevels, 255.0, cv::THRESH_BINARY);
  return mask;
}

cv::Mat AsLevels(const cv::Mat& mean_bgr) {
  cv::Mat levels;
  mean_bgr.convertTo(levels, CV_8U);
  return levels;
}

cv::Ptr<cv::BackgroundSubtractorMOG2> TrainedMog2(const BackgroundReference& background, bool shadows) {
  constexpr int kTraining = 60;
  auto mog2 = cv::createBackgroundSubtractorMOG2(500, 16.0, shadows);
  cv::RNG random(1);
  for (int i = 0; i < kTraining; ++i) {
    cv::Mat noise(background.mean_bgr.size(), CV_32FC3), picture, ignored;
    random.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
    picture = background.mean_bgr + noise.mul(background.sigma_bgr);
    mog2->apply(AsLevels(picture), ignored);
  }
  return mog2;
}

void OpenCvDifference(benchmark::State& state) {
  cv::setNumThreads(1);
  std::vector<cv::Mat> means;
  for (const BackgroundReference& background : Simulated().backgrounds)
    means.push_back(AsLevels(background.mean_bgr));
  for (auto _ : state)
    for (std::size_t i = 0; i < kCameras; ++i)
      benchmark::DoNotOptimize(PlainDifference(Picture(i), means[i]));
}

void OpenCvMog2(benchmark::State& state) {
  cv::setNumThreads(1);
  std::vector<cv::Ptr<cv::BackgroundSubtractorMOG2>> models;
  for (const BackgroundReference& background : Simulated().backgrounds)
    models.push_back(TrainedMog2(background, true));
  cv::Mat mask;
  for (auto _ : state)
    for (std::size_t i = 0; i < kCameras; ++i) models[i]->apply(Picture(i), mask, 0.0);
}

// The real recording.
struct RealScene {
  core::Rig rig;
  std::vector<BackgroundReference> backgrounds;
  FrameSet frames;
  std::vector<cv::Mat> drawn;
};

const RealScene* Real() {
  static const std::optional<RealScene> scene = []() -> std::optional<RealScene> {
    const std::filesystem::path data = test_support::SharedDataFolder() / "four_cameras";
    if (!std::filesystem::exists(data / "rig.yml")) return std::nullopt;
    RecordedRig rig(ReadRigFile(data / "rig.yml")), truth(ReadRigFile(data / "hand_masks" / "rig.yml"));
    RealScene made{rig.rig(), rig.ReadBackgrounds({}, {}), rig.Read(0), {}};
    for (const CameraFrame& camera : truth.Read(0).cameras)
      made.drawn.push_back(ImageFromMask(*camera.ready_mask));
    return made;
  }();
  return scene ? &*scene : nullptr;
}

void CountIou(benchmark::State& state, const std::vector<cv::Mat>& masks) {
  double mean_iou = 0.0;
  for (std::size_t i = 0; i < kCameras; ++i) {
    const cv::Mat& drawn = Real()->drawn[i];
    const double iou =
        cv::countNonZero(masks[i] & drawn) / static_cast<double>(cv::countNonZero(masks[i] | drawn));
    state.counters["iou_cam" + std::to_string(i + 1)] = iou;
    mean_iou += iou / kCameras;
  }
  state.counters["iou"] = mean_iou;
}

bool HasReal(benchmark::State& state) {
  if (Real() == nullptr) state.SkipWithError("NOT MEASURED: ../shared/data/four_cameras is absent");
  return Real() != nullptr;
}

std::vector<Segmenter> RealSegmenters() {
  std::vector<Segmenter> segmenters;
  for (const BackgroundReference& background : Real()->backgrounds)
    segmenters.emplace_back(background, SegmentationOptions());
  return segmenters;
}

FrameSegmenter RealFrameSegmenter() { return {Real()->backgrounds, SegmentationOptions(), Real()->rig}; }

void RealFootageDetect(benchmark::State& state) {
  if (!HasReal(state)) return;
  const std::vector<Segmenter> segmenters = RealSegmenters();
  for (auto _ : state)
    for (std::size_t i = 0; i < kCameras; ++i)
      benchmark::DoNotOptimize(segmenters[i].Segment(Real()->frames.cameras[i].image_bgr));
  std::vector<cv::Mat> found;
  for (const core::BitMask& mask : RealFrameSegmenter().Segment(Real()->frames))
    found.push_back(ImageFromMask(mask));
  CountIou(state, found);
}

void RealFootage(benchmark::State& state) {
  if (!HasReal(state)) return;
  const std::vector<Segmenter> segmenters = RealSegmenters();
  for (auto _ : state)
    for (std::size_t i = 0; i < kCameras; ++i)
      benchmark::DoNotOptimize(segmenters[i].SegmentSoft(Real()->frames.cameras[i].image_bgr));
  std::vector<cv::Mat> found;
  for (const core::SoftMask& soft : RealFrameSegmenter().SegmentSoft(Real()->frames))
    found.push_back(ImageFromMask(soft.mask));
  CountIou(state, found);
}

// The others get the same clean-up and the same confirmation by the other cameras.
std::vector<cv::Mat> Cleaned(const std::vector<cv::Mat>& raw) {
  const SegmentationOptions options;
  std::vector<core::BitMask> masks;
  std::vector<const core::BitMask*> pointers;
  for (const cv::Mat& image : raw) {
    masks.push_back(MaskFromImage(image));
    CleanUp(masks.back(), options.min_blob_px, options.max_hole_px);
  }
  for (const core::BitMask& mask : masks) pointers.push_back(&mask);
  const auto confirmed = CrossCameraBlobs(Real()->rig).Confirm(pointers);
  std::vector<cv::Mat> cleaned;
  for (std::size_t i = 0; i < kCameras; ++i) {
    ClearRegions(masks[i], confirmed[i].blobs, confirmed[i].is_confirmed);
    cleaned.push_back(ImageFromMask(masks[i]));
  }
  return cleaned;
}

void RealFootageOpenCvDifference(benchmark::State& state) {
  if (!HasReal(state)) return;
  cv::setNumThreads(1);
  std::vector<cv::Mat> means, masks(kCameras);
  for (const BackgroundReference& background : Real()->backgrounds)
    means.push_back(AsLevels(background.mean_bgr));
  for (auto _ : state)
    for (std::size_t i = 0; i < kCameras; ++i)
      masks[i] = PlainDifference(Real()->frames.cameras[i].image_bgr, means[i]);
  CountIou(state, Cleaned(masks));
}

void RealFootageOpenCvMog2(benchmark::State& state) {
  if (!HasReal(state)) return;
  cv::setNumThreads(1);
  std::vector<cv::Ptr<cv::BackgroundSubtractorMOG2>> models;
  for (const BackgroundReference& background : Real()->backgrounds)
    models.push_back(TrainedMog2(background, true));
  std::vector<cv::Mat> masks(kCameras);
  for (auto _ : state)
    for (std::size_t i = 0; i < kCameras; ++i)
      models[i]->apply(Real()->frames.cameras[i].image_bgr, masks[i], 0.0);
  for (cv::Mat& mask : masks) mask = mask == 255;  // 127: its shadows
  CountIou(state, Cleaned(masks));
}

BENCHMARK(SegmentKernel)->Unit(benchmark::kMillisecond);
BENCHMARK(SegmentKernelAndShade)->Unit(benchmark::kMillisecond);
BENCHMARK(SegmentCleanUp)->Unit(benchmark::kMillisecond);
BENCHMARK(SegmentDetect)->Unit(benchmark::kMillisecond);
BENCHMARK(SegmentBoundary)->Unit(benchmark::kMillisecond);
BENCHMARK(SegmentWhole)->Unit(benchmark::kMillisecond);
BENCHMARK(SegmentAdaptive)->Unit(benchmark::kMillisecond);
BENCHMARK(ConfirmBlobs)->Unit(benchmark::kMillisecond);
BENCHMARK(OpenCvDifference)->Unit(benchmark::kMillisecond);
BENCHMARK(OpenCvMog2)->Unit(benchmark::kMillisecond);
BENCHMARK(RealFootageDetect)->Unit(benchmark::kMillisecond);
BENCHMARK(RealFootage)->Unit(benchmark::kMillisecond);
BENCHMARK(RealFootageOpenCvDifference)->Unit(benchmark::kMillisecond);
BENCHMARK(RealFootageOpenCvMog2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace elbowroom::recon
