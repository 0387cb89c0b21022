#include "recon/footage/video_file.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "recon/footage/container_check.h"
#include "recon/footage/video_decoder.h"

namespace elbowroom::recon {
namespace {

using core::FrameIndex;

// The longest time to open a video and to answer each request for pictures. A file that takes longer was made
// to do so.
constexpr std::chrono::seconds kMostTime{8};
constexpr FrameIndex kAtOnce = 32;
constexpr const char* kWhatToDo = "it must be a video that FFmpeg reads; record or copy it again";

class VideoFile : public ImageSource {
 public:
  VideoFile(SourceSubject subject, const std::stop_token& stop)
      : subject_(std::move(subject)), decoder_({subject_.width_px, subject_.height_px}) {
    RequireFile();
    if (const auto damage = FindContainerDamage(subject_.location)) {
      if (damage->frame) {
        FailAsDamaged(*damage->frame, fmt::format("byte {} isn't where a picture begins", damage->at_byte));
      }
      FailAsCutShort(*damage, stop);
    }
    const OpenedVideo opened = Open(stop);
    if (opened.frame_rate_hz > 0.0 && opened.frame_rate_hz < 10'000.0) frame_rate_hz_ = opened.frame_rate_hz;
    if (IsPossible(opened.promised_frames)) {
      count_ = static_cast<FrameIndex>(opened.promised_frames);
    } else {
      while (PassOver(*next_, kAtOnce, stop)) {
      }
      (void)Open(stop);
    }
    first_ = Next(0, stop);
    if (!first_)
      subject_.Fail(fmt::format("no frame of '{}' can be decoded; {}", subject_.location, kWhatToDo));
  }

  [[nodiscard]] FrameIndex frame_count() const override { return count_; }
  [[nodiscard]] std::optional<double> frame_rate_hz() const override { return frame_rate_hz_; }

  [[nodiscard]] std::optional<SourcePicture> Read(FrameIndex index, const std::stop_token& stop) override {
    subject_.RequireNotNegative(index);
    if (has_met_end_ && index >= count_) return std::nullopt;
    if (index == 0 && first_) return SourcePicture{*std::exchange(first_, std::nullopt)};
    first_.reset();
    if (!next_ || index < *next_) (void)Open(stop);
    while (*next_ < index)
      if (!PassOver(*next_, index - *next_, stop)) return std::nullopt;
    if (auto image = Next(index, stop)) return SourcePicture{std::move(*image)};
    return std::nullopt;
  }

 private:
  void RequireFile() const {
    std::error_code ignored;
    const auto status = std::filesystem::status(subject_.location, ignored);
    if (!std::filesystem::exists(status))
      subject_.Fail(fmt::format("video '{}' does not exist; check the path", subject_.location));
    if (!std::filesystem::is_regular_file(status)) {
      subject_.Fail(fmt::format("video '{}' is not a file; name a file, a folder of pictures, or a camera",
                                subject_.location));
    }
  }

  // Opens the video at its first frame. If the container gives a wrong size, no frame is decoded.
  OpenedVideo Open(const std::stop_token& stop) {
    const auto opened = decoder_.OpenVideo(subject_.location, stop, kMostTime);
    if (!opened.value) {
      const std::string why = opened.complaint.empty() ? "" : fmt::format(" ({})", opened.complaint);
      subject_.Fail(fmt::format("'{}' can't be opened{}; {}", subject_.location, why, kWhatToDo));
    }
    if (const cv::Size size = opened.value->size_px; !size.empty())
      subject_.RequireSize(size.width, size.height, 0);
    if (!opened.complaint.empty()) FailAsDamaged(0, opened.complaint);
    next_ = 0;
    return *opened.value;
  }

  static bool IsPossible(double promised_frames) {
    constexpr double kMostPromised = 1e9;
    return promised_frames >= 1.0 && promised_frames < kMostPromised;
  }

  // Passes over up to `most` pictures from `at`, the decoder's next. False: the video ends at `at`.
  bool PassOver(FrameIndex at, FrameIndex most, const std::stop_token& stop) {
    next_.reset();  // unknown if what follows throws
    const auto skipped = decoder_.Skip(most, stop, kMostTime);
    const FrameIndex passed = skipped.value.value_or(0);
    if (!skipped.complaint.empty()) FailAsDamaged(at + passed, skipped.complaint);
    if (passed == 0) {
      MeetEnd(at, stop);
      return false;
    }
    next_ = at + passed;
    return true;
  }

  // Picture `at`, the decoder's next. Nothing: the video ends there.
  std::optional<cv::Mat> Next(FrameIndex at, const std::stop_token& stop) {
    next_.reset();
    auto picture = decoder_.Next(stop, kMostTime);
    if (!picture.complaint.empty()) FailAsDamaged(at, picture.complaint);
    if (!picture.value) {
      MeetEnd(at, stop);
      return std::nullopt;
    }
    subject_.RequireSize(picture.value->size_px.width, picture.value->size_px.height, at);
    next_ = at + 1;
    if (at >= count_) count_ = at + 1;  // more than promised
    return std::move(picture.value->image_bgr);
  }

  // Throws unless `at` can be the end.
  void MeetEnd(FrameIndex at, const std::stop_token& stop) {
    if (GoesOn(stop)) FailAsDamaged(at, "it can't be decoded, though later ones can");
    if (has_met_end_ && at < count_) {
      subject_.Fail(
          fmt::format("frame {} of '{}' can't be decoded, though {} frames could be before; check "
                      "the disk",
                      at, subject_.location, count_.load()));
    }
    count_ = at;
    has_met_end_ = true;
  }

  // Whether the video goes on after the end that OpenCV reported: it also stops at a packet that can't be
  // decoded at all.
  bool GoesOn(const std::stop_token& stop) {
    constexpr int kTries = 256;  // packets in a row; at the end of a file they cost nothing
    const auto skipped = decoder_.Skip(1, stop, kMostTime, kTries);
    return skipped.value || skipped.decoder_ended;
  }

  [[noreturn]] void FailAsDamaged(FrameIndex frame, const std::string& how) const {
    subject_.Fail(fmt::format("video '{}' is damaged at about frame {}: {}; record or copy it again",
                              subject_.location, frame, how));
  }

  [[noreturn]] void FailAsCutShort(const ContainerDamage& damage, const std::stop_token& stop) {
    std::string frames = "none of its frames can be read";
    if (const auto opened = decoder_.OpenVideo(subject_.location, stop, kMostTime); opened.value) {
      FrameIndex count = 0;
      for (auto more = decoder_.Skip(1, stop, kMostTime); more.value;
           more = decoder_.Skip(1, stop, kMostTime))
        count += *more.value;
      const double promised = opened.value->promised_frames;
      frames = promised > 0.0 ? fmt::format("it breaks off at frame {} of {} promised", count, promised)
                              : fmt::format("it breaks off at frame {}", count);
    }
    const std::string bytes = damage.promised_bytes > damage.at_byte
                                  ? fmt::format("{} of {} bytes", damage.at_byte, damage.promised_bytes)
                                  : fmt::format("nothing is written from byte {} on", damage.at_byte);
    subject_.Fail(fmt::format("video '{}' is cut short ({}): {}; record or copy it again", subject_.location,
                              bytes, frames));
  }

  SourceSubject subject_;
  VideoDecoder decoder_;
  std::optional<FrameIndex> next_;     // the decoder's next frame; nothing: the video must be opened again
  std::atomic<FrameIndex> count_ = 0;  // as promised, until the end has been met
  bool has_met_end_ = false;
  std::optional<cv::Mat> first_;  // picture 0, until a picture is read
  std::optional<double> frame_rate_hz_;
};

}  // namespace

std::unique_ptr<ImageSource> OpenVideoFile(SourceSubject subject, const std::stop_token& stop) {
  return std::make_unique<VideoFile>(std::move(subject), stop);
}

}  // namespace elbowroom::recon
