#include "recon/light/empty_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/error.h"
#include "recon/light/light_pulse.h"
#include "recon/segmentation/exposure_estimator.h"

namespace elbowroom::recon {
namespace {

constexpr double kNoiseFactor = 5.0;
constexpr double kLeastDifferenceLevels = 8.0;  // less than half of the default `floor_levels`
constexpr double kEdgeSlackPx = 0.8;            // as SegmentationOptions::edge_slack_px
constexpr double kQuietShare = 0.25;            // of a level's pixels: those whose noise counts
constexpr double kMostSwing = 0.02;             // of the light, to either side; as LightPulse::matters
constexpr int kLevelsPerBin = 16, kBins = 256 / kLevelsPerBin;
constexpr std::size_t kLeastValues = 64;  // of a bin, so that its noise is known

// The light of a picture against that of the reference, as one factor a channel. Light is a factor of all
// levels, so it holds also for levels far from the mean one.
cv::Scalar GainOf(const ExposureChange& exposure, const cv::Scalar& mean_level) {
  cv::Scalar gain;
  for (int c = 0; c < 3; ++c) {
    const auto at = static_cast<std::size_t>(c);
    gain[c] = exposure.gain[at] + exposure.offset_levels[at] / std::max(mean_level[c], 1.0);
  }
  return gain;
}

// |picture - gain * mean| of each channel.
cv::Mat Difference(const cv::Mat& image_bgr, const cv::Mat& mean_bgr, const cv::Scalar& gain) {
  constexpr double kWhite = 255.0;
  cv::Mat expected, picture, difference;
  cv::multiply(mean_bgr, cv::Scalar(gain[0], gain[1], gain[2]), expected);
  cv::min(expected, kWhite, expected);
  image_bgr.convertTo(picture, CV_32F);
  cv::absdiff(picture, expected, difference);
  return difference;
}

using NoiseByBin = std::array<float, kBins>;

int BinOf(float level) { return std::clamp(static_cast<int>(level) / kLevelsPerBin, 0, kBins - 1); }

// A range of levels may consist of pixels that something moved through, as that of a bright sleeve on dark
// cloth. So its noise is at most what the well filled ranges let expect: noise grows by no more than the
// ratio of two levels, up or down. (Shot noise grows by the root of it; a gamma curve turns that round.) The
// darkest and the brightest range may be clipped, and say nothing of others.
NoiseByBin Plausible(const NoiseByBin& noise, const std::array<std::size_t, kBins>& counts) {
  constexpr double kWellFilled = 0.05;  // of all values
  std::size_t all = 0;
  for (const std::size_t count : counts) all += count;
  NoiseByBin plausible = noise;
  for (std::size_t j = 1; j + 1 < noise.size(); ++j) {
    if (static_cast<double>(counts[j]) < kWellFilled * static_cast<double>(all)) continue;
    for (std::size_t k = 0; k < noise.size(); ++k) {
      const double a = static_cast<double>(j) + 0.5, b = static_cast<double>(k) + 0.5;
      plausible[k] = std::min(plausible[k], noise[j] * static_cast<float>(std::max(a / b, b / a)));
    }
  }
  return plausible;
}

// The standard deviation of the quiet pixels of each range of levels.
NoiseByBin NoiseByLevel(const cv::Mat& mean_bgr, const cv::Mat& sum_squares, std::size_t n) {
  std::array<std::vector<float>, kBins> found;
  const cv::Mat mean = mean_bgr.reshape(1), sums = sum_squares.reshape(1);
  for (int y = 0; y < mean.rows; y += 2) {
    const auto* level = mean.ptr<float>(y);
    const auto* squares = sums.ptr<float>(y);
    for (int x = 0; x < mean.cols; ++x)
      found[static_cast<std::size_t>(BinOf(level[x]))].push_back(squares[x]);
  }
  NoiseByBin noise{};
  std::array<std::size_t, kBins> counts{};
  float largest = 0.0F;
  for (std::size_t bin = 0; bin < found.size(); ++bin) {
    std::vector<float>& values = found[bin];
    counts[bin] = values.size();
    if (values.size() < kLeastValues) continue;
    const auto quiet =
        values.begin() + static_cast<std::ptrdiff_t>(kQuietShare * static_cast<double>(values.size()));
    std::nth_element(values.begin(), quiet, values.end());
    noise[bin] = std::sqrt(*quiet / static_cast<float>(n - 1));
    largest = std::max(largest, noise[bin]);
  }
  for (std::size_t bin = 0; bin < found.size(); ++bin)
    if (counts[bin] < kLeastValues) noise[bin] = largest;
  return Plausible(noise, counts);
}

// What a pixel and channel may differ by: noise, and a camera that shakes.
cv::Mat Allowed(const cv::Mat& mean_bgr, const NoiseByBin& noise) {
  cv::Mat across, down, allowed(mean_bgr.size(), CV_32FC3);
  cv::Sobel(mean_bgr, across, CV_32F, 1, 0, 3, 1.0 / 8.0);
  cv::Sobel(mean_bgr, down, CV_32F, 0, 1, 3, 1.0 / 8.0);
  for (int y = 0; y < mean_bgr.rows; ++y) {
    const auto* level = mean_bgr.ptr<float>(y);
    const auto *gx = across.ptr<float>(y), *gy = down.ptr<float>(y);
    auto* out = allowed.ptr<float>(y);
    for (int x = 0; x < 3 * mean_bgr.cols; ++x) {
      const double by_noise =
          kNoiseFactor * static_cast<double>(noise[static_cast<std::size_t>(BinOf(level[x]))]);
      out[x] = static_cast<float>(std::max(by_noise, kLeastDifferenceLevels) +
                                  kEdgeSlackPx *
                                      std::hypot(static_cast<double>(gx[x]), static_cast<double>(gy[x])));
    }
  }
  return allowed;
}

// 255 where any channel differs by more than is allowed, without what is narrower than three pixels.
cv::Mat Beyond(const cv::Mat& difference, const cv::Mat& allowed) {
  cv::Mat channels_beyond, any;
  cv::compare(difference.reshape(1), allowed.reshape(1), channels_beyond, cv::CMP_GT);
  cv::Mat channels[3];
  cv::split(channels_beyond.reshape(3), channels);
  any = channels[0] | channels[1] | channels[2];
  cv::morphologyEx(any, any, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));
  return any;
}

struct Region {
  cv::Rect box_px;
  int area_px = 0;
};

// The 8-connected regions of at least so many pixels; `kept`, where given, gets their pixels.
std::vector<Region> RegionsOf(const cv::Mat& mask, int min_blob_px, cv::Mat* kept) {
  cv::Mat labels, stats, centres;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centres, 8, CV_32S);
  std::vector<Region> regions;
  for (int label = 1; label < count; ++label) {
    const int* of = stats.ptr<int>(label);
    if (of[cv::CC_STAT_AREA] < min_blob_px) continue;
    const cv::Rect box(of[cv::CC_STAT_LEFT], of[cv::CC_STAT_TOP], of[cv::CC_STAT_WIDTH],
                       of[cv::CC_STAT_HEIGHT]);
    regions.push_back({box, of[cv::CC_STAT_AREA]});
    if (kept != nullptr) (*kept)(box).setTo(255, labels(box) == label);
  }
  return regions;
}

