#include "recon/footage/live_camera.h"

#include <fmt/format.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <utility>

#include "recon/footage/video_decoder.h"
#include "recon/rig_files/source_location.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using core::FrameIndex;
using Clock = std::chrono::steady_clock;

// An address may accept the connection and then send nothing.
constexpr std::chrono::seconds kMostTimeToOpen{15};
// A camera whose pictures are all damaged for so long, and at least so many of them, is broken.
constexpr std::chrono::seconds kMostTimeBroken{3};
constexpr int kMostBroken = 8;
constexpr std::chrono::milliseconds kBetweenTries{10};

class LiveCamera : public ImageSource {
 public:
  LiveCamera(SourceSubject subject, const std::stop_token& stop)
      : subject_(std::move(subject)), decoder_({subject_.width_px, subject_.height_px}) {
    if (KindOf(subject_.location) == SourceKind::kUrl) {
      RequireOpen(decoder_.OpenVideo(subject_.location, stop, kMostTimeToOpen), ErrorKind::kFile,
                  "check the address and that the camera is on the network");
    } else {
      RequireOpen(decoder_.OpenDevice(DeviceNumber(), stop, kMostTimeToOpen), ErrorKind::kCamera,
                  "check that the camera is plugged in and not in use");
    }
  }

  [[nodiscard]] std::optional<FrameIndex> frame_count() const override { return std::nullopt; }
  [[nodiscard]] std::optional<double> frame_rate_hz() const override { return std::nullopt; }
  [[nodiscard]] FrameIndex left_out() const override { return left_out_; }

  [[nodiscard]] std::optional<SourcePicture> Read(FrameIndex index, const std::stop_token& stop) override {
    int broken = 0;
    for (const auto begin = Clock::now();; ++broken) {
      auto picture = decoder_.Next(stop, std::nullopt);
      if (picture.value && picture.complaint.empty()) {
        subject_.RequireSize(picture.value->size_px.width, picture.value->size_px.height, index);
        return SourcePicture{std::move(picture.value->image_bgr), Clock::now()};
      }
      if (picture.decoder_ended || picture.complaint.empty()) FailAsEnded(index, picture.complaint);
      ++left_out_;
      if (broken >= kMostBroken && Clock::now() - begin > kMostTimeBroken)
        FailAsEnded(index, picture.complaint);
      if (!picture.value) WaitABit(stop);
    }
  }

 private:
  [[nodiscard]] int DeviceNumber() const {
    const std::string number = subject_.location.substr(std::string_view("device:").size());
    int device = -1;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), device);
    if (error != std::errc() || end != number.data() + number.size() || device < 0) {
      subject_.Fail(fmt::format("'{}' names no device; say \"device:0\"", subject_.location),
                    ErrorKind::kFormat);
    }
    return device;
  }

  void RequireOpen(const Decoded<OpenedVideo>& opened, ErrorKind kind, const char* what_to_do) const {
    if (!opened.value) {
      const std::string why = opened.complaint.empty() ? "" : fmt::format(" ({})", opened.complaint);
      subject_.Fail(fmt::format("'{}' can't be opened{}; {}", subject_.location, why, what_to_do), kind);
    }
    if (const cv::Size size = opened.value->size_px; !size.empty())
      subject_.RequireSize(size.width, size.height, 0);
  }

  // A stream that fails at once is asked again a little later.
  void WaitABit(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    wakes_.wait_for(lock, stop, kBetweenTries, [] { return false; });
  }

  [[noreturn]] void FailAsEnded(FrameIndex index, const std::string& why) const {
    const std::string of = why.empty() ? "" : fmt::format(" ({})", why);
    const FrameIndex left_out = left_out_;
    const std::string before =
        left_out == 0 ? "" : fmt::format(", {} damaged pictures were left out", left_out);
    subject_.Fail(fmt::format("the live picture of '{}' ended at frame {}{}{}; check the camera",
                              subject_.location, index, of, before),
                  ErrorKind::kCamera);
  }

  SourceSubject subject_;
  VideoDecoder decoder_;
  std::atomic<FrameIndex> left_out_{0};
  std::mutex mutex_;
  std::condition_variable_any wakes_;
};

}  // namespace

std::unique_ptr<ImageSource> OpenLiveCamera(SourceSubject subject, const std::stop_token& stop) {
  return std::make_unique<LiveCamera>(std::move(subject), stop);
}

}  // namespace elbowroom::recon
