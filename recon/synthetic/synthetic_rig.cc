#include "recon/synthetic/synthetic_rig.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <opencv2/core.hpp>
#include <utility>

#include "core/error.h"
#include "recon/synthetic/sensor_noise.h"

namespace elbowroom::recon {
namespace {

constexpr std::uint64_t kFlickerRow = ~std::uint64_t{0};  // a stream of its own beside the image rows'

// Mean and standard deviation of every pixel and channel, image by image.
class PixelStatistics {
 public:
  void Add(const cv::Mat& image_bgr) {
    cv::Mat levels;
    image_bgr.convertTo(levels, CV_64FC3);
    if (frames_ == 0) {
      sum_ = cv::Mat::zeros(levels.size(), CV_64FC3);
      sum_of_squares_ = cv::Mat::zeros(levels.size(), CV_64FC3);
    }
    sum_ += levels;
    sum_of_squares_ += levels.mul(levels);
    ++frames_;
  }

  [[nodiscard]] BackgroundReference Result() const {
    const double n = frames_;
    const cv::Mat mean = sum_ / n;
    cv::Mat sigma = cv::Mat::zeros(mean.size(), CV_64FC3);
    if (frames_ > 1) {
      cv::Mat variance = (sum_of_squares_ - sum_.mul(mean)) / (n - 1.0);
      cv::max(variance, 0.0, variance);  // rounding can leave a constant pixel just below zero
      cv::sqrt(variance, sigma);
    }
    BackgroundReference reference;
    mean.convertTo(reference.mean_bgr, CV_32FC3);
    sigma.convertTo(reference.sigma_bgr, CV_32FC3);
    reference.frames = frames_;
    return reference;
  }

 private:
  cv::Mat sum_;
  cv::Mat sum_of_squares_;
  int frames_ = 0;
};

}  // namespace

void SyntheticRigOptions::Validate() const {
  core::Require(noise_from >= 0, "noise_from is not negative");
  core::Require(frame_rate_hz > 0.0, "frame_rate_hz is positive");
  core::Require(!frame_count || *frame_count > 0, "frame_count is positive");
  core::Require(noise_sigma_levels >= 0.0, "noise_sigma_levels is not negative");
  core::Require(flicker_share >= 0.0 && flicker_share <= 0.5, "flicker_share lies between 0 and 0.5");
  core::Require(background_frames > 0, "background_frames is positive");
  core::Require(samples_per_pixel_side >= 1 && samples_per_pixel_side <= 16,
                "samples_per_pixel_side lies between 1 and 16");
}

SyntheticRig::SyntheticRig(core::Rig rig, SceneAtTime scene_at, SyntheticRigOptions options)
    : rig_(std::move(rig)),
      scene_at_(std::move(scene_at)),
      options_(std::move(options)),
      empty_(std::make_shared<Empty>()) {
  options_.Validate();
  rig_.Validate();
  core::Require(static_cast<bool>(scene_at_), "a synthetic rig has a scene");
  empty_->views.reserve(rig_.cameras.size());
  for (const core::CameraModel& camera : rig_.cameras) empty_->views.emplace_back(camera, options_.seed);
}

SyntheticRig SyntheticRig::Before(SceneAtTime scene_at, std::optional<core::FrameIndex> frame_count,
                                  core::FrameIndex noise_from) const {
  SyntheticRig rig(*this);
  rig.scene_at_ = std::move(scene_at);
  rig.options_.frame_count = frame_count;
  rig.options_.noise_from = noise_from;
  rig.options_.Validate();
  core::Require(static_cast<bool>(rig.scene_at_), "a synthetic rig has a scene");
  return rig;
}

cv::Mat SyntheticRig::Capture(core::CameraIndex camera, core::FrameIndex noise_frame,
                              std::span<const Solid> solids) const {
  Exposure exposure;
  exposure.noise_seed = StreamSeed(options_.seed, noise_frame, camera, 0);
  const double swing = 2.0 * UniformFrom(StreamSeed(exposure.noise_seed, 0, 0, kFlickerRow)) - 1.0;
  exposure.gain = 1.0 + options_.flicker_share * swing;
  exposure.noise_sigma_levels = options_.noise_sigma_levels;
  exposure.table_shadow = options_.table_shadow;
  exposure.samples_per_pixel_side = options_.samples_per_pixel_side;
  return empty_->views[camera].Render(solids, exposure);
}

std::optional<FrameSet> SyntheticRig::TryRead(core::FrameIndex index, std::stop_token /*stop*/) {
  if (index < 0) {
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("frame {} is out of range: frames count from 0", index));
  }
  if (options_.frame_count && index >= *options_.frame_count) return std::nullopt;
  const std::vector<SyntheticObject> objects = ObjectsAt(index);
  const std::vector<Solid> solids = AllSolids(objects);
  FrameSet set;
  set.index = index;
  set.time_s = TimeOfFrameS(index);
  set.cameras.resize(empty_->views.size());
  tbb::parallel_for(std::size_t{0}, set.cameras.size(), [&](std::size_t i) {
    set.cameras[i].image_bgr = Capture(i, options_.noise_from + index, solids);
  });
  return set;
}

// Each gets pictures of its own.
std::vector<BackgroundReference> SyntheticRig::ReadBackgrounds(const core::Progress& progress,
                                                               std::stop_token stop) {
  const std::lock_guard lock(empty_->mutex);
  // While it waits for its own work, the thread must not begin other work that wants the lock.
  tbb::this_task_arena::isolate([&] {
    if (empty_->backgrounds.empty()) empty_->backgrounds = MeasureBackgrounds(progress, stop);
  });
  std::vector<BackgroundReference> references = empty_->backgrounds;
  for (BackgroundReference& reference : references) {
    reference.mean_bgr = reference.mean_bgr.clone();
    reference.sigma_bgr = reference.sigma_bgr.clone();
  }
  return references;
}

std::vector<BackgroundReference> SyntheticRig::MeasureBackgrounds(const core::Progress& progress,
                                                                  const std::stop_token& stop) const {
  std::vector<PixelStatistics> statistics(empty_->views.size());
  for (int frame = 0; frame < options_.background_frames; ++frame) {
    core::ThrowIfStopped(stop, "measuring the simulated background");
    // Negative noise frames: the background's noise is never that of a frame of the trial.
    tbb::parallel_for(std::size_t{0}, statistics.size(),
                      [&](std::size_t i) { statistics[i].Add(Capture(i, -1 - frame, {})); });
    progress.Report(frame + 1, options_.background_frames, "measuring the simulated background");
  }
  std::vector<BackgroundReference> references;
  references.reserve(statistics.size());
  for (const PixelStatistics& camera : statistics) references.push_back(camera.Result());
  return references;
}

double SyntheticRig::TimeOfFrameS(core::FrameIndex index) const {
  return static_cast<double>(index) / options_.frame_rate_hz;
}

std::vector<SyntheticObject> SyntheticRig::ObjectsAt(core::FrameIndex index) const {
  return scene_at_(TimeOfFrameS(index));
}

std::vector<core::BitMask> SyntheticRig::TrueMasks(std::span<const SyntheticObject> objects) const {
  const std::vector<Solid> solids = AllSolids(objects);
  std::vector<core::BitMask> masks;
  masks.reserve(empty_->views.size());
  for (const CameraView& view : empty_->views) masks.push_back(view.TrueMask(solids));
  return masks;
}

}  // namespace elbowroom::recon
