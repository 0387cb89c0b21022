// One video, encoded in a camera program of its own (docs/capture.md).
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "recon/capture/camera_program.h"
#include "recon/capture/shared_slots.h"

namespace elbowroom::recon {

// Lossless (recon/capture/encoding/video_encoder.h). The program that encodes dies with the thread that made
// this. Thread: that one alone.
class VideoWriter {
 public:
  // Throws: Error{kFile} if the program can't be started.
  VideoWriter(const std::filesystem::path& file, cv::Size size_px, double rate_hz);
  // Without Finish the file is of no use.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  // Returns once the picture (CV_8UC3 of the video's size) is copied for the encoder; waits while that has no
  // room. Throws: Error{kFile} saying why the video can't be written, or that nothing was taken for
  // kLongestWait.
  void Write(const cv::Mat& image_bgr);

  // Returns once the file is whole and on the disk. Throws: as Write.
  void Finish();

  static constexpr std::chrono::seconds kLongestWait{60};

 private:
  // Waits for one message. True: it was the last one.
  bool TakeNews();
  [[noreturn]] void Fail(std::string_view why) const;

  std::filesystem::path file_;
  SharedSlots slots_;
  std::vector<bool> is_free_;
  CameraProgram program_;
};

}  // namespace elbowroom::recon
