#include "recon/footage/image_source.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "recon/footage/image_sequence.h"
#include "recon/footage/source_subject.h"
#include "recon/footage/video_decoder.h"
#include "recon/footage/video_file.h"
#include "recon/images/image_file.h"
#include "recon/rig_files/source_location.h"

namespace elbowroom::recon {
namespace {

using core::FrameIndex;

class ImageFiles : public ImageSource {
 public:
  explicit ImageFiles(SourceSubject subject)
      : subject_(std::move(subject)),
        files_(FindImageFiles(subject_.location, subject_.who)),
        reader_(subject_.who, cv::Size(subject_.width_px, subject_.height_px)) {}

  [[nodiscard]] FrameIndex frame_count() const override { return static_cast<FrameIndex>(files_.size()); }
  [[nodiscard]] std::optional<double> frame_rate_hz() const override { return std::nullopt; }

  [[nodiscard]] std::optional<SourcePicture> Read(FrameIndex index, const std::stop_token& stop) override {
    subject_.RequireNotNegative(index);
    if (index >= static_cast<FrameIndex>(files_.size())) return std::nullopt;
    const PictureHeader& header = reader_.Open(files_[static_cast<std::size_t>(index)]);
    subject_.RequireSize(header.width_px, header.height_px, index);
    return SourcePicture{reader_.Decode(DecodedAs::kBgr, stop)};
  }

 private:
  SourceSubject subject_;
  std::vector<std::filesystem::path> files_;
  ImageReader reader_;
};

std::unique_ptr<ImageSource> Open(SourceSubject subject, const std::stop_token& stop) {
  switch (KindOf(subject.location)) {
    case SourceKind::kDevice:
    case SourceKind::kGenicam:
    case SourceKind::kUrl:
      subject.Fail(
          fmt::format("'{}' is a live camera; here only recorded footage can be read", subject.location));
    case SourceKind::kVideo:
      return OpenVideoFile(std::move(subject), stop);
    case SourceKind::kSequence:
    case SourceKind::kGlob:
    case SourceKind::kFolder:
    case SourceKind::kImage:
      break;
  }
  return std::make_unique<ImageFiles>(std::move(subject));
}

// The size of a source's first picture; empty if its video doesn't say it. Nothing if there is none; opening
// the source says why.
std::optional<cv::Size> SizeOfFirst(const SourceSubject& subject, const std::stop_token& stop) {
  if (KindOf(subject.location) != SourceKind::kVideo) {
    ImageReader reader(subject.who);
    const PictureHeader& header = reader.Open(FindImageFiles(subject.location, subject.who).front());
    return cv::Size(static_cast<int>(header.width_px), static_cast<int>(header.height_px));
  }
  constexpr std::chrono::seconds kMostTime{8};
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(subject.location, ignored)) return std::nullopt;
  VideoDecoder decoder(cv::Size(1, 1));  // no picture is decoded here
  const auto opened = decoder.OpenVideo(subject.location, stop, kMostTime);
  return opened.value ? std::optional(opened.value->size_px) : std::nullopt;
}

}  // namespace

std::unique_ptr<ImageSource> OpenImageSource(const std::string& location, const core::CameraModel& camera,
                                             std::stop_token stop) {
  return Open({fmt::format("camera '{}'", camera.name()), location, camera.width_px(), camera.height_px()},
              stop);
}

UncalibratedSource OpenUncalibratedSource(const std::string& location, const std::string& camera_name,
                                          std::stop_token stop) {
  SourceSubject subject{fmt::format("camera '{}'", camera_name), location, 0, 0, "the first picture is",
                        "calibrate with pictures of one size"};
  if (IsLive(location))
    subject.Fail(
        fmt::format("'{}' is a live camera; record its pictures first, and name the recording", location));
  const std::optional<cv::Size> found = SizeOfFirst(subject, stop);
  const cv::Size size_px = found.value_or(cv::Size(1, 1));  // then opening it fails
  if (size_px.empty())
    subject.Fail(fmt::format("'{}' doesn't say how large its pictures are; record it again", location));
  subject.width_px = size_px.width;
  subject.height_px = size_px.height;
  return {Open(subject, stop), size_px};
}

}  // namespace elbowroom::recon
