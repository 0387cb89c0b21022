// What a test and the small OpenXR runtime (mock_runtime.cc) tell each other, in a file that both map.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace elbowroom::test_support {

// The file's path is in this variable of the environment.
inline constexpr const char* kMockControlVariable = "ELBOWROOM_MOCK_OPENXR";
// The runtime's clock is ahead of the system's by that: who forgets to convert times is found out.
inline constexpr std::int64_t kMockClockAheadNs = 1'000'000'000'000'000;
inline constexpr std::int64_t kMockPredictionNs = 20'000'000;
inline constexpr std::int32_t kMockEyeWidthPx = 512, kMockEyeHeightPx = 480;

// Positions in m, quaternions x, y, z, w, as OpenXR has them: x to the right, y up, z back.
struct MockPose {
  std::array<double, 3> position{0.0, 1.2, 0.0};
  std::array<double, 4> quaternion{0.0, 0.0, 0.0, 1.0};
};

struct MockEye {
  double x_m = 0.0;                                   // from the middle between the eyes
  double turned_outwards_rad = 0.0;                   // canted displays
  std::array<double, 4> fov{-0.8, 0.7, 0.75, -0.85};  // left, right, up, down, rad
};

// One picture that was handed over, as a headset would show it: the upper row first.
struct MockPicture {
  std::int32_t width_px = 0, height_px = 0;
  MockPose pose;
  std::array<double, 4> fov{};
  std::array<std::uint8_t, std::size_t{3} * kMockEyeWidthPx * kMockEyeHeightPx> rgb{};
};

// Events for the program; each is delivered once.
enum class MockEvent : std::int32_t {
  kNone,
  kIdle,
  kReady,
  kSynchronized,
  kVisible,
  kFocused,
  kStopping,
  kLossPending,
  kExiting,
  kInstanceLoss,
  kRecentred,
};

struct MockControl {
  // Set by the test before the runtime is loaded.
  std::int32_t offers_headless = 1, offers_egl = 1, offers_time = 1, has_headset = 1, has_stage = 1;
  std::int32_t refuses_instance = 0, refuses_session = 0;
  std::int32_t begins_by_itself = 1;  // goes to FOCUSED without being told
  // While it runs.
  std::atomic<std::int32_t> is_tracked{1};
  std::atomic<std::int32_t> vanishes{0};  // every call says that the instance is lost
  std::atomic<std::int32_t> crashes{0};   // the next call ends the process
  std::atomic<std::int32_t> hangs{0};     // calls that say where the head is don't return while it is set
  std::atomic<std::int32_t> event_serial{0};
  std::array<MockEvent, 64> events{};        // events 0 to event_serial - 1
  std::int32_t events_read = 0;              // by the runtime, of all its instances
  std::atomic<std::int32_t> pose_serial{0};  // odd while the pose is written
  MockPose head;
  std::array<MockEye, 2> eyes{MockEye{-0.0315, 0.0, {-0.8, 0.7, 0.75, -0.85}},
                              MockEye{0.0315, 0.0, {-0.7, 0.8, 0.75, -0.85}}};
  // Told by the runtime.
  std::atomic<std::int32_t> instances{0}, sessions{0}, begun{0}, ended{0};
  std::atomic<std::int32_t> headless_sessions{0};
  std::atomic<std::int32_t> misuse{0};  // calls that OpenXR forbids
  std::array<char, 200> what_misuse{};  // the first of them
  std::atomic<std::int64_t> frames{0};
  std::atomic<std::int64_t> frames_with_pictures{0};  // grows after `pictures` are written
  std::atomic<std::int32_t> picture_serial{0};        // odd while they are written
  std::atomic<std::int32_t> keeps_pictures{1};        // 0: they stay as they are
  std::array<MockPicture, 2> pictures;
};

}  // namespace elbowroom::test_support