// The least and the most mean of five gains that follow each other.
void FindSwing(const std::vector<GainAtTime>& gains, EmptySceneReport* report) {
  const std::size_t together = std::min<std::size_t>(5, gains.size());
  double all = 0.0;
  for (const GainAtTime& at : gains) all += at.gain / static_cast<double>(gains.size());
  for (std::size_t first = 0; first + together <= gains.size(); ++first) {
    double mean = 0.0;
    for (std::size_t i = first; i < first + together; ++i)
      mean += gains[i].gain / static_cast<double>(together);
    report->least_gain = std::min(report->least_gain, mean / all);
    report->most_gain = std::max(report->most_gain, mean / all);
  }
}

double MedianOf(const cv::Mat& values_bgr) {
  const cv::Mat flat = values_bgr.reshape(1, 1);
  std::vector<float> values(flat.begin<float>(), flat.end<float>());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

}  // namespace

bool EmptySceneReport::is_light_steady() const {
  return !(pulse && pulse->matters) && most_gain - least_gain <= 2.0 * kMostSwing;
}

EmptySceneReport ExamineEmptyScene(std::span<const TimedPicture> pictures,
                                   const BackgroundReference& reference, int min_blob_px) {
  core::Require(pictures.size() >= 2, "an empty scene is judged by two pictures or more");
  core::Require(reference.frames == static_cast<int>(pictures.size()),
                "a reference is measured from its pictures");
  const cv::Mat& mean = reference.mean_bgr;
  const cv::Scalar mean_level = cv::mean(mean);
  EmptySceneReport report;
  report.mean_level = (mean_level[0] + mean_level[1] + mean_level[2]) / 3.0;
  report.sigma_median_levels = MedianOf(reference.sigma_bgr);
  const ExposureEstimator estimator(reference);
  std::vector<cv::Scalar> gains;
  std::vector<GainAtTime> light;
  cv::Mat sum_squares = cv::Mat::zeros(mean.size(), CV_32FC3);
  for (const TimedPicture& picture : pictures) {
    gains.push_back(GainOf(estimator.Estimate(picture.image_bgr), mean_level));
    light.push_back({picture.time_s, (gains.back()[0] + gains.back()[1] + gains.back()[2]) / 3.0});
    const cv::Mat difference = Difference(picture.image_bgr, mean, gains.back());
    cv::accumulateSquare(difference, sum_squares);
  }
  FindSwing(light, &report);
  const cv::Mat allowed = Allowed(mean, NoiseByLevel(mean, sum_squares, pictures.size()));
  cv::Mat moved = cv::Mat::zeros(mean.size(), CV_8U);
  for (std::size_t i = 0; i < pictures.size(); ++i)
    (void)RegionsOf(Beyond(Difference(pictures[i].image_bgr, mean, gains[i]), allowed), min_blob_px, &moved);
  std::vector<Region> regions = RegionsOf(moved, min_blob_px, nullptr);
  std::ranges::stable_sort(regions, std::greater(), &Region::area_px);
  for (const Region& region : regions) report.moved_px.push_back(region.box_px);
  if (regions.empty()) report.pulse = FindPulse(light);
  return report;
}

