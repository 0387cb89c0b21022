#include "recon/footage/image_source.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "recon/footage/image_sequence.h"
#include "recon/footage/live_camera.h"
#include "recon/footage/source_subject.h"
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

  [[nodiscard]] std::optional<FrameIndex> frame_count() const override {
    return static_cast<FrameIndex>(files_.size());
  }
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

}  // namespace

std::unique_ptr<ImageSource> OpenImageSource(const std::string& location, const core::CameraModel& camera,
                                             std::stop_token stop) {
  SourceSubject subject{fmt::format("camera '{}'", camera.name()), location, camera.width_px(),
                        camera.height_px()};
  switch (KindOf(location)) {
    case SourceKind::kDevice:
    case SourceKind::kUrl:
      return OpenLiveCamera(std::move(subject), stop);
    case SourceKind::kVideo:
      return OpenVideoFile(std::move(subject), stop);
    case SourceKind::kSequence:
    case SourceKind::kFolder:
    case SourceKind::kImage:
      break;
  }
  return std::make_unique<ImageFiles>(std::move(subject));
}

}  // namespace elbowroom::recon
