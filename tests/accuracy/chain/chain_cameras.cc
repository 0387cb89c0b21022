#include "tests/accuracy/chain/chain_cameras.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "recon/footage/background.h"
#include "recon/synthetic/sensor_noise.h"

namespace elbowroom::accuracy {
namespace {

using recon::CaptureClock;

constexpr double kPulseShare = 0.1, kPulseHz = 100.0;
constexpr double kNoiseLevels = 2.5, kBlurPx = 0.6;
constexpr int kEdgeSamples = 4;
constexpr int kBackgroundPictures = 60;
constexpr std::size_t kNoiseDraws = std::size_t{3} << 20U;

constexpr double kPeriodS = 1.0 / 30.0, kMostDrift = 50e-6, kExposureJitterS = 0.3e-3;
constexpr double kStampBiasS = 0.3e-3, kStampJitterS = 0.2e-3, kArrivalS = 8e-3;

double Normal(recon::Random* random) {
  const double u = random->Uniform(1e-12, 1.0), v = random->Uniform(0.0, 2.0 * std::numbers::pi);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(v);
}

CaptureClock::time_point At(double time_s) {
  return CaptureClock::time_point(
      std::chrono::duration_cast<CaptureClock::duration>(std::chrono::duration<double>(time_s)));
}
double SecondsOf(CaptureClock::time_point at) {
  return std::chrono::duration<double>(at.time_since_epoch()).count();
}

// Where the solids may be in the picture, with room for the blur.
cv::Rect BoxOf(const core::CameraModel& camera, std::span<const recon::Solid> solids) {
  constexpr double kMarginPx = 8.0, kLensMargin = 1.25;
  const Eigen::Matrix3d& k = camera.calibration().camera_matrix;
  cv::Rect box;
  for (const recon::Solid& solid : solids) {
    const recon::BoundingSphere sphere = recon::BoundingSphereOf(solid);
    const auto middle = camera.Project(sphere.center_in_world);
    if (!middle) return {0, 0, camera.width_px(), camera.height_px()};
    const double away_mm = (sphere.center_in_world - camera.center_in_world()).norm() - sphere.radius_mm;
    const double reach_px = kMarginPx + kLensMargin * k(0, 0) * sphere.radius_mm / away_mm;
    box |= cv::Rect(cv::Point(cvFloor(middle->x() - reach_px), cvFloor(middle->y() - reach_px)),
                    cv::Point(cvCeil(middle->x() + reach_px), cvCeil(middle->y() + reach_px)));
  }
  return box & cv::Rect(0, 0, camera.width_px(), camera.height_px());
}

void BlurAsALens(cv::Mat levels) { cv::GaussianBlur(levels, levels, cv::Size(5, 5), kBlurPx); }

}  // namespace

double ChainLight::GainAt(double time_s) const {
  const double pulse = std::sin(2.0 * std::numbers::pi * kPulseHz * time_s + pulse_phase_rad);
  return (1.0 + kPulseShare * pulse) * (level + drift_per_s * time_s);
}

ChainCameras::ChainCameras(core::Rig truth, std::uint64_t seed)
    : rig_(std::move(truth)), noise_(kNoiseDraws) {
  for (const core::CameraModel& camera : rig_.cameras) {
    views_.emplace_back(camera, seed);
    empty_bgr_.push_back(views_.back().DrawLevels({}, kEdgeSamples));
    BlurAsALens(empty_bgr_.back());
  }
  recon::DrawRowNoise(recon::StreamSeed(seed, 0, 0, 0), noise_);
}

cv::Mat ChainCameras::Take(core::CameraIndex camera, std::span<const recon::Solid> solids, double gain,
                           std::uint64_t seed) const {
  const cv::Mat& empty = empty_bgr_[camera];
  cv::Mat levels = empty;
  if (!solids.empty()) {
    levels = empty.clone();
    const cv::Rect box = BoxOf(rig_.cameras[camera], solids);
    const cv::Mat drawn = views_[camera].DrawLevels(solids, kEdgeSamples);
    cv::Mat part = levels(box);
    drawn(box).copyTo(part);
    BlurAsALens(part);
  }
  const auto row_draws = static_cast<std::size_t>(3 * levels.cols);
  cv::Mat picture(levels.size(), CV_8UC3);
  for (int y = 0; y < levels.rows; ++y) {
    const double share =
        recon::UniformFrom(recon::StreamSeed(seed, 0, camera, static_cast<std::uint64_t>(y)));
    const auto from = static_cast<std::size_t>(share * static_cast<double>(noise_.size() - row_draws));
    // Read only.
    const cv::Mat noise(1, levels.cols, CV_32FC3, const_cast<float*>(noise_.data() + from));
    cv::addWeighted(levels.row(y), gain, noise, kNoiseLevels, 0.0, picture.row(y), CV_8U);
  }
  return picture;
}

std::vector<recon::BackgroundReference> ChainCameras::TakeBackgrounds(std::uint64_t seed) const {
  std::vector<recon::BackgroundReference> backgrounds;
  for (core::CameraIndex camera = 0; camera < views_.size(); ++camera) {
    recon::BackgroundAccumulator background;
    for (int i = 0; i < kBackgroundPictures; ++i) {
      const std::uint64_t picture = recon::StreamSeed(seed, i, camera, 1);
      const ChainLight light{2.0 * std::numbers::pi * recon::UniformFrom(picture)};
      background.Add(Take(camera, {}, light.GainAt(0.0), picture));
    }
    backgrounds.push_back(background.Reference());
  }
  return backgrounds;
}

ChainClock::ChainClock(std::size_t cameras, std::uint64_t seed)
    : random_(seed),
      cameras_(cameras),
      assembler_(cameras, {kPeriodS, {}}, [](core::CameraIndex, const recon::CapturedPicture&) {}) {
  for (Camera& camera : cameras_) {
    camera.phase_s = random_.Uniform(0.0, kPeriodS);
    camera.period_s = kPeriodS * (1.0 + random_.Uniform(-kMostDrift, kMostDrift));
    camera.stamp_bias_s = kStampBiasS * Normal(&random_);
  }
}

void ChainClock::TakeNextPicture() {
  const auto next_of = [](const Camera& camera) {
    return camera.phase_s + static_cast<double>(camera.instants.size()) * camera.period_s;
  };
  const auto next = std::ranges::min_element(cameras_, {}, next_of);
  const std::uint64_t number = next->instants.size();
  const double true_s = next_of(*next) + kExposureJitterS * Normal(&random_);
  const double stamp_s = true_s + next->stamp_bias_s + kStampJitterS * Normal(&random_);
  now_ = std::max(now_, At(next_of(*next) + kArrivalS));
  recon::CapturedPicture picture;
  picture.number = number;
  picture.taken_at = At(stamp_s);
  picture.arrived_at = now_;
  next->instants.push_back({true_s, {number, SecondsOf(picture.taken_at)}});
  assembler_.Add(static_cast<core::CameraIndex>(next - cameras_.begin()), std::move(picture));
}

ChainClock::Set ChainClock::Next() {
  for (;;) {
    const std::optional<recon::PictureSet> decided = assembler_.TryTake(now_);
    if (!decided) {
      TakeNextPicture();
      continue;
    }
    Set set{SecondsOf(decided->taken_at), {}};
    for (core::CameraIndex i = 0; i < cameras_.size(); ++i)
      if (const auto& picture = decided->pictures[i])
        set.cameras.push_back(cameras_[i].instants[picture->number]);
    if (set.cameras.size() == cameras_.size()) return set;
  }
}

}  // namespace elbowroom::accuracy
