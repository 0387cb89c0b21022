// elbowroom head, as a program.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stop_token>
#include <thread>

#include "app/control/head/head_settings.h"
#include "app/control/head/tracker_packet.h"
#include "app/control/head/udp_port.h"
#include "tests/openxr_runtime/mock_headset.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using test_support::RunProgram;

const std::string kProgram = test_support::ProgramFile().string();

// Sends a head that moves slowly, and one damaged packet in five.
void Send(int port, const std::stop_token& stop) {
  TrackerReading reading{{0.0, -600.0, 400.0}, 10.0, -20.0, 0.0};
  for (int i = 0; !stop.stop_requested(); ++i) {
    reading.position_mm.x() += 0.1;
    std::vector<std::byte> packet = FreeDPacket(reading, 1);
    if (i % 5 == 0) packet[7] ^= static_cast<std::byte>(1);
    SendDatagram("127.0.0.1", port, packet);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));  // a tracker's pace
  }
}

TEST(HeadCommand, CountsPosesAndSaysWhereTheHeadLooks) {
  const int port = UdpPort("0.0.0.0", 0).port();
  std::jthread sender([port](const std::stop_token& stop) { Send(port, stop); });
  const auto run = RunProgram(
      kProgram, {"head", "--source", "freed", "--port", std::to_string(port), "--seconds", "3", "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["source"], "freed");
  EXPECT_GT(json["accepted"].get<int>(), 3);
  EXPECT_GT(json["refused_by_reason"]["malformed"].get<int>(), 0);
  EXPECT_NEAR(json["last"]["yaw_deg"].get<double>(), 10.0, 1e-3);
  EXPECT_NEAR(json["last"]["position_mm"][1].get<double>(), -600.0, 0.1);
}

TEST(HeadCommand, SaysThatNothingComes) {
  const int port = UdpPort("0.0.0.0", 0).port();
  const auto run = RunProgram(
      kProgram, {"head", "--source", "opentrack", "--port", std::to_string(port), "--seconds", "0.3"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find(std::to_string(port)), std::string::npos);
}

TEST(HeadCommand, FollowsAnOpenXrHeadset) {
  const test_support::MockHeadset mock;
  const auto run = RunProgram(kProgram, {"head", "--source", "openxr", "--seconds", "3", "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["source"], "openxr");
  EXPECT_EQ(json["headset"]["name"], "Mock runtime 1.2.3, Mock headset");
  EXPECT_EQ(json["headset"]["state"], "focused");
  EXPECT_NEAR(json["last"]["position_mm"][2].get<double>(), 1200.0, 1e-3);
  EXPECT_EQ(mock.control().misuse, 0) << mock.control().what_misuse.data();
}

TEST(HeadCommand, SaysAtOnceThatThereIsNoRuntime) {
  test_support::RunOptions options;
  options.environment = {{"XR_RUNTIME_JSON", "/nowhere/runtime.json"}};
  const auto run = RunProgram(kProgram, {"head", "--source", "openxr", "--seconds", "3600"}, options);
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("no OpenXR runtime answers"), std::string::npos) << run.err;
}

TEST(HeadCommand, WritesACapThatItReads) {
  const test_support::TemporaryFolder folder;
  const std::string cap = (folder / "CAP.toml").string();
  ASSERT_EQ(RunProgram(kProgram, {"head", "--write-cap", cap}).exit_status, 0);
  EXPECT_EQ(ReadCapFile(cap).markers.size(), 9U);
  const auto run = RunProgram(kProgram, {"head", "--source", "cap", "--cap", cap});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("--rig"), std::string::npos);
}

}  // namespace
}  // namespace elbowroom::control
