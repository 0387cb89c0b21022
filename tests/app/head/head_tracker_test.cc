// Trackers with real packets over the loopback interface.
#include "app/control/head/head_tracker.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <limits>
#include <mutex>
#include <random>

#include "app/control/head/udp_port.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

using Bytes = std::vector<std::byte>;
using recon::HeadSource;

// Waits for poses that the tracker's thread tells of.
class PoseBell {
 public:
  void Ring() {
    const std::lock_guard lock(mutex_);
    ++rings_;
    rung_.notify_all();
  }
  // False: nothing came for ten seconds.
  bool AwaitMoreThan(int rings) {
    std::unique_lock lock(mutex_);
    return rung_.wait_for(lock, std::chrono::seconds(10), [&] { return rings_ > rings; });
  }
  int rings() {
    const std::lock_guard lock(mutex_);
    return rings_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable rung_;
  int rings_ = 0;
};

HeadSettings ListeningAtAnyPort(HeadSource source) {
  HeadSettings settings;
  settings.source = source;
  settings.address = "127.0.0.1";
  settings.port = 0;
  return settings;
}

// A tracker, and a head that sends to it.
class Loopback {
 public:
  explicit Loopback(HeadSource source)
      : source_(source), tracker(ListeningAtAnyPort(source), {}, [this](const HeadState&) { bell.Ring(); }) {}

  [[nodiscard]] Bytes PacketOf(const TrackerReading& its) const {
    return source_ == HeadSource::kFreeD ? FreeDPacket(its, 1) : OpenTrackPacket(its);
  }
  void Send(const Bytes& bytes) { SendDatagram("127.0.0.1", *tracker.port(), bytes); }
  // Sends readings near one another until one more is accepted.
  void SendUntilAccepted() {
    const int before = bell.rings();
    for (int i = 0; i < 200 && bell.rings() == before; ++i) {
      reading.position_mm.x() += 0.25;
      const auto refused = tracker.counts().all_refused();
      Send(PacketOf(reading));
      while (bell.rings() == before && tracker.counts().all_refused() == refused) std::this_thread::yield();
    }
    ASSERT_GT(bell.rings(), before);
  }
  // Waits until the tracker has read all that was sent.
  void AwaitRefused(std::int64_t count) {
    const auto until = HeadClock::now() + std::chrono::seconds(20);
    while (tracker.counts().all_refused() < count && HeadClock::now() < until) std::this_thread::yield();
    ASSERT_GE(tracker.counts().all_refused(), count);
  }

 private:
  HeadSource source_;

