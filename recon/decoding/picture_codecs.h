// OpenCV's readers and writers of pictures and videos, as a module that is loaded on first use. They need 240
// libraries, which take longer to load than most commands run. Only the decoder loads them, a program of its
// own (recon/decoding/picture_worker.h).
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace elbowroom::recon {

// An open video. Thread: one at a time.
class VideoStream {
 public:
  virtual ~VideoStream() = default;

  [[nodiscard]] virtual bool Grab() = 0;  // false: there is no next picture, or it can't be decoded
  // The grabbed picture, 8-bit BGR. It is written into the memory of `image` if that has its size and type;
  // otherwise `image` gets memory of its own. `image` becomes empty if there is no picture.
  virtual void Retrieve(cv::Mat& image) = 0;
  [[nodiscard]] virtual cv::Size size_px() const = 0;        // as the container says
  [[nodiscard]] virtual double frame_rate_hz() const = 0;    // likewise; 0: it doesn't
  [[nodiscard]] virtual double promised_frames() const = 0;  // likewise
};

enum class DecodedAs : std::int32_t { kStored, kBgr };

struct PictureCodecs {
  // The result is empty if these bytes are no picture.
  cv::Mat (*decode)(std::string_view bytes, DecodedAs as);
  // `extension` names the format: ".png".
  std::vector<std::uint8_t> (*encode)(const cv::Mat& image, const std::string& extension);
  // Opens a file through FFmpeg. Null if it can't be opened.
  std::unique_ptr<VideoStream> (*open_video)(const std::string& location);
};

// Loads them at the first call. Throws: Error{kFile} if that fails. Thread: any.
[[nodiscard]] const PictureCodecs& LoadedPictureCodecs();

}  // namespace elbowroom::recon

// The module's entry.
extern "C" const elbowroom::recon::PictureCodecs& ElbowroomPictureCodecs();
