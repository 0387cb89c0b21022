#include "recon/image_source.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "recon/container_check.h"
#include "recon/image_file.h"
#include "recon/image_sequence.h"
#include "recon/picture_codecs.h"
#include "recon/source_location.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;
using core::FrameIndex;

// Whom and what a source's messages are about.
struct Subject {
  std::string who;  // "camera 'cam01'"
  std::string location;
  int width_px = 0;
  int height_px = 0;

  [[noreturn]] void Fail(const std::string& what, ErrorKind kind = ErrorKind::kFile) const {
    throw Error(kind, fmt::format("{}: {}", who, what));
  }
  void RequireSize(const cv::Mat& image, FrameIndex index) const {
    if (image.cols == width_px && image.rows == height_px) return;
    Fail(fmt::format(
        "frame {} of '{}' is {} x {} px, but the rig says {} x {}; use footage of the calibrated size", index,
        location, image.cols, image.rows, width_px, height_px));
  }
  void RequireInRange(FrameIndex index, FrameIndex count) const {
    if (index >= 0 && index < count) return;
    Fail(fmt::format("frame {} is out of range: '{}' has {} frames (0 to {})", index, location, count,
                     count - 1),
         ErrorKind::kRange);
  }
};

class ImageFiles : public ImageSource {
 public:
  explicit ImageFiles(Subject subject)
      : subject_(std::move(subject)), files_(FindImageFiles(subject_.location, subject_.who)) {}

  [[nodiscard]] std::optional<FrameIndex> frame_count() const override {
    return static_cast<FrameIndex>(files_.size());
  }
  [[nodiscard]] std::optional<double> frame_rate_hz() const override { return std::nullopt; }

  [[nodiscard]] cv::Mat Read(FrameIndex index) override {
    subject_.RequireInRange(index, static_cast<FrameIndex>(files_.size()));
    cv::Mat image = ReadImageBgr(files_[static_cast<std::size_t>(index)], subject_.who);
    subject_.RequireSize(image, index);
    return image;
  }

 private:
  Subject subject_;
  std::vector<std::filesystem::path> files_;
};

std::unique_ptr<VideoStream> OpenStream(const Subject& subject, const std::string& what_to_do) {
  auto stream = LoadedPictureCodecs().open_video(subject.location);
  if (stream == nullptr) subject.Fail(fmt::format("'{}' can't be opened; {}", subject.location, what_to_do));
  return stream;
}

class VideoFile : public ImageSource {
 public:
  VideoFile(Subject subject, const std::stop_token& stop) : subject_(std::move(subject)) {
    std::error_code ignored;
    if (!std::filesystem::exists(subject_.location, ignored)) {
      subject_.Fail(fmt::format("video '{}' does not exist; check the path", subject_.location));
    }
    const auto damage = FindContainerDamage(subject_.location);
    if (!damage) {
      stream_ = OpenStream(subject_, kWhatToDo);
      CountFrames(stop);
      if (count_ == 0)
        subject_.Fail(fmt::format("no frame of '{}' can be decoded; {}", subject_.location, kWhatToDo));
      if (GoesOn()) FailAsDamaged(count_, "it can't be decoded, though later ones can");
      Rewind();
      return;
    }
    if (damage->frame)
      FailAsDamaged(*damage->frame, fmt::format("byte {} isn't where a picture begins", damage->at_byte));
    FailAsCutShort(*damage, stop);
  }

  [[nodiscard]] std::optional<FrameIndex> frame_count() const override { return count_; }
  [[nodiscard]] std::optional<double> frame_rate_hz() const override { return frame_rate_hz_; }

  [[nodiscard]] cv::Mat Read(FrameIndex index) override {
    subject_.RequireInRange(index, count_);
    if (index < next_) Rewind();
    for (; next_ < index; ++next_) {
      if (!stream_->Grab()) FailAt(next_);
    }
    const cv::Mat image = stream_->Grab() ? stream_->Retrieve() : cv::Mat();
    if (image.empty()) FailAt(index);
    ++next_;
    subject_.RequireSize(image, index);
    return image.clone();  // what OpenCV gave may be the decoder's own memory
  }

 private:
  static constexpr const char* kWhatToDo = "it must be a video that FFmpeg reads; record or copy it again";

