// The headset program (docs/head_pose.md), started.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "core/system/child_process.h"
#include "core/system/shared_memory.h"
#include "recon/headset/headset_protocol.h"

namespace elbowroom::recon {

// One eye's picture: 3 bytes a pixel, the upper row first.
struct EyePicture {
  int width_px = 0;
  int height_px = 0;
  std::span<const std::uint8_t> rgb;
  EyeTangents seen;
};

// Thread: the one that made it, with which the program dies; Show: any.
class HeadsetLink {
 public:
  // Throws: Error{kFile} if it can't be started.
  explicit HeadsetLink(const HeadsetOrder& order);
  ~HeadsetLink();  // the program has 25 ms to leave the runtime in order
  HeadsetLink(const HeadsetLink&) = delete;
  HeadsetLink& operator=(const HeadsetLink&) = delete;

  struct News {
    HeadsetNews its;
    std::string text;
  };
  // The next message; nothing: none came in that time. When the program is gone without a word it is that of
  // phase kLost.
  [[nodiscard]] std::optional<News> Receive(std::chrono::milliseconds patience);

  // Hands over a picture for the pose of that number, for both eyes. False: both slots are in use, or the
  // program is gone; a later picture will do. Throws: PreconditionError: a size beyond kMostEyeSidePx, or the
  // program was started without pictures.
  [[nodiscard]] bool Show(std::int64_t pose, const std::array<EyePicture, 2>& eyes);

 private:
  HeadsetLink(const HeadsetOrder& order, core::Pipe ends);

  std::unique_ptr<core::SharedMemory> memory_;  // null: no pictures
  core::Descriptor socket_;
  core::Child child_;
  std::mutex mutex_;  // of the slots
  std::array<bool, kHeadsetSlots> is_in_use_{};
};

}  // namespace elbowroom::recon
