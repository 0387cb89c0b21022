#include "app/control/head/tracker_packet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "core/error.h"
#include "core/units.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kOpenTrackBytes = 48, kFreeDBytes = 29;
constexpr unsigned kFreeDType = 0xD1, kFreeDSum = 0x40;
constexpr double kFreeDPerDegree = 32768.0, kFreeDPerMm = 64.0;
constexpr double kMmPerCm = 10.0;
constexpr double kFarthestMm = 1e6, kMostTurnDeg = 720.0;

double LittleEndianDouble(std::span<const std::byte> packet, std::size_t first) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 8; ++i) bits |= std::to_integer<std::uint64_t>(packet[first + i]) << (8 * i);
  return std::bit_cast<double>(bits);
}

// 24 bits in two's complement.
double BigEndian24(std::span<const std::byte> packet, std::size_t first) {
  std::int32_t value = 0;
  for (std::size_t i = 0; i < 3; ++i) value = (value << 8) | std::to_integer<std::int32_t>(packet[first + i]);
  constexpr std::int32_t kSign = 1 << 23;
  return static_cast<double>((value ^ kSign) - kSign);
}

void AppendBigEndian24(double value, std::vector<std::byte>* packet) {
  const double rounded = std::round(value);
  core::Require(std::abs(rounded) < 8388608.0, "the value fits in 24 bits");
  const auto bits = static_cast<std::uint32_t>(static_cast<std::int32_t>(rounded));
  for (const unsigned shift : {16U, 8U, 0U}) packet->push_back(static_cast<std::byte>(bits >> shift));
}

// So that type, data and checksum add up to 0x40 in 8 bits.
std::byte FreeDChecksum(std::span<const std::byte> data) {
  const unsigned sum = std::accumulate(data.begin(), data.end(), 0U, [](unsigned total, std::byte byte) {
    return total + std::to_integer<unsigned>(byte);
  });
  return static_cast<std::byte>(kFreeDSum - sum);
}

Eigen::Matrix3d Turn(double angle_deg, const Vector3d& axis) {
  return Eigen::AngleAxisd(core::RadiansFromDegrees(angle_deg), axis).toRotationMatrix();
}

// tracker_from_head of a head that looks straight on: its x is right, its y down, its z forward.
Eigen::Matrix3d LevelHead() {
  Eigen::Matrix3d level;
  level << 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0;
  return level;
}

}  // namespace

PacketResult ReadOpenTrack(std::span<const std::byte> packet) {
  if (packet.size() != kOpenTrackBytes) return PoseFault::kMalformed;
  std::array<double, 6> values{};
  for (std::size_t i = 0; i < 6; ++i) values[i] = LittleEndianDouble(packet, 8 * i);
  for (const double value : values)
    if (!std::isfinite(value)) return PoseFault::kNotFinite;
  for (std::size_t i = 0; i < 6; ++i)
    if (std::abs(values[i]) > (i < 3 ? kFarthestMm / kMmPerCm : kMostTurnDeg)) return PoseFault::kOutOfReach;
  return TrackerReading{kMmPerCm * Vector3d(values[0], -values[2], values[1]), values[3], values[4],
                        values[5]};
}

PacketResult ReadFreeD(std::span<const std::byte> packet, std::optional<int> camera) {
  if (packet.size() != kFreeDBytes || std::to_integer<unsigned>(packet[0]) != kFreeDType)
    return PoseFault::kMalformed;
  if (packet.back() != FreeDChecksum(packet.first(kFreeDBytes - 1))) return PoseFault::kMalformed;
  if (camera && std::to_integer<int>(packet[1]) != *camera) return PoseFault::kMalformed;
  const Vector3d position(BigEndian24(packet, 11), BigEndian24(packet, 14), BigEndian24(packet, 17));
  return TrackerReading{position / kFreeDPerMm, BigEndian24(packet, 2) / kFreeDPerDegree,
                        BigEndian24(packet, 5) / kFreeDPerDegree, BigEndian24(packet, 8) / kFreeDPerDegree};
}

std::vector<std::byte> OpenTrackPacket(const TrackerReading& reading) {
  const Vector3d& p = reading.position_mm;
  std::vector<std::byte> packet;
  for (const double value : {p.x() / kMmPerCm, p.z() / kMmPerCm, -p.y() / kMmPerCm, reading.yaw_deg,
                             reading.pitch_deg, reading.roll_deg}) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (unsigned i = 0; i < 8; ++i) packet.push_back(static_cast<std::byte>(bits >> (8 * i)));
  }
  return packet;
}

std::vector<std::byte> FreeDPacket(const TrackerReading& reading, int camera) {
  std::vector<std::byte> packet{static_cast<std::byte>(kFreeDType), static_cast<std::byte>(camera)};
  for (const double angle_deg : {reading.yaw_deg, reading.pitch_deg, reading.roll_deg})
    AppendBigEndian24(kFreeDPerDegree * angle_deg, &packet);
  for (const double mm : reading.position_mm) AppendBigEndian24(kFreeDPerMm * mm, &packet);
  packet.resize(kFreeDBytes - 1);  // zoom, focus and spare bits are 0
  packet.push_back(FreeDChecksum(packet));
  return packet;
}

core::RigidTransform TrackerFromHead(const TrackerReading& reading, const ReadingSigns& signs) {
  const Eigen::Matrix3d turn = Turn(-signs[3] * reading.yaw_deg, Vector3d::UnitZ()) *
                               Turn(signs[4] * reading.pitch_deg, Vector3d::UnitX()) *
                               Turn(signs[5] * reading.roll_deg, Vector3d::UnitY());
  return {turn * LevelHead(), reading.position_mm.cwiseProduct(Vector3d(signs[0], signs[1], signs[2]))};
}

TrackerReading ReadingOf(const core::RigidTransform& tracker_from_head) {
  // Rz(-yaw) Rx(pitch) Ry(roll): its y column is where the face looks, its z row's ends tell of the roll.
  const Eigen::Matrix3d turn = tracker_from_head.rotation * LevelHead().transpose();
  const double pitch_rad = std::asin(std::clamp(turn(2, 1), -1.0, 1.0));
  const double yaw_rad = std::atan2(turn(0, 1), turn(1, 1));
  const double roll_rad = std::atan2(-turn(2, 0), turn(2, 2));
  return {tracker_from_head.translation_mm, core::DegreesFromRadians(yaw_rad),
          core::DegreesFromRadians(pitch_rad), core::DegreesFromRadians(roll_rad)};
}

}  // namespace elbowroom::control
