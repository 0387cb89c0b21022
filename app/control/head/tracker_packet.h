// Packets of head trackers, as they come over the network.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "app/control/head/head_pose_holder.h"
#include "core/rigid_transform.h"

namespace elbowroom::control {

inline constexpr int kOpenTrackPort = 4242;
inline constexpr int kFreeDPort = 40000;

// Position and attitude in the frame `tracker`: x to the right of somebody who looks straight on, y forward,
// z up. Yaw is positive to the right, pitch upwards, roll towards the right shoulder.
struct TrackerReading {
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
  double yaw_deg = 0.0;
  double pitch_deg = 0.0;
  double roll_deg = 0.0;
};

// +1 or -1 for x, y, z, yaw, pitch, roll of a reading.
using ReadingSigns = std::array<double, 6>;
inline constexpr ReadingSigns kNoSignChanged = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0};

using PacketResult = std::variant<TrackerReading, PoseFault>;

// Of OpenTrack's output "UDP over network": 48 bytes, six little-endian doubles: x, y, z in cm (right, up,
// back), yaw, pitch, roll in degrees. Faults: kMalformed: another length; kNotFinite; kOutOfReach: more than
// 1 km or two full turns.
[[nodiscard]] PacketResult ReadOpenTrack(std::span<const std::byte> packet);

// Of FreeD's type D1: 29 bytes: D1, camera, pan, tilt, roll (24 bits, 1/32768 degree), x, y, height (24 bits,
// 1/64 mm), zoom, focus, 16 spare bits, checksum; most significant byte first. `camera`: all others are
// malformed; nothing: any. Faults: kMalformed: length, type, checksum, camera.
[[nodiscard]] PacketResult ReadFreeD(std::span<const std::byte> packet, std::optional<int> camera);

// The same in bytes, for tests and for programs that feed a console; FreeD rounds to its units. Throws:
// PreconditionError for FreeD: beyond 24 bits.
[[nodiscard]] std::vector<std::byte> OpenTrackPacket(const TrackerReading& reading);
[[nodiscard]] std::vector<std::byte> FreeDPacket(const TrackerReading& reading, int camera);

// tracker_from_head of a reading. The head at 0, 0, 0 looks along y; then it rolls about its line of sight,
// pitches about the axis through its ears, and yaws about z: Rz(-yaw) Rx(pitch) Ry(roll).
[[nodiscard]] core::RigidTransform TrackerFromHead(const TrackerReading& reading,
                                                   const ReadingSigns& signs = kNoSignChanged);
// Its inverse; pitch within 90 degrees.
[[nodiscard]] TrackerReading ReadingOf(const core::RigidTransform& tracker_from_head);

}  // namespace elbowroom::control
