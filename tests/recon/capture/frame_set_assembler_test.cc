// Frame sets by nearest stamp, held to a slow search over all pictures that ever came.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "recon/capture/frame_set_assembler.h"

namespace elbowroom::recon {
namespace {

using core::CameraIndex;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;
using Instant = CaptureClock::time_point;
using Duration = CaptureClock::duration;

constexpr double kPeriodS = 1.0 / 30.0;
// A camera keeps its place up to 0.6 of a period from the leader's; its other neighbour is 0.4 away then.
const Duration kKeepsPlace = std::chrono::milliseconds(7);
const Instant kBegin(std::chrono::hours(1));

Duration Seconds(double s) { return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(s)); }

// How a camera of a simulation behaves.
struct Behaviour {
  double phase_s = 0.0;
  double period_s = kPeriodS;
  double jitter_s = 0.0;  // 1 sigma, of stamps; no more than three of them
  double delay_s = 0.002;
  double delay_jitter_s = 0.0;  // uniform, added to the delay
  double loss = 0.0;            // share of pictures
  double gone_from_s = 1e9, gone_to_s = 1e9;
};

struct Event {
  Instant at;
  CameraIndex camera = 0;
  CapturedPicture picture;
};

// In the order of arrival; those of one camera arrive in their own order.
std::vector<Event> Simulate(const std::vector<Behaviour>& cameras, double duration_s, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Event> events;
  for (CameraIndex i = 0; i < cameras.size(); ++i) {
    const Behaviour& camera = cameras[i];
    Instant last_arrival = kBegin;
    const auto count =
        static_cast<std::uint64_t>(std::llround((duration_s - camera.phase_s) / camera.period_s));
    for (std::uint64_t number = 0; number < count; ++number) {
      const double s = camera.phase_s + static_cast<double>(number) * camera.period_s;
      const double jitter = std::clamp(std::normal_distribution<>(0.0, 1.0)(random), -3.0, 3.0);
      const bool is_lost = std::bernoulli_distribution(camera.loss)(random) ||
                           (s >= camera.gone_from_s && s < camera.gone_to_s);
      const double delay_s =
          camera.delay_s + std::uniform_real_distribution<>(0.0, 1.0)(random) * camera.delay_jitter_s;
      if (is_lost) continue;
      const Instant taken_at = kBegin + Seconds(s + jitter * camera.jitter_s);
      last_arrival = std::max(last_arrival, taken_at + Seconds(delay_s));
      events.push_back({last_arrival, i, {{}, number, taken_at, last_arrival, StampSource::kDevice}});
    }
  }
  std::ranges::stable_sort(events, {}, &Event::at);
  return events;
}

struct Decided {
  PictureSet set;
  Instant decided_at;
};

// What the assembler made of the events, and what it left out.
struct Outcome {
  std::vector<Decided> sets;
  std::vector<std::pair<CameraIndex, std::uint64_t>> unpaired;
};

// Every wait ends at the assembler's deadline, as in LiveRig.
Outcome Assemble(const std::vector<Event>& events, std::size_t cameras, AssemblerOptions options = {}) {
  Outcome outcome;
  FrameSetAssembler assembler(cameras, std::move(options),
                              [&](CameraIndex camera, const CapturedPicture& picture) {
                                outcome.unpaired.emplace_back(camera, picture.number);
                              });
  const auto take = [&](Instant now) {
    while (auto set = assembler.TryTake(now)) outcome.sets.push_back({std::move(*set), now});
  };
  for (const Event& event : events) {
    for (auto deadline = assembler.Deadline(); deadline && *deadline <= event.at;
         deadline = assembler.Deadline()) {
      take(*deadline);
    }
    assembler.Add(event.camera, event.picture);
    take(event.at);
  }
  for (auto deadline = assembler.Deadline(); deadline; deadline = assembler.Deadline()) take(*deadline);
  return outcome;
}

std::size_t Complete(const Outcome& outcome) {
  return static_cast<std::size_t>(std::ranges::count_if(outcome.sets, [](const Decided& decided) {
    return std::ranges::all_of(decided.set.pictures, [](const auto& picture) { return picture.has_value(); });
  }));
}

// Every picture is in one set, or left out, once; but for the last ones, for which a set may still come.
void ExpectEveryPictureOnce(const std::vector<Event>& events, const Outcome& outcome) {
  std::map<std::pair<CameraIndex, std::uint64_t>, int> times;
  for (const Decided& decided : outcome.sets)
    for (CameraIndex i = 0; i < decided.set.pictures.size(); ++i)
      if (const auto& picture = decided.set.pictures[i]) ++times[{i, picture->number}];
  for (const auto& unpaired : outcome.unpaired) ++times[unpaired];
  EXPECT_LE(times.size(), events.size());
  for (const Event& event : events) {
    const bool is_last = event.at > events.back().at - Seconds(2.0 * kPeriodS);
    EXPECT_THAT((times[{event.camera, event.picture.number}]), AllOf(Ge(is_last ? 0 : 1), Le(1)));
  }
}

// No set waits longer than one period after the last of its pictures came, or of those of earlier sets.
void ExpectDecidedInTime(const Outcome& outcome) {
  Instant last = kBegin;
  for (const Decided& decided : outcome.sets) {
    for (const auto& picture : decided.set.pictures)
      if (picture) last = std::max(last, picture->arrived_at);
    EXPECT_LE(decided.decided_at - last, Seconds(kPeriodS));
  }
}

// The oracle: of all pictures that came, none that is in no set lies nearer to the leader's than the one
// chosen, but for the tenth of a period in which a camera keeps its place; and a camera has none in a set
// only where none lies within half a period, less that tenth.
void ExpectNearest(const std::vector<Event>& events, const Outcome& outcome) {
  const std::set<std::pair<CameraIndex, std::uint64_t>> unpaired(outcome.unpaired.begin(),
                                                                 outcome.unpaired.end());
  for (const Decided& decided : outcome.sets) {
    const auto& leaders = decided.set.pictures[decided.set.leader];
    if (!leaders) continue;
    for (const Event& event : events) {
      if (!unpaired.contains({event.camera, event.picture.number})) continue;
      const Duration away = std::chrono::abs(event.picture.taken_at - leaders->taken_at);
      const auto& chosen = decided.set.pictures[event.camera];
      const Duration reach =
          chosen ? std::chrono::abs(chosen->taken_at - leaders->taken_at) : Seconds(0.5 * kPeriodS);
      EXPECT_GE(away, reach - kKeepsPlace)
          << "camera " << event.camera << " picture " << event.picture.number;
    }
  }
}

void ExpectInOrder(const Outcome& outcome) {
  std::vector<std::uint64_t> next;
  for (const Decided& decided : outcome.sets) {
    next.resize(decided.set.pictures.size(), 0);
    for (CameraIndex i = 0; i < next.size(); ++i) {
      if (!decided.set.pictures[i]) continue;
      EXPECT_GE(decided.set.pictures[i]->number, next[i]);
      next[i] = decided.set.pictures[i]->number + 1;
    }
  }
}

void ExpectSound(const std::vector<Event>& events, const Outcome& outcome) {
  ExpectEveryPictureOnce(events, outcome);
  ExpectDecidedInTime(outcome);
  ExpectNearest(events, outcome);
  ExpectInOrder(outcome);
}

TEST(FrameSetAssembler, PicturesOfOneInstantAreASetAsSoonAsTheLastHasCome) {
  const std::vector<Event> events = Simulate({{}, {.delay_s = 0.005}, {.delay_s = 0.001}}, 2.0, 1);
  const Outcome outcome = Assemble(events, 3);
  ExpectSound(events, outcome);
  EXPECT_EQ(outcome.sets.size(), 60U);
  EXPECT_EQ(Complete(outcome), outcome.sets.size());
  for (const Decided& decided : outcome.sets) {
    const Duration latency = decided.decided_at - decided.set.taken_at;
    EXPECT_LT(std::chrono::abs(latency - milliseconds(5)), microseconds(1));
  }
}

TEST(FrameSetAssembler, ALostPictureIsMissingInOneSet) {
  std::vector<Event> events = Simulate({{}, {}, {}, {}}, 1.0, 2);
  std::erase_if(events, [](const Event& event) { return event.camera == 2 && event.picture.number == 10; });
  std::erase_if(events, [](const Event& event) { return event.camera == 0 && event.picture.number == 20; });
  const Outcome outcome = Assemble(events, 4);
  ExpectSound(events, outcome);
  ASSERT_EQ(outcome.sets.size(), 30U);
  EXPECT_EQ(Complete(outcome), 28U);
  EXPECT_FALSE(outcome.sets[10].set.pictures[2].has_value());
  EXPECT_FALSE(outcome.sets[20].set.pictures[0].has_value());  // the leader's
}

TEST(FrameSetAssembler, TheOneInTheMiddleLeads) {
  // The leader at first, 0, is the earliest of all.
  const std::vector<Event> events =
      Simulate({{}, {.phase_s = 0.007}, {.phase_s = 0.012}, {.phase_s = 0.015}}, 20.0, 3);
  const Outcome outcome = Assemble(events, 4);
  ExpectSound(events, outcome);
  const std::vector<Event> wide = Simulate({{}, {.phase_s = 0.015}, {.phase_s = 0.018}}, 20.0, 3);
  const Outcome led = Assemble(wide, 3);
  ExpectSound(wide, led);
  // 0 with its neighbours at 15 and at 18 - 33 = -15 ms spreads over 30 ms, any other over 18 ms.
  EXPECT_NE(led.sets.back().set.leader, 0U);
  EXPECT_GE(Complete(led), led.sets.size() - 2);
}

// As of a camera that was busy: its next number comes two periods later.
TEST(FrameSetAssembler, APictureThatACameraLeavesOutUncountedIsMissing) {
  for (const CameraIndex camera : {0U, 1U}) {
    std::vector<Event> events = Simulate({{}, {}, {}}, 2.0, 8);
    std::erase_if(events, [&](const Event& e) { return e.camera == camera && e.picture.number == 30; });
    for (Event& event : events)
      if (event.camera == camera && event.picture.number > 30) --event.picture.number;
    const Outcome outcome = Assemble(events, 3);
    ExpectSound(events, outcome);
    ASSERT_EQ(outcome.sets.size(), 60U);
    EXPECT_EQ(Complete(outcome), 59U);
    EXPECT_FALSE(outcome.sets[30].set.pictures[camera].has_value());
  }
}

TEST(FrameSetAssembler, ACameraThatIsGoneDelaysNobody) {
  const std::vector<Event> events = Simulate({{}, {}, {.gone_from_s = 1.0, .gone_to_s = 2.0}}, 3.0, 4);
  const Outcome outcome = Assemble(events, 3);
  ExpectSound(events, outcome);
  EXPECT_EQ(outcome.sets.size(), 90U);
  EXPECT_EQ(Complete(outcome), 60U);
}

TEST(FrameSetAssembler, SetsGoOnWithoutTheirLeader) {
  const std::vector<Event> events = Simulate({{.gone_from_s = 1.0, .gone_to_s = 2.0}, {}, {}}, 3.0, 5);
  const Outcome outcome = Assemble(events, 3);
  ExpectSound(events, outcome);
  EXPECT_EQ(outcome.sets.size(), 90U);
  EXPECT_EQ(Complete(outcome), 60U);
}

TEST(FrameSetAssembler, OffsetsAreAddedToStamps) {
  // Camera 1 shows the scene 20 ms before its stamps say.
  const std::vector<Event> events = Simulate({{}, {.phase_s = 0.020}}, 1.0, 6);
  const Outcome outcome = Assemble(events, 2, {.time_offset_s = {0.0, -0.020}});
  ExpectEveryPictureOnce(events, outcome);
  for (const Decided& decided : outcome.sets) {
    if (!decided.set.pictures[0] || !decided.set.pictures[1]) continue;
    EXPECT_EQ(decided.set.pictures[0]->number, decided.set.pictures[1]->number);
  }
  EXPECT_GE(Complete(outcome), 29U);
}

TEST(FrameSetAssembler, ASlowCameraLeads) {
  const std::vector<Event> events = Simulate({{}, {.period_s = 2.0 * kPeriodS}}, 10.0, 7);
  const Outcome outcome = Assemble(events, 2);
  ExpectEveryPictureOnce(events, outcome);
  EXPECT_EQ(outcome.sets.back().set.leader, 1U);
  EXPECT_GE(Complete(outcome), 148U);
}

// Any number of cameras, any phase, clocks that drift, pictures that are lost, networks that delay.
TEST(FrameSetAssembler, IsSoundForRandomCameras) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto uniform = [&](double from, double to) {
      return std::uniform_real_distribution<>(from, to)(random);
    };
    std::vector<Behaviour> cameras(static_cast<std::size_t>(std::uniform_int_distribution<>(1, 8)(random)));
    for (Behaviour& camera : cameras) {
      camera.phase_s = uniform(0.0, kPeriodS);
      camera.period_s = kPeriodS * (1.0 + uniform(-2e-4, 2e-4));
      camera.jitter_s = uniform(0.0, 0.02 * kPeriodS);
      camera.delay_s = uniform(0.0, 0.01);
      camera.delay_jitter_s = uniform(0.0, 0.01);
      camera.loss = uniform(0.0, 0.05);
      if (std::bernoulli_distribution(0.2)(random)) {
        camera.gone_from_s = uniform(0.0, 8.0);
        camera.gone_to_s = camera.gone_from_s + uniform(0.0, 3.0);
      }
    }
    const std::vector<Event> events = Simulate(cameras, 12.0, seed);
    ExpectSound(events, Assemble(events, cameras.size()));
  }
}

// Free-running cameras without losses: a set for each period, and every one is complete but for those at the
// ends and where the lead changes.
TEST(FrameSetAssembler, FreeRunningCamerasMakeCompleteSets) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::vector<Behaviour> cameras(4);
    for (Behaviour& camera : cameras) {
      camera.phase_s = std::uniform_real_distribution<>(0.0, kPeriodS)(random);
      camera.period_s = kPeriodS * (1.0 + std::uniform_real_distribution<>(-1e-4, 1e-4)(random));
      camera.jitter_s = 0.0003;
    }
    const std::vector<Event> events = Simulate(cameras, 120.0, seed);
    const Outcome outcome = Assemble(events, 4);
    ExpectSound(events, outcome);
    EXPECT_GE(outcome.sets.size(), 3580U);
    EXPECT_GE(Complete(outcome), outcome.sets.size() - 12);
  }
}

}  // namespace
}  // namespace elbowroom::recon
