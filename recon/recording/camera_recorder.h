// Records one live camera: capture puts its pictures into a queue, a thread writes them.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <opencv2/core/types.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/bounded_queue.h"
#include "recon/capture/captured_picture.h"
#include "recon/recording/camera_recording.h"

namespace elbowroom::recon {

struct CameraRecorderOptions {
  std::string name;
  std::filesystem::path folder;  // exists; gets video.avi, stamps.csv, losses.csv
  cv::Size size_px;
  double rate_hz = 30.0;               // of the video; its true times are those of the stamps
  std::size_t most_waiting = 64;       // pictures, > 0; more than that aren't written
  std::uint64_t least_free_bytes = 0;  // with less room on the disk the video ends
};

// Thread: Add and AddLoss from capture threads, the rest from one.
class CameraRecorder {
 public:
  explicit CameraRecorder(CameraRecorderOptions options);
  ~CameraRecorder();
  CameraRecorder(const CameraRecorder&) = delete;
  CameraRecorder& operator=(const CameraRecorder&) = delete;

  // Never waits. A picture that finds no room is counted as unwritten; one after Close isn't counted.
  void Add(const CapturedPicture& picture);
  void AddLoss(const core::PictureLoss& loss);

  // Whether no more is written, since the disk is full or the video failed.
  [[nodiscard]] bool has_ended() const { return has_ended_; }

  void Close();  // no more pictures come; those that wait are still written
  // Waits for the end of the video. Close was called before.
  [[nodiscard]] CameraRecording Finish();

 private:
  void Run();
  void WriteVideo(const std::filesystem::path& video);
  // Why the disk takes no more pictures, if it doesn't.
  [[nodiscard]] std::optional<std::string> WhatFillsTheDisk() const;
  void WriteTables();
  void GiveUp(const std::string& why);
  // With mutex_ held.
  void Miss(std::uint64_t first, std::uint64_t last, const std::string& reason);
  void MissUnwritten(std::uint64_t number, const std::string& reason = kNotWritten);

  CameraRecorderOptions options_;
  core::BoundedQueue<CapturedPicture> queue_;
  std::atomic<bool> has_ended_ = false;
  std::mutex mutex_;  // of what capture and the thread share
  bool is_open_ = true;
  std::optional<CaptureClock::time_point> last_stamp_;
  CameraRecording recording_;
  // The thread's own.
  std::string stamps_ = "frame,time_s,picture\n";
  std::vector<std::uint64_t> taken_;  // the numbers of the video's pictures
  std::thread thread_;
};

}  // namespace elbowroom::recon
