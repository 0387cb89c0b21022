#include "recon/capture/frame_set_assembler.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using core::CameraIndex;
using Duration = CaptureClock::duration;
using Instant = CaptureClock::time_point;

// More pictures of one camera than ever wait while sets are taken in time.
constexpr std::size_t kMostWaiting = 64;
// A camera's next picture comes one period after its last one. So a picture at most this share of a period
// before the instant stays the nearest, even where stamps jitter by a fifth of a period.
constexpr double kSurelyNearest = 0.4;
constexpr int kSetsBetweenChoices = 30;
constexpr int kMostSetsWithoutLeader = 3;
// Another leader must pay: the skew gets smaller by this share, and was at least so large.
constexpr double kWorthwhile = 0.8;
constexpr std::chrono::microseconds kNoticeable{500};
// A phase follows clocks that drift apart, not the stamps' jitter.
constexpr int kMostPhases = 20;
// Periods of cameras of one rate differ by less.
constexpr double kSameRate = 0.9;

Duration Seconds(double s) { return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(s)); }

Duration Share(double share, Duration duration) {
  return std::chrono::duration_cast<Duration>(share * duration);
}

// In [-period / 2, period / 2).
Duration Wrapped(Duration phase, Duration period) {
  Duration wrapped = (phase + period / 2) % period;
  if (wrapped < Duration::zero()) wrapped += period;
  return wrapped - period / 2;
}

}  // namespace

FrameSetAssembler::FrameSetAssembler(std::size_t cameras, AssemblerOptions options, OnUnpaired on_unpaired)
    : cameras_(cameras), on_unpaired_(std::move(on_unpaired)) {
  core::Require(cameras > 0, "a set has a camera");
  core::Require(options.period_s > 0.0, "pictures have a period");
  core::Require(options.time_offset_s.empty() || options.time_offset_s.size() == cameras,
                "there is one time offset a camera");
  for (CameraIndex i = 0; i < cameras; ++i) {
    cameras_[i].period = Seconds(options.period_s);
    if (!options.time_offset_s.empty()) cameras_[i].offset = Seconds(options.time_offset_s[i]);
  }
}

Instant FrameSetAssembler::TimeOf(CameraIndex camera, const CapturedPicture& picture) const {
  return picture.taken_at + cameras_[camera].offset;
}

// Two pictures lie as many periods apart as their numbers say.
void FrameSetAssembler::FollowPeriod(Camera& camera, const CapturedPicture& picture) {
  constexpr double kNew = 0.02;
  if (camera.newest && picture.number > camera.newest->number && picture.taken_at > camera.newest->taken_at) {
    const auto periods = static_cast<Duration::rep>(picture.number - camera.newest->number);
    const Duration period = (picture.taken_at - camera.newest->taken_at) / periods;
    const bool is_near = period > camera.period / 2 && period < 2 * camera.period;
    camera.period = is_near ? camera.period + Share(kNew, period - camera.period) : period;
  }
  camera.newest =
      CapturedPicture{{}, picture.number, picture.taken_at, picture.arrived_at, picture.stamp_source};
}

void FrameSetAssembler::Add(CameraIndex index, CapturedPicture picture) {
  Camera& camera = cameras_.at(index);
  camera.is_gone = false;
  FollowPeriod(camera, picture);
  camera.waiting.push_back(std::move(picture));
  if (camera.waiting.size() > kMostWaiting) DropFirst(index);
}

void FrameSetAssembler::SetGone(CameraIndex camera, bool is_gone) { cameras_.at(camera).is_gone = is_gone; }

void FrameSetAssembler::DropFirst(CameraIndex camera) {
  on_unpaired_(camera, cameras_[camera].waiting.front());
  cameras_[camera].waiting.pop_front();
}

std::optional<Instant> FrameSetAssembler::EarliestAfter(Instant time) const {
  std::optional<Instant> earliest;
  for (CameraIndex i = 0; i < cameras_.size(); ++i) {
    for (const CapturedPicture& picture : cameras_[i].waiting) {
      const Instant at = TimeOf(i, picture);
      if (at > time && (!earliest || at < *earliest)) earliest = at;
    }
  }
  return earliest;
}

// The time of the leader's next picture. If that is missing, one period after the last instant; if nobody has
// a picture near that, whatever comes next.
std::optional<Instant> FrameSetAssembler::NextInstant() const {
  const Camera& leader = cameras_[leader_];
  const Duration half = leader.period / 2;
  const Instant least = last_instant_ ? *last_instant_ + half : Instant::min();
  std::optional<Instant> lead;
  for (const CapturedPicture& picture : leader.waiting) {
    if (TimeOf(leader_, picture) <= least) continue;
    lead = TimeOf(leader_, picture);
    break;
  }
  if (!last_instant_) return lead ? lead : EarliestAfter(least);
  const Instant expected = *last_instant_ + leader.period;
  if (lead && *lead <= expected + half) return lead;
  const std::optional<Instant> earliest = EarliestAfter(expected - half);
  if (!earliest || *earliest <= expected + half) return earliest ? std::optional(expected) : std::nullopt;
  return lead ? lead : earliest;
}

FrameSetAssembler::Choice FrameSetAssembler::ChoiceOf(CameraIndex index, Instant instant) const {
  const Camera& camera = cameras_[index];
  Choice choice;
  Duration nearest = camera.period / 2;
  for (std::size_t i = 0; i < camera.waiting.size(); ++i) {
    const Instant at = TimeOf(index, camera.waiting[i]);
    const Duration away = at > instant ? at - instant : instant - at;
    if (away <= nearest) {
      nearest = away;
      choice.picture = i;
    }
  }
  const bool has_later = !camera.waiting.empty() && TimeOf(index, camera.waiting.back()) >= instant;
  choice.is_final =
      has_later || camera.is_gone || (choice.picture && nearest <= Share(kSurelyNearest, camera.period));
  return choice;
}

