// The module behind recon/decoding/picture_codecs.h.
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "recon/decoding/picture_codecs.h"

namespace elbowroom::recon {
namespace {

class Capture : public VideoStream {
 public:
  explicit Capture(const cv::VideoCapture& capture) : capture_(capture) {}

  [[nodiscard]] bool Grab() override { return capture_.grab(); }
  void Retrieve(cv::Mat& image) override {
    if (!capture_.retrieve(image)) image.release();
  }
  [[nodiscard]] cv::Size size_px() const override {
    return {static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH)),
            static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT))};
  }
  [[nodiscard]] double frame_rate_hz() const override { return capture_.get(cv::CAP_PROP_FPS); }
  [[nodiscard]] double promised_frames() const override { return capture_.get(cv::CAP_PROP_FRAME_COUNT); }

 private:
  cv::VideoCapture capture_;
};

cv::Mat Decode(std::string_view bytes, DecodedAs as) {
  // OpenCV's header type takes a mutable pointer; the decoder only reads it.
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  const int flags =
      as == DecodedAs::kBgr ? cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION : cv::IMREAD_UNCHANGED;
  try {
    return cv::imdecode(raw, flags);  // a new picture: some failures leave one that is there as it was
  } catch (const cv::Exception&) {
    return {};
  }
}

std::vector<std::uint8_t> Encode(const cv::Mat& image, const std::string& extension) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, image, bytes);
  return bytes;
}

// Null if it can't be opened, or if OpenCV throws.
std::unique_ptr<VideoStream> Open(const auto&... arguments) {
  try {
    cv::VideoCapture capture;
    if (capture.open(arguments...)) return std::make_unique<Capture>(capture);
  } catch (const cv::Exception&) {
    return nullptr;
  }
  return nullptr;
}

}  // namespace
}  // namespace elbowroom::recon

const elbowroom::recon::PictureCodecs& ElbowroomPictureCodecs() {
  using namespace elbowroom::recon;
  static constexpr PictureCodecs kCodecs = {
      &Decode, &Encode, [](const std::string& location) { return Open(location, int{cv::CAP_FFMPEG}); }};
  return kCodecs;
}
