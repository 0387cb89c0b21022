// A rig's frame sets from what RIG.yml names: videos, image sequences, ready masks.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "recon/footage/frame_set.h"
#include "recon/footage/image_source.h"
#include "recon/footage/stamped_frames.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::recon {

// Which source ends the footage, as far as is known: the files' promises count until their ends are met.
struct ShortestSource {
  core::CameraIndex camera = 0;  // the first of those equally short
  std::string location;
  core::FrameIndex frames = 0;
};

struct CameraRate {
  std::string camera;
  double frames_hz = 0.0;
};

// Throws: Error{kFormat} naming both cameras when their rates differ by more than containers round.
void RequireOneRate(const CameraRate& one, const CameraRate& other);

// Where all cameras have recorded footage with timestamps, the sets are those of SetsOfAllTimes, after
// each camera's time offset: their times are the medians of their pictures', from the first set's on, each
// picture has its stamp, and a camera without a picture near a set's time is missing in it. Otherwise frame i
// of a set is frame i of every camera's source. Times come from the videos' frame rate (25 Hz if none
// gives one). A camera with ready masks brings those and no picture. Thread: one reader; a capture thread a
// camera reads a few frames ahead.
class RecordedRig : public FrameSetSource {
 public:
  // Opens every source, in parallel. Throws: Error naming camera and file for a source that is missing,
  // unreadable or cut short, a camera with neither frames nor masks, frame rates that disagree;
  // Error{kCancelled} on a stop.
  explicit RecordedRig(RigFile rig_file, std::stop_token stop = {});
  ~RecordedRig() override;
  RecordedRig(const RecordedRig&) = delete;
  RecordedRig& operator=(const RecordedRig&) = delete;

  [[nodiscard]] const core::Rig& rig() const override { return rig_file_.rig; }
  [[nodiscard]] std::optional<core::FrameIndex> frame_count() const override;
  [[nodiscard]] const std::optional<ShortestSource>& shortest_source() const { return shortest_source_; }
  [[nodiscard]] double frame_rate_hz() const { return frame_rate_hz_; }

  [[nodiscard]] std::string WhatEndsIt() const override;
  [[nodiscard]] std::optional<FrameSet> TryRead(core::FrameIndex index, std::stop_token stop) override;
  [[nodiscard]] std::vector<BackgroundReference> ReadBackgrounds(const core::Progress& progress,
                                                                 std::stop_token stop) override;

  // Of each camera the picture with that number (CameraStamp::picture; without stamps, or without numbers
  // among them, frame i is picture i), whatever sets they are in. Nothing for a camera for which no number is
  // given, or whose table of stamps doesn't have it. Fast where numbers grow. Throws: Error{kFile} naming
  // camera, file and picture that the footage should have and doesn't, and as TryRead; Error{kCancelled}.
  [[nodiscard]] std::vector<std::optional<CameraFrame>> ReadPictures(
      std::span<const std::optional<std::uint64_t>> numbers, const std::stop_token& stop);

 private:
  struct Camera;

  static Camera OpenCamera(const CameraSources& sources, const core::CameraModel& camera,
                           const std::stop_token& stop);
  void FindShortest();
  void FindFrameRate();
  void FormSets();
  [[nodiscard]] std::optional<FrameSet> TryReadSet(core::FrameIndex index, const std::stop_token& stop);

  RigFile rig_file_;
  std::optional<ShortestSource> shortest_source_;
  double frame_rate_hz_ = 25.0;
  std::vector<Camera> cameras_;
  // By stamps; empty: frame i goes with frame i. Times from the first set's on.
  std::vector<StampedSet> sets_;
  std::vector<double> set_times_s_;
};

}  // namespace elbowroom::recon
