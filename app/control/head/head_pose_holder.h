// The latest head pose that can be believed; what can't be never moves the view.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string_view>
#include <variant>

#include "recon/head_pose/head_pose.h"

namespace elbowroom::control {

using HeadClock = std::chrono::steady_clock;

// Why a packet or a pose was refused.
enum class PoseFault {
  kMalformed,    // not such a packet: length, type, checksum
  kNotFinite,    // NaN or infinity in it, or not a rotation
  kOutOfReach,   // farther from the world's origin, or further turned, than any head is
  kStale,        // older than HeadLimits::most_age when it came, or from the future
  kOutOfOrder,   // measured before the last one, or at the same time
  kJump,         // no head moves that fast
  kUnconfirmed,  // the first ones after a loss, until they agree
  kNotSeen,      // the cap wasn't found in the pictures, or not for certain
};
inline constexpr std::size_t kPoseFaults = 8;
[[nodiscard]] std::string_view ToString(PoseFault fault);  // "malformed", "not_finite", ...

struct HeadLimits {
  std::chrono::milliseconds most_age{200};       // older poses are stale, and tracking is lost
  std::chrono::milliseconds frozen_after{2000};  // a tracker that repeats one pose for longer is lost, too
  double most_distance_mm = 5000.0;              // of the eyes from the world's origin
  double most_speed_mm_s = 5000.0;
  double most_turn_rad_s = 15.0;
  // What a pose may be off by whatever the time between two: noise, and packets that arrive in one heap.
  double slack_mm = 60.0;
  double slack_rad = 0.25;
  int confirmations = 3;  // poses in a row that must agree at the start and after a loss; at least 1
};

struct HeadCounts {
  std::int64_t accepted = 0;
  std::array<std::int64_t, kPoseFaults> refused{};  // by PoseFault

  [[nodiscard]] std::int64_t all_refused() const;
};

struct HeadState {
  std::optional<recon::HeadPose> pose;  // the last one that was accepted; stays when tracking is lost
  bool is_lost = true;                  // there is none, or it is stale
  std::int64_t serial = 0;              // grows by one with each accepted pose
};

// Latest wins. A pose is accepted if it is finite, a rotation, within reach, fresh, newer than the last, and
// such that a head can have moved there since; after a loss, if several in a row agree so among themselves.
// A repetition of the last pose, bit for bit, keeps it fresh for frozen_after: trackers repeat the last pose
// when they have lost the head. Thread: any.
class HeadPoseHolder {
 public:
  explicit HeadPoseHolder(HeadLimits limits = {}) : limits_(limits) {}

  // Nothing: the pose was accepted.
  std::optional<PoseFault> Offer(const recon::HeadPose& pose, HeadClock::time_point now = HeadClock::now());
  // What never became a pose.
  void CountFault(PoseFault fault);

  [[nodiscard]] HeadState StateAt(HeadClock::time_point now = HeadClock::now()) const;
  [[nodiscard]] HeadCounts counts() const;

 private:
  [[nodiscard]] std::optional<PoseFault> FaultOf(const recon::HeadPose& pose, HeadClock::time_point now);
  [[nodiscard]] std::optional<PoseFault> Confirm(const recon::HeadPose& pose);
  [[nodiscard]] bool IsLostAt(HeadClock::time_point now) const;
  [[nodiscard]] bool CanFollow(const recon::HeadPose& from, const recon::HeadPose& to) const;

  HeadLimits limits_;
  mutable std::mutex mutex_;
  std::optional<recon::HeadPose> pose_;
  HeadClock::time_point changed_at_;  // when pose_ last was another one
  std::optional<recon::HeadPose> candidate_;
  int agreeing_ = 0;  // candidates in a row
  std::int64_t serial_ = 0;
  HeadCounts counts_;
};

}  // namespace elbowroom::control