  void CountFrames(const std::stop_token& stop) {
    const double rate_hz = stream_->frame_rate_hz();
    if (rate_hz > 0.0 && rate_hz < 10'000.0) frame_rate_hz_ = rate_hz;
    while (stream_->Grab()) {
      ++count_;
      core::ThrowIfStopped(stop, fmt::format("reading '{}'", subject_.location));
    }
  }

  // Whether what OpenCV gave as the end is none: it stops at every packet that can't be decoded at all.
  bool GoesOn() {
    constexpr int kTries = 256;  // packets in a row; at the end of a file they cost nothing
    for (int i = 0; i < kTries; ++i)
      if (stream_->Grab()) return true;
    return false;
  }

  [[noreturn]] void FailAsDamaged(FrameIndex frame, const std::string& how) {
    subject_.Fail(fmt::format("video '{}' is damaged at about frame {}: {}; record or copy it again",
                              subject_.location, frame, how));
  }

  [[noreturn]] void FailAsCutShort(const ContainerDamage& damage, const std::stop_token& stop) {
    std::string frames = "none of its frames can be read";
    stream_ = LoadedPictureCodecs().open_video(subject_.location);
    if (stream_ != nullptr) {
      const double promised = stream_->promised_frames();
      CountFrames(stop);
      frames = promised > 0.0 ? fmt::format("it breaks off at frame {} of {} promised", count_, promised)
                              : fmt::format("it breaks off at frame {}", count_);
    }
    const std::string bytes = damage.promised_bytes > damage.at_byte
                                  ? fmt::format("{} of {} bytes", damage.at_byte, damage.promised_bytes)
                                  : fmt::format("nothing is written from byte {} on", damage.at_byte);
    subject_.Fail(fmt::format("video '{}' is cut short ({}): {}; record or copy it again", subject_.location,
                              bytes, frames));
  }

  void Rewind() {
    stream_ = OpenStream(subject_, kWhatToDo);
    next_ = 0;
  }

  [[noreturn]] void FailAt(FrameIndex index) {
    subject_.Fail(
        fmt::format("frame {} of '{}' can't be decoded, though {} frames could be before; check the disk",
                    index, subject_.location, count_));
  }

  Subject subject_;
  std::unique_ptr<VideoStream> stream_;
  FrameIndex next_ = 0;
  FrameIndex count_ = 0;
  std::optional<double> frame_rate_hz_;
};

class LiveCamera : public ImageSource {
 public:
  explicit LiveCamera(Subject subject) : subject_(std::move(subject)) {
    if (KindOf(subject_.location) == SourceKind::kUrl) {
      stream_ = OpenStream(subject_, "check the address and that the camera is on the network");
      return;
    }
    const std::string number = subject_.location.substr(std::string_view("device:").size());
    int device = -1;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), device);
    if (error != std::errc() || end != number.data() + number.size() || device < 0) {
      subject_.Fail(fmt::format("'{}' names no device; say \"device:0\"", subject_.location),
                    ErrorKind::kFormat);
    }
    stream_ = LoadedPictureCodecs().open_device(device);
    if (stream_ == nullptr) {
      subject_.Fail(fmt::format("'{}' can't be opened; check that the camera is plugged in and not in use",
                                subject_.location),
                    ErrorKind::kCamera);
    }
  }

  [[nodiscard]] std::optional<FrameIndex> frame_count() const override { return std::nullopt; }
  [[nodiscard]] std::optional<double> frame_rate_hz() const override { return std::nullopt; }

  [[nodiscard]] cv::Mat Read(FrameIndex index) override {
    const cv::Mat image = stream_->Grab() ? stream_->Retrieve() : cv::Mat();
    if (image.empty()) {
      subject_.Fail(fmt::format("the live picture of '{}' ended at frame {}; check the camera",
                                subject_.location, index),
                    ErrorKind::kCamera);
    }
    subject_.RequireSize(image, index);
    return image.clone();
  }

 private:
  Subject subject_;
  std::unique_ptr<VideoStream> stream_;
};

}  // namespace

std::unique_ptr<ImageSource> OpenImageSource(const std::string& location, const core::CameraModel& camera,
                                             std::stop_token stop) {
  Subject subject{fmt::format("camera '{}'", camera.name()), location, camera.width_px(), camera.height_px()};
  switch (KindOf(location)) {
    case SourceKind::kDevice:
    case SourceKind::kUrl:
      return std::make_unique<LiveCamera>(std::move(subject));
    case SourceKind::kVideo:
      return std::make_unique<VideoFile>(std::move(subject), stop);
    case SourceKind::kSequence:
    case SourceKind::kFolder:
    case SourceKind::kImage:
      break;
  }
  return std::make_unique<ImageFiles>(std::move(subject));
}

}  // namespace elbowroom::recon
