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

// A set waits for this share of a period at most. What is left is for the thread to wake up: the set is then
// decided within one period.
constexpr double kLongestWait = 0.95;
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
// A camera that is faster than this share of the slowest one doesn't lead.
constexpr double kSlowestLead = 0.9;
// Cameras of one rate differ by less in their periods.
constexpr double kOneRate = 0.99;
// A camera whose pictures lie farther from the leader's, in periods, takes its next or its last one instead.
constexpr double kMostPhase = 0.6;

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
    cameras_[i].periods.fill(cameras_[i].period);
    if (!options.time_offset_s.empty()) cameras_[i].offset = Seconds(options.time_offset_s[i]);
  }
}

Instant FrameSetAssembler::TimeOf(CameraIndex camera, const CapturedPicture& picture) const {
  return picture.taken_at + cameras_[camera].offset;
}

// Two pictures lie as many periods apart as their numbers say. The median of several, since a camera may
// leave a picture out without counting it.
void FrameSetAssembler::FollowPeriod(Camera& camera, const CapturedPicture& picture) {
  if (camera.newest && picture.number > camera.newest->number && picture.taken_at > camera.newest->taken_at) {
    const auto periods = static_cast<Duration::rep>(picture.number - camera.newest->number);
    camera.periods.at(camera.next_period) = (picture.taken_at - camera.newest->taken_at) / periods;
    camera.next_period = (camera.next_period + 1) % camera.periods.size();
    std::array<Duration, kPeriods> sorted = camera.periods;
    std::nth_element(sorted.begin(), sorted.begin() + kPeriods / 2, sorted.end());
    camera.period = sorted[kPeriods / 2];
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

std::optional<Instant> FrameSetAssembler::NextOfLeader(Instant least) const {
  for (const CapturedPicture& picture : cameras_[leader_].waiting)
    if (TimeOf(leader_, picture) > least) return TimeOf(leader_, picture);
  return std::nullopt;
}

// The time of the leader's next picture. If one is missing before that, the time at which it was due; if
// nobody has a picture near that, whatever comes next.
std::optional<Instant> FrameSetAssembler::NextInstant() const {
  const Duration period = cameras_[leader_].period, half = period / 2;
  const Instant least = last_instant_ ? *last_instant_ + half : Instant::min();
  const std::optional<Instant> lead = NextOfLeader(least);
  if (!last_instant_) return lead ? lead : EarliestAfter(least);
  Instant due = *last_instant_ + period;
  if (lead) {
    const auto missing = (*lead - due + half) / period;
    if (missing < 1) return lead;
    due = *lead - missing * period;
  }
  const std::optional<Instant> earliest = EarliestAfter(due - half);
  if (!earliest) return std::nullopt;
  if (*earliest <= due + half) return due;
  return lead ? lead : earliest;
}

// Where a camera's picture of this instant is due. With cameras of one rate it keeps its place before or
// after the leader's, also if that is a little more than half a period away: stamps that jitter about the
// half would leave every other set incomplete.
Instant FrameSetAssembler::DueOf(CameraIndex index, Instant instant) const {
  const Camera& camera = cameras_[index];
  const Camera& leader = cameras_[leader_];
  const bool is_of_one_rate =
      camera.period > Share(kOneRate, leader.period) && leader.period > Share(kOneRate, camera.period);
  return is_of_one_rate && index != leader_ ? instant + camera.phase : instant;
}

FrameSetAssembler::Choice FrameSetAssembler::ChoiceOf(CameraIndex index, Instant instant) const {
  const Camera& camera = cameras_[index];
  const Instant due = DueOf(index, instant);
  Choice choice;
  Duration nearest = camera.period / 2;
  for (std::size_t i = 0; i < camera.waiting.size(); ++i) {
    const Duration away = std::chrono::abs(TimeOf(index, camera.waiting[i]) - due);
    if (away > nearest) continue;
    nearest = away;
    choice.picture = i;
  }
  const bool has_later = !camera.waiting.empty() && TimeOf(index, camera.waiting.back()) >= due;
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
  return last + Share(kLongestWait, cameras_[leader_].period);
}

std::optional<Instant> FrameSetAssembler::Deadline() const {
  const std::optional<Instant> instant = NextInstant();
  if (!instant) return std::nullopt;
  const std::vector<Choice> choices = ChoicesAt(*instant);
  if (std::ranges::none_of(choices, &Choice::has_picture)) return std::nullopt;
  return DeadlineOf(choices);
}

std::optional<PictureSet> FrameSetAssembler::TryTake(Instant now) {
  for (std::optional<Instant> instant; (instant = NextInstant());) {
    const std::vector<Choice> choices = ChoicesAt(*instant);
    const bool is_final = std::ranges::all_of(choices, &Choice::is_final);
    const bool has_any = std::ranges::any_of(choices, &Choice::has_picture);
    if (!is_final && (!has_any || now < DeadlineOf(choices))) return std::nullopt;
    if (has_any) return TakeSet(*instant, choices);
    last_instant_ = *instant;  // nobody took a picture then
  }
  return std::nullopt;
}

PictureSet FrameSetAssembler::TakeSet(Instant instant, const std::vector<Choice>& choices) {
  PictureSet set{leader_, {}, std::vector<std::optional<CapturedPicture>>(cameras_.size())};
  std::vector<Instant> times;
  for (CameraIndex i = 0; i < cameras_.size(); ++i) {
    std::deque<CapturedPicture>& waiting = cameras_[i].waiting;
    const std::size_t unused = choices[i].picture.value_or(0);
    for (std::size_t k = 0; k < unused; ++k) DropFirst(i);
    if (!choices[i].picture) {
      while (!waiting.empty() && TimeOf(i, waiting.front()) < DueOf(i, instant)) DropFirst(i);
      continue;
    }
    times.push_back(TimeOf(i, waiting.front()));
    set.pictures[i] = std::move(waiting.front());
    waiting.pop_front();
  }
  std::ranges::sort(times);
  const Instant middle = times[(times.size() - 1) / 2];
  set.taken_at = middle + (times[times.size() / 2] - middle) / 2;
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
    camera.phase += (phase - camera.phase) / camera.phases;
    const Duration most = Share(kMostPhase, cameras_[leader_].period);
    if (std::chrono::abs(camera.phase) > most) camera.phase = Wrapped(camera.phase, cameras_[leader_].period);
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
    if (camera.is_gone || camera.phases == 0 || camera.period < Share(kSlowestLead, longest)) continue;
    if (must_change && i == leader_) continue;
    if (!best || SkewLedBy(i) < SkewLedBy(*best)) best = i;
  }
  if (!best || *best == leader_) return;
  const Duration now = SkewLedBy(leader_);
  const bool is_too_fast = cameras_[leader_].period < Share(kSlowestLead, longest);
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
