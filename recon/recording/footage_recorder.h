// Records all pictures of a rig's live cameras, as they came, with their stamps.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "recon/capture/live_rig.h"
#include "recon/recording/camera_recorder.h"
#include "recon/recording/camera_recording.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::recon {

struct FootageRecorderOptions {
  // For each camera's pictures that wait for the disk, bytes; but always for kLeastWaiting of them.
  std::uint64_t most_waiting_bytes = std::uint64_t{64} << 20U;
  // With less room on the disk the recording ends, and all files are made whole.
  std::uint64_t least_free_bytes = std::uint64_t{256} << 20U;
};

struct FootageRecording {
  std::vector<CameraRecording> cameras;
  double seconds = 0.0;
  std::uint64_t bytes = 0;         // of all videos and tables
  std::filesystem::path rig_file;  // that plays it; empty: a camera has no whole video

  [[nodiscard]] std::vector<std::string> Troubles() const;  // of all cameras, a line each
};

// Every whole picture that comes between Begin and End is in the camera's video, bit for bit, or its number
// is among those that are missing, with the reason (footage_recorder_test). Capture never waits for it. A
// stamp is the middle of the exposure on the computer's CLOCK_MONOTONIC; the rig's time offsets aren't in it.
// Thread: one.
class FootageRecorder {
 public:
  static constexpr std::size_t kLeastWaiting = 8;

  explicit FootageRecorder(RigFile rig_file, FootageRecorderOptions options = {});
  ~FootageRecorder();
  FootageRecorder(const FootageRecorder&) = delete;
  FootageRecorder& operator=(const FootageRecorder&) = delete;

  // For the LiveRig of the same rig file; they are without effect once this is gone.
  [[nodiscard]] LiveTaps Taps();

  // Throws: Error{kFile} if there is something in the folder, or it can't be made; PreconditionError the
  // second time.
  void Begin(const std::filesystem::path& folder);

  // Whether the recording of a camera has ended by itself: the disk is full, or its video can't be written.
  [[nodiscard]] bool has_ended() const;

  // What comes from now on isn't recorded; waits until all videos are whole, and writes RIG.yml. Throws:
  // Error{kFile} if RIG.yml can't be written; PreconditionError without Begin.
  [[nodiscard]] FootageRecording End();

 private:
  struct Shared;  // with the capture threads
  void CopyBackground(core::CameraIndex camera);
  [[nodiscard]] double RateOf(core::CameraIndex camera) const;
  void WriteRig(FootageRecording* recording) const;

  RigFile rig_file_;
  FootageRecorderOptions options_;
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> camera_folders_;
  std::chrono::steady_clock::time_point begin_;
  std::shared_ptr<Shared> shared_;
};

// Throws: Error{kFile} if `folder` is no folder, or there is something in it.
void RequireEmptyFolder(const std::filesystem::path& folder);

}  // namespace elbowroom::recon