 public:
  PoseBell bell;
  TrackerReading reading{{10.0, 20.0, 30.0}, 1.0, 2.0, 3.0};
  HeadTracker tracker;
};

class HeadTrackerOverUdp : public ::testing::TestWithParam<HeadSource> {};

TEST_P(HeadTrackerOverUdp, FollowsTheHead) {
  Loopback loopback(GetParam());
  for (int i = 0; i < 20; ++i) loopback.SendUntilAccepted();
  const HeadState state = loopback.tracker.state();
  ASSERT_TRUE(state.pose.has_value());
  EXPECT_LT((state.pose->world_from_head.translation_mm - loopback.reading.position_mm).norm(), 1e-9);
  EXPECT_EQ(state.pose->source, GetParam());
}

// Thousands of damaged packets: cut off, bits changed, lengthened, NaN, or all chance.
TEST_P(HeadTrackerOverUdp, IsNotMovedByDamagedPackets) {
  Loopback loopback(GetParam());
  std::mt19937 random(GetParam() == HeadSource::kFreeD ? 21U : 22U);
  for (int round = 0; round < 40; ++round) {
    loopback.SendUntilAccepted();
    const auto before = loopback.tracker.state();
    const auto counts = loopback.tracker.counts();
    constexpr int kPackets = 100;  // at once: fewer than the system keeps waiting
    for (int i = 0; i < kPackets; ++i) {
      Bytes packet = loopback.PacketOf(loopback.reading);
      switch (random() % 4) {
        case 0:
          packet.resize(random() % packet.size());
          break;
        case 1:
          packet.resize(packet.size() + 1 + random() % 900, static_cast<std::byte>(random()));
          break;
        case 2:  // FreeD: any changed bit is seen; OpenTrack: the exponents of a value
          packet[GetParam() == HeadSource::kFreeD ? random() % packet.size() : 8 * (random() % 6) + 7] =
              static_cast<std::byte>(0x7F);
          if (GetParam() != HeadSource::kFreeD) packet.resize(48, static_cast<std::byte>(0xFF));
          if (packet == loopback.PacketOf(loopback.reading)) packet.resize(3);
          break;
        default:
          for (std::byte& byte : packet) byte = static_cast<std::byte>(random());
          packet[0] = static_cast<std::byte>(0);                                           // never a D1
          if (GetParam() != HeadSource::kFreeD) packet[7] = static_cast<std::byte>(0x7E);  // huge
          break;
      }
      loopback.Send(packet);
    }
    loopback.AwaitRefused(counts.all_refused() + kPackets);
    const auto after = loopback.tracker.state();
    EXPECT_EQ(after.serial, before.serial);
    EXPECT_EQ(after.pose->world_from_head, before.pose->world_from_head);
  }
  EXPECT_GE(loopback.tracker.counts().all_refused(), 4000);
}

// A recording of another place, played back.
TEST_P(HeadTrackerOverUdp, IsNotMovedByAJump) {
  Loopback loopback(GetParam());
  loopback.SendUntilAccepted();
  const auto before = loopback.tracker.state();
  const auto refused = loopback.tracker.counts().all_refused();
  TrackerReading elsewhere = loopback.reading;
  elsewhere.position_mm.z() += 2000.0;
  loopback.Send(loopback.PacketOf(elsewhere));
  loopback.AwaitRefused(refused + 1);
  EXPECT_EQ(loopback.tracker.state().pose->world_from_head, before.pose->world_from_head);
}

INSTANTIATE_TEST_SUITE_P(Sources, HeadTrackerOverUdp,
                         ::testing::Values(HeadSource::kOpenTrack, HeadSource::kFreeD),
                         [](const auto& its) { return std::string(recon::ToString(its.param)); });

TEST(HeadTracker, SaysWhenItsPortIsTaken) {
  HeadTracker first(ListeningAtAnyPort(HeadSource::kOpenTrack), {});
  HeadSettings settings = ListeningAtAnyPort(HeadSource::kOpenTrack);
  settings.port = first.port();
  EXPECT_THROW(HeadTracker(settings, {}), core::Error);
  settings.address = "nowhere";
  EXPECT_THROW(HeadTracker(settings, {}), core::Error);
}

TEST(HeadTracker, WithoutATrackerStaysAtTheFixedPoint) {
  const HeadTracker tracker(HeadSettings{}, {});
  EXPECT_FALSE(tracker.state().is_lost);
  EXPECT_EQ(tracker.state().pose->world_from_head, HeadSettings{}.world_from_fixed_head);
  EXPECT_EQ(tracker.counts().all_refused(), 0);
}

TEST(HeadTracker, NeedsARigToFindACap) {
  HeadSettings settings;
  settings.source = HeadSource::kCap;
  EXPECT_THROW(HeadTracker(settings, {}), core::Error);
}

// Datagrams that waited in the system's queue are as old as they are. The kernel begins to stamp a while
// after it was asked to: until then the stamp is that of reading.
TEST(UdpPort, TellsWhenADatagramCameNotWhenItWasRead) {
  constexpr int kTries = 100;
  constexpr std::chrono::milliseconds kWaits{30}, kClocksDiffer{5};  // the kernel's clock and ours
  UdpPort port("127.0.0.1", 0);
  bool is_stamped = false;
  for (int i = 0; i < kTries && !is_stamped; ++i) {
    SendDatagram("127.0.0.1", port.port(), Bytes(4));
    const auto sent = HeadClock::now();
    while (HeadClock::now() < sent + kWaits) std::this_thread::yield();
    const auto datagram = port.Receive(std::chrono::milliseconds(1000));
    ASSERT_TRUE(datagram.has_value());
    EXPECT_EQ(datagram->bytes.size(), 4U);
    is_stamped = datagram->came_at <= sent + kClocksDiffer;
  }
  EXPECT_TRUE(is_stamped);
  EXPECT_FALSE(port.Receive(std::chrono::milliseconds(1)).has_value());
}

}  // namespace
}  // namespace elbowroom::control