std::vector<FrameSetAssembler::Choice> FrameSetAssembler::ChoicesAt(Instant instant) const {
  std::vector<Choice> choices;
  for (CameraIndex i = 0; i < cameras_.size(); ++i) choices.push_back(ChoiceOf(i, instant));
  return choices;
}

Instant FrameSetAssembler::DeadlineOf(const std::vector<Choice>& choices) const {
  Instant last = Instant::min();
  for (CameraIndex i = 0; i < cameras_.size(); ++i)
    if (choices[i].picture) last = std::max(last, cameras_[i].waiting[*choices[i].picture].arrived_at);
  return last + cameras_[leader_].period;
}

std::optional<Instant> FrameSetAssembler::Deadline() const {
  const std::optional<Instant> instant = NextInstant();
  if (!instant) return std::nullopt;
  return DeadlineOf(ChoicesAt(*instant));
}

std::optional<PictureSet> FrameSetAssembler::TryTake(Instant now) {
  const std::optional<Instant> instant = NextInstant();
  if (!instant) return std::nullopt;
  const std::vector<Choice> choices = ChoicesAt(*instant);
  const bool is_final = std::ranges::all_of(choices, &Choice::is_final);
  if (!is_final && now < DeadlineOf(choices)) return std::nullopt;
  return TakeSet(*instant, choices);
}

PictureSet FrameSetAssembler::TakeSet(Instant instant, const std::vector<Choice>& choices) {
  PictureSet set{{}, std::vector<std::optional<CapturedPicture>>(cameras_.size())};
  Instant earliest = Instant::max(), latest = Instant::min();
  for (CameraIndex i = 0; i < cameras_.size(); ++i) {
    std::deque<CapturedPicture>& waiting = cameras_[i].waiting;
    const std::size_t unused = choices[i].picture.value_or(0);
    for (std::size_t k = 0; k < unused; ++k) DropFirst(i);
    if (!choices[i].picture) {
      while (!waiting.empty() && TimeOf(i, waiting.front()) < instant) DropFirst(i);
      continue;
    }
    const Instant at = TimeOf(i, waiting.front());
    earliest = std::min(earliest, at);
    latest = std::max(latest, at);
    set.pictures[i] = std::move(waiting.front());
    waiting.pop_front();
  }
  set.taken_at = earliest + (latest - earliest) / 2;
  last_instant_ = instant;
  FollowPhases(instant, set);
  return set;
}

void FrameSetAssembler::FollowPhases(Instant instant, const PictureSet& set) {
  for (CameraIndex i = 0; i < cameras_.size(); ++i) {
    Camera& camera = cameras_[i];
    if (!set.pictures[i]) continue;
    const Duration phase = TimeOf(i, *set.pictures[i]) - instant;
    camera.phases = std::min(camera.phases + 1, kMostPhases);
    camera.phase += Wrapped(phase - camera.phase, cameras_[leader_].period) / camera.phases;
  }
  sets_without_leader_ = set.pictures[leader_] ? 0 : sets_without_leader_ + 1;
  if (sets_without_leader_ >= kMostSetsWithoutLeader) {
    ChooseLeader(true);
  } else if (--sets_until_choice_ <= 0) {
    ChooseLeader(false);
  }
}

// Between the earliest and the latest picture of a set that this camera leads.
Duration FrameSetAssembler::SkewLedBy(CameraIndex leader) const {
  Duration least{0}, most{0};
  for (const Camera& camera : cameras_) {
    if (camera.phases == 0 || camera.is_gone) continue;
    const Duration phase = Wrapped(camera.phase - cameras_[leader].phase, cameras_[leader].period);
    least = std::min(least, phase);
    most = std::max(most, phase);
  }
  return most - least;
}

void FrameSetAssembler::ChooseLeader(bool must_change) {
  sets_until_choice_ = kSetsBetweenChoices;
  Duration longest{0};
  for (const Camera& camera : cameras_)
    if (!camera.is_gone && camera.phases > 0) longest = std::max(longest, camera.period);
  std::optional<CameraIndex> best;
  for (CameraIndex i = 0; i < cameras_.size(); ++i) {
    const Camera& camera = cameras_[i];
    if (camera.is_gone || camera.phases == 0 || camera.period < Share(kSameRate, longest)) continue;
    if (must_change && i == leader_) continue;
    if (!best || SkewLedBy(i) < SkewLedBy(*best)) best = i;
  }
  if (!best || *best == leader_) return;
  const Duration now = SkewLedBy(leader_);
  const bool is_too_fast = cameras_[leader_].period < Share(kSameRate, longest);
  if (must_change || is_too_fast || (now > kNoticeable && SkewLedBy(*best) < Share(kWorthwhile, now)))
    Lead(*best);
}

// The last instant becomes one of the new leader's, at or after that of the last set, so that no camera lacks
// a picture that the last set has taken already.
void FrameSetAssembler::Lead(CameraIndex leader) {
  const Duration period = cameras_[leader].period;
  const Duration phase = Wrapped(cameras_[leader].phase, period);
  *last_instant_ += phase >= Duration::zero() ? phase : phase + period;
  for (Camera& camera : cameras_) camera.phase = Wrapped(camera.phase - phase, period);
  leader_ = leader;
  sets_without_leader_ = 0;
}

}  // namespace elbowroom::recon
