// Pictures into a video file without any loss. Only the camera program has one (docs/capture.md).
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

namespace elbowroom::recon {

// HuffYUV in RGB, in an AVI file of any size: every pixel reads back as it was (footage_recorder_test), and
// no codec that does so takes less of the processor (docs/performance.md). Each picture can be read alone.
// Thread: one.
class VideoEncoder {
 public:
  // `path` is made, or written over. Throws: Error{kFile} if it can't be opened, if a side of the pictures
  // isn't 16 to 4096 px, or if GStreamer lacks what it needs.
  VideoEncoder(const std::string& path, cv::Size size_px, double rate_hz);
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  // Copies the picture (CV_8UC3, BGR) and encodes it on another thread; waits while two are on their way.
  // Throws: Error{kFile} saying why the file can't be written; PreconditionError for another size.
  void Write(const cv::Mat& image_bgr);

  // Returns once the file is whole and on the disk. Without this it is of no use. Throws: as Write.
  void Finish();

 private:
  struct Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

}  // namespace elbowroom::recon
