// A rig of live cameras as a source of frame sets.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "recon/capture/camera_link.h"
#include "recon/capture/captured_picture.h"
#include "recon/capture/frame_set_assembler.h"
#include "recon/footage/frame_set.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::recon {

struct DecidedSet {
  PictureSet set;
  CaptureClock::time_point decided_at;
  std::vector<core::PictureLoss> losses;  // that became known since the set before
};

// Who else wants to know. Called on the capture threads, or on the one that decides sets; must not block.
struct LiveTaps {
  std::function<void(core::CameraIndex, const CapturedPicture&)> on_picture;  // every whole picture
  std::function<void(const core::PictureLoss&)> on_loss;  // every one that a camera had; not the unpaired
  std::function<void(core::CameraIndex, const CameraState&)> on_state;
  std::function<void(const DecidedSet&)> on_set;  // every one, also those that nobody will read
};

// Frame sets by nearest stamp (FrameSetAssembler) as long as the program wants them. A frame of a camera that
// has no picture in a set is empty. The index that is asked for becomes that of the next set. A reader that
// is too slow finds the latest kMostReady, and those before them count as passed over; but before its first
// read nothing counts as lost. Each set brings the losses that became known since the one before. Thread: one
// reader.
class LiveRig : public FrameSetSource {
 public:
  static constexpr std::size_t kMostReady = 4;

  // Starts all cameras and waits until each has started. Throws: Error{kCamera} naming the camera that can't
  // be started; PreconditionError for a camera that isn't live; Error{kCancelled} on a stop.
  explicit LiveRig(RigFile rig_file, LiveTaps taps = {}, const std::stop_token& stop = {});
  ~LiveRig() override;
  LiveRig(const LiveRig&) = delete;
  LiveRig& operator=(const LiveRig&) = delete;

  [[nodiscard]] const core::Rig& rig() const override { return rig_file_.rig; }
  [[nodiscard]] std::optional<core::FrameIndex> frame_count() const override { return std::nullopt; }
  [[nodiscard]] std::string WhatEndsIt() const override { return {}; }
  [[nodiscard]] std::optional<FrameSet> TryRead(core::FrameIndex index, std::stop_token stop) override;
  [[nodiscard]] std::vector<std::string> Warnings() const override;
  [[nodiscard]] std::vector<std::string> CameraTroubles() const override;
  [[nodiscard]] std::vector<BackgroundReference> ReadBackgrounds(const core::Progress& progress,
                                                                 std::stop_token stop) override;

  // By camera. Thread: any.
  [[nodiscard]] std::vector<CameraState> states() const;

 private:
  void StartCamera(core::CameraIndex camera);
  void WaitUntilStarted(const std::stop_token& stop);
  void Decide(const std::stop_token& stop);
  // With mutex_ held.
  [[nodiscard]] std::vector<DecidedSet> TakeDecided();
  void Offer(const DecidedSet& set);
  [[nodiscard]] FrameSet FrameSetOf(DecidedSet decided, core::FrameIndex index);

  RigFile rig_file_;
  LiveTaps taps_;
  mutable std::mutex mutex_;
  std::condition_variable_any came_;   // a picture, or a state
  std::uint64_t arrivals_ = 0;         // of those
  std::condition_variable_any ready_;  // a set
  FrameSetAssembler assembler_;
  std::vector<CameraState> states_;
  std::vector<core::PictureLoss> losses_;  // since the last set that was decided
  std::vector<core::PictureLoss> unread_;  // of sets that were passed over, and those pictures
  std::vector<std::uint64_t> lost_;        // by camera, in all
  bool has_reader_ = false;                // until then nothing counts as lost
  std::deque<DecidedSet> sets_;
  std::optional<CaptureClock::time_point> first_at_;
  std::vector<std::unique_ptr<CameraLink>> links_;
  std::jthread decider_;
};

}  // namespace elbowroom::recon
