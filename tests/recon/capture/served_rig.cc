#include "tests/recon/capture/served_rig.h"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <thread>
#include <utility>

#include "tests/recon/capture/own_network.h"

namespace elbowroom::recon::testing {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

ServedRig::ServedRig(std::vector<FrameSet> sets, double rate_hz) : sets_(std::move(sets)), rate_hz_(rate_hz) {
  cameras_.resize(sets_.front().cameras.size());
  for (std::size_t i = 0; i < cameras_.size(); ++i) Switch(i, true);
}

void ServedRig::Switch(std::size_t camera, bool is_on) {
  cameras_.at(camera).reset();
  if (!is_on) return;
  const std::string serial = fmt::format("GV{:02}", camera + 1);
  cameras_[camera] = std::make_unique<FakeGigeCamera>(
      LoopbackAddress(static_cast<int>(camera)), serial,
      [this, camera](std::int64_t, const FakeSettings&, cv::Mat& pixels) { return Fill(camera, pixels); });
}

CameraSources ServedRig::SourcesOf(std::size_t i) const {
  CameraSources sources;
  sources.frames = "gige:" + LoopbackAddress(static_cast<int>(i));
  sources.capture.rate_hz = rate_hz_;
  sources.capture.exposure_us = 1000.0;
  sources.capture.pixel_format = "RGB8";
  sources.capture.packet_bytes = 8000;  // a loopback network carries large packets
  return sources;
}

Clock::time_point ServedRig::TimeOf(std::int64_t count) const {
  const std::chrono::duration<double> since(static_cast<double>(count) / rate_hz_);
  return begin_ + std::chrono::duration_cast<Clock::duration>(since);
}

// Waits for the next instant at which all cameras take a picture.
Clock::time_point ServedRig::Fill(std::size_t camera, cv::Mat& pixels) const {
  const double periods = std::chrono::duration<double>(Clock::now() - begin_).count() * rate_hz_;
  const auto count = static_cast<std::int64_t>(std::ceil(periods));
  const Clock::time_point instant = TimeOf(count);
  std::this_thread::sleep_until(instant);
  const FrameSet& set = sets_[static_cast<std::size_t>(count) % sets_.size()];
  cv::cvtColor(set.cameras[camera].image_bgr, pixels, cv::COLOR_BGR2RGB);
  return instant;
}

}  // namespace elbowroom::recon::testing
