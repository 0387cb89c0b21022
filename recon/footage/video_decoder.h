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

// The decoder's answer to a request.
template <typename Value>
struct Decoded {
  std::optional<Value> value;  // nothing: can't be opened, can't be decoded, or there is no more
  std::string complaint;       // what the codecs printed about damage, or how the decoder ended
  bool decoder_ended = false;  // the video must be opened again
};

// Thread: one at a time.
class VideoDecoder {
 public:
  using MostTime = std::optional<std::chrono::seconds>;  // nothing: as long as it needs

  // For pictures of that size. In all calls below, a decoder that gives no answer within `most_time` is
  // ended.
  explicit VideoDecoder(const cv::Size& size_px);

  // All throw: Error{kCancelled} at once on a stop; Error{kFile} when no decoder can be started.
  [[nodiscard]] Decoded<OpenedVideo> OpenVideo(const std::string& location, const std::stop_token& stop,
                                               const MostTime& most_time);
  // Passes over up to `most` pictures, trying each up to `tries` times, and returns their number. If it is
  // less than `most`, there may still be more pictures. Nothing means that the next one can't be decoded, or
  // that there is none.
  [[nodiscard]] Decoded<core::FrameIndex> Skip(core::FrameIndex most, const std::stop_token& stop,
                                               const MostTime& most_time, int tries = 1);
  [[nodiscard]] Decoded<VideoPicture> Next(const std::stop_token& stop, const MostTime& most_time);

 private:
  cv::Size size_px_;
  PictureWorker worker_;
};

}  // namespace elbowroom::recon
