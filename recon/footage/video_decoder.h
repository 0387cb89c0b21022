// A video or camera that a child process decodes.
#pragma once

#include <chrono>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "core/ids.h"
#include "recon/decoding/picture_worker.h"

namespace elbowroom::recon {

struct OpenedVideo {
  cv::Size size_px;  // as the container says; 0 x 0: it doesn't
  double frame_rate_hz = 0.0;
  double promised_frames = 0.0;
};

struct VideoPicture {
  cv::Size size_px;
  cv::Mat image_bgr;  // 8-bit, in memory of its own; empty if it isn't of the decoder's size
};

// What came of a question to the decoder.
template <typename Value>
struct Decoded {
  std::optional<Value> value;  // nothing: can't be opened, can't be decoded, or there is no more
  std::string complaint;       // of the codecs, that tells of damage; or how the decoder ended
  bool decoder_ended = false;  // the video must be opened again
};

// Thread: one at a time.
class VideoDecoder {
 public:
  using MostTime = std::optional<std::chrono::seconds>;  // nothing: as long as it needs

  // For pictures of that size. `most_time` without an answer; then the decoder is ended.
  explicit VideoDecoder(const cv::Size& size_px);

  // All throw: Error{kCancelled} on a stop, heard at once; Error{kFile} when no decoder can be started.
  [[nodiscard]] Decoded<OpenedVideo> OpenVideo(const std::string& location, const std::stop_token& stop,
                                               const MostTime& most_time);
  [[nodiscard]] Decoded<OpenedVideo> OpenDevice(int number, const std::stop_token& stop,
                                                const MostTime& most_time);
  // Up to `most` pictures are passed over, each tried so often; fewer, but not none, doesn't mean that there
  // are no more.
  [[nodiscard]] Decoded<core::FrameIndex> Skip(core::FrameIndex most, const std::stop_token& stop,
                                               const MostTime& most_time, int tries = 1);
  [[nodiscard]] Decoded<VideoPicture> Next(const std::stop_token& stop, const MostTime& most_time);

 private:
  cv::Size size_px_;
  PictureWorker worker_;
};

}  // namespace elbowroom::recon
