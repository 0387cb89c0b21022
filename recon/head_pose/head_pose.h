// Where the participant's head is: the one value that every kind of tracker gives.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/rigid_transform.h"
#include "recon/headset/eye_tangents.h"

namespace elbowroom::recon {

enum class HeadSource { kFixed, kOpenTrack, kFreeD, kCap, kOpenXr };

// "fixed", "opentrack", "freed", "cap", "openxr".
[[nodiscard]] constexpr std::string_view ToString(HeadSource source) {
  switch (source) {
    case HeadSource::kFixed:
      return "fixed";
    case HeadSource::kOpenTrack:
      return "opentrack";
    case HeadSource::kFreeD:
      return "freed";
    case HeadSource::kCap:
      return "cap";
    case HeadSource::kOpenXr:
      return "openxr";
  }
  return "";
}

// What a headset says of its eyes at the time of a pose.
struct HeadsetEyes {
  std::int64_t pose = 0;  // the pose's number in the headset program
  struct Eye {
    core::RigidTransform head_from_eye;  // the eye's axes as the head's: x right, y down, z forward
    EyeTangents tangents;
  };
  std::array<Eye, 2> eyes;  // left, right
};

// Frame `head`: the origin is the middle between the eyes; x to the head's right, y down, z where the face
// looks. These are a camera's axes, so that the view from between the eyes has cam_from_world =
// world_from_head.Inverse().
struct HeadPose {
  core::RigidTransform world_from_head;
  // When the head was there: the middle of the exposure, or the arrival of the packet. A headset's pose is
  // predicted for when the next picture is shown: it may lie ahead by that.
  std::chrono::steady_clock::time_point measured_at;
  HeadSource source = HeadSource::kFixed;
  // Standard deviations, sqrt(trace) of the covariances; nothing where the tracker doesn't tell.
  std::optional<double> sigma_mm;
  std::optional<double> sigma_rad;
  std::optional<HeadsetEyes> eyes = std::nullopt;  // of a headset alone
};

}  // namespace elbowroom::recon
