// The messages between this program and the headset program, which speaks OpenXR (docs/head_pose.md).
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/system/child_process.h"
#include "recon/headset/eye_tangents.h"

namespace elbowroom::recon {

// The headset program lies beside this one (core/system/module.h). It is given its socket and the memory that
// it shares with this program, in this order.
inline constexpr const char* kHeadsetProgram = "headset";
inline constexpr int kHeadsetSocket = core::kFirstGivenDescriptor;
inline constexpr int kHeadsetMemory = core::kFirstGivenDescriptor + 1;

// The shared memory holds so many pictures, each in a slot of its own. A slot belongs to the headset program
// from when it is told of a picture there until it gives the slot back.
inline constexpr std::int32_t kHeadsetSlots = 2;
inline constexpr std::int32_t kMostEyeSidePx = 2048;
inline constexpr std::size_t kEyeBytes = std::size_t{3} * kMostEyeSidePx * kMostEyeSidePx;
inline constexpr std::size_t kHeadsetSlotBytes = 2 * kEyeBytes;  // the left eye's, then the right eye's

// The headset program says at least this often that it is well, unless a call of the runtime doesn't return.
inline constexpr std::chrono::milliseconds kHeadsetSignOfLife{200};

// The runtime's frame in which poses are: x to the right, y up, z back.
enum class HeadsetSpace : std::int32_t {
  kStage,  // on the floor of the play area; where the runtime has none: kLocal
  kLocal,  // where the head was at the start or at the last recentring
};

// The first message to the headset program.
struct HeadsetOrder {
  std::int32_t shows_pictures = 0;  // 0: poses only, without graphics where the runtime allows it
  HeadsetSpace space = HeadsetSpace::kStage;
};

struct WirePose {
  std::array<double, 3> position_m{};
  std::array<double, 4> quaternion_xyzw{0.0, 0.0, 0.0, 1.0};
};

// Every message to it but the first: a picture in a slot, 3 bytes a pixel (red, green, blue), the upper row
// first; the right eye's begins kEyeBytes after the left eye's. It was drawn for the pose of that number.
struct PictureForHeadset {
  std::int32_t slot = 0;
  std::int64_t pose = 0;
  std::array<std::int32_t, 2> width_px{};
  std::array<std::int32_t, 2> height_px{};
  std::array<EyeTangents, 2> seen{};  // what is in the pictures
};

// How far a session is.
enum class HeadsetPhase : std::int32_t {
  kStarting,
  kIdle,       // the runtime isn't ready: the headset isn't worn, or sleeps
  kRunning,    // poses come; nothing is shown yet
  kVisible,    // the picture is shown
  kFocused,    // the picture is shown, and nothing lies over it
  kStopping,   // the runtime wants it to pause
  kRecentred,  // the runtime moved its frame: the registration doesn't hold any more
  kSilent,     // a call of the runtime doesn't return
  kLost,       // the runtime is gone
  kRefused,    // there is no loader, runtime or headset, or the runtime can't do what is needed
  kEnded,      // its user ended the program in the headset
};
[[nodiscard]] std::string_view ToString(HeadsetPhase phase);  // "starting", "idle", ...

enum class HeadsetNewsKind : std::int32_t {
  kAlive,
  kStarted,  // the text names runtime and headset; the eyes' sizes are known
  kPhase,    // the text says why, where there is a reason; after kLost, kRefused, kEnded the program ends
  kPose,
  kSlotBack,
};

struct HeadsetNews {
  HeadsetNewsKind kind = HeadsetNewsKind::kAlive;
  HeadsetPhase phase = HeadsetPhase::kStarting;
  std::int32_t slot = 0;
  std::array<std::int32_t, 2> recommended_px{};  // width and height of an eye's picture
  // kPose: number, time on the steady clock, and where head and eyes are at that time.
  std::int64_t pose = 0;
  std::int64_t at_ns = 0;
  std::int32_t is_tracked = 0;  // 0: the runtime guesses, or knows nothing
  WirePose space_from_view;
  std::array<WirePose, 2> space_from_eye{};
  std::array<EyeTangents, 2> eyes{};
};

}  // namespace elbowroom::recon