std::vector<std::string> FaultsOf(const EmptySceneReport& report, const std::string& camera,
                                  const cv::Size& picture) {
  std::vector<std::string> faults;
  const auto add = [&](const std::string& what) {
    faults.push_back(fmt::format("camera '{}': {}", camera, what));
  };
  if (!report.moved_px.empty()) {
    const std::string place = PlaceInPicture(report.moved_px.front(), picture);
    const bool is_phrase = place.starts_with("in ") || place.starts_with("on ");
    add(fmt::format("something moved {}{} of the picture", is_phrase ? "" : "in the ", place));
    return faults;  // what moves may pass for a change of light
  }
  if (report.pulse && report.pulse->matters) {
    const std::string lamps =
        report.pulse->lamp_hz ? fmt::format(" as lamps on {:.0f} Hz mains do", *report.pulse->lamp_hz / 2.0)
                              : "";
    add(fmt::format("the light flickers by {:.0f} %{}", 100.0 * report.pulse->amplitude_share, lamps));
  } else if (!report.is_light_steady()) {
    add(fmt::format(
        "the light changed from {:.0f} % to {:.0f} % of its mean; switch automatic exposure and gain off",
        100.0 * report.least_gain, 100.0 * report.most_gain));
  }
  return faults;
}

}  // namespace elbowroom::recon
