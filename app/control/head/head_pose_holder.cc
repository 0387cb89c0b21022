#include "app/control/head/head_pose_holder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace elbowroom::control {
namespace {

double SecondsBetween(HeadClock::time_point from, HeadClock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

double TurnBetween(const core::RigidTransform& a, const core::RigidTransform& b) {
  const double cosine = 0.5 * ((a.rotation.transpose() * b.rotation).trace() - 1.0);
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace

std::string_view ToString(PoseFault fault) {
  switch (fault) {
    case PoseFault::kMalformed:
      return "malformed";
    case PoseFault::kNotFinite:
      return "not_finite";
    case PoseFault::kOutOfReach:
      return "out_of_reach";
    case PoseFault::kStale:
      return "stale";
    case PoseFault::kOutOfOrder:
      return "out_of_order";
    case PoseFault::kJump:
      return "jump";
    case PoseFault::kUnconfirmed:
      return "unconfirmed";
    case PoseFault::kNotSeen:
      return "not_seen";
  }
  return "";
}

std::int64_t HeadCounts::all_refused() const {
  return std::accumulate(refused.begin(), refused.end(), std::int64_t{0});
}

std::optional<PoseFault> HeadPoseHolder::Offer(const recon::HeadPose& pose, HeadClock::time_point now) {
  const std::lock_guard lock(mutex_);
  const auto fault = FaultOf(pose, now);
  if (fault) {
    ++counts_.refused[static_cast<std::size_t>(*fault)];
    return fault;
  }
  const bool is_repeated = pose_ && pose_->world_from_head == pose.world_from_head;
  if (!is_repeated) changed_at_ = pose.measured_at;
  pose_ = pose;
  candidate_.reset();
  agreeing_ = 0;
  ++serial_;
  ++counts_.accepted;
  return std::nullopt;
}

void HeadPoseHolder::CountFault(PoseFault fault) {
  const std::lock_guard lock(mutex_);
  ++counts_.refused[static_cast<std::size_t>(fault)];
}

std::optional<PoseFault> HeadPoseHolder::FaultOf(const recon::HeadPose& pose, HeadClock::time_point now) {
  const core::RigidTransform& head = pose.world_from_head;
  if (!head.translation_mm.allFinite() || !head.rotation.allFinite() || !core::IsRotation(head.rotation))
    return PoseFault::kNotFinite;
  if (!(head.translation_mm.norm() <= limits_.most_distance_mm)) return PoseFault::kOutOfReach;
  if (now - pose.measured_at > limits_.most_age || pose.measured_at - now > limits_.most_age)
    return PoseFault::kStale;
  if (pose_ && pose.measured_at <= pose_->measured_at) return PoseFault::kOutOfOrder;
  if (IsLostAt(now)) return Confirm(pose);
  candidate_.reset();
  agreeing_ = 0;
  return CanFollow(*pose_, pose) ? std::nullopt : std::optional(PoseFault::kJump);
}

// A frozen tracker that goes on repeating its pose isn't believed: its poses agree, but say nothing new.
std::optional<PoseFault> HeadPoseHolder::Confirm(const recon::HeadPose& pose) {
  if (pose_ && pose_->world_from_head == pose.world_from_head) return PoseFault::kUnconfirmed;
  if (candidate_ && pose.measured_at <= candidate_->measured_at) return PoseFault::kOutOfOrder;
  const bool agrees = candidate_ && pose.measured_at - candidate_->measured_at <= limits_.most_age &&
                      CanFollow(*candidate_, pose);
  agreeing_ = agrees ? agreeing_ + 1 : 1;
  candidate_ = pose;
  return agreeing_ >= limits_.confirmations ? std::nullopt : std::optional(PoseFault::kUnconfirmed);
}

bool HeadPoseHolder::IsLostAt(HeadClock::time_point now) const {
  return !pose_ || now - pose_->measured_at > limits_.most_age ||
         pose_->measured_at - changed_at_ > limits_.frozen_after;
}

bool HeadPoseHolder::CanFollow(const recon::HeadPose& from, const recon::HeadPose& to) const {
  const double time_s = SecondsBetween(from.measured_at, to.measured_at);
  const double moved_mm = (to.world_from_head.translation_mm - from.world_from_head.translation_mm).norm();
  return moved_mm <= limits_.slack_mm + limits_.most_speed_mm_s * time_s &&
         TurnBetween(from.world_from_head, to.world_from_head) <=
             limits_.slack_rad + limits_.most_turn_rad_s * time_s;
}

HeadState HeadPoseHolder::StateAt(HeadClock::time_point now) const {
  const std::lock_guard lock(mutex_);
  return {pose_, IsLostAt(now), serial_};
}

HeadCounts HeadPoseHolder::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace elbowroom::control
