// Where the participant's head is: the one value that every kind of tracker gives.
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "core/rigid_transform.h"

namespace elbowroom::recon {

enum class HeadSource { kFixed, kOpenTrack, kFreeD, kCap };

// "fixed", "opentrack", "freed", "cap".
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
  }
  return "";
}

// Frame `head`: the origin is the middle between the eyes; x to the head's right, y down, z where the face
// looks. These are a camera's axes, so that the view from between the eyes has cam_from_world =
// world_from_head.Inverse().
struct HeadPose {
  core::RigidTransform world_from_head;
  // When the head was there: the middle of the exposure, or the arrival of the packet.
  std::chrono::steady_clock::time_point measured_at;
  HeadSource source = HeadSource::kFixed;
  // Standard deviations, sqrt(trace) of the covariances; nothing where the tracker doesn't tell.
  std::optional<double> sigma_mm;
  std::optional<double> sigma_rad;
};

}  // namespace elbowroom::recon
