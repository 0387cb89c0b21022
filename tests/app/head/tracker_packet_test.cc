// Packets of trackers to poses, and the frames between them.
#include "app/control/head/tracker_packet.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "app/control/head/head_settings.h"
#include "core/error.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

std::vector<std::byte> BytesOf(std::initializer_list<unsigned> values) {
  std::vector<std::byte> bytes;
  for (const unsigned value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

// By hand: 1.5 cm right, 2 cm up, 3 cm back; 0x3FF8 is 1.5, 0x4000 is 2, 0x4008 is 3.
TEST(TrackerPacket, OpenTrackIsReadAsItIsWritten) {
  std::vector<std::byte> packet(48);
  const double values[6] = {1.5, 2.0, 3.0, 10.0, -20.0, 30.0};
  std::memcpy(packet.data(), values, 48);  // this computer is little-endian, too
  const auto result = ReadOpenTrack(packet);
  const auto& reading = std::get<TrackerReading>(result);
  EXPECT_EQ(reading.position_mm, Vector3d(15.0, -30.0, 20.0));  // forward is minus back
  EXPECT_EQ(reading.yaw_deg, 10.0);
  EXPECT_EQ(reading.pitch_deg, -20.0);
  EXPECT_EQ(reading.roll_deg, 30.0);
  EXPECT_EQ(OpenTrackPacket(reading), packet);
}

// By hand: pan 1 degree is 0x008000, tilt -1 degree is 0xFF8000, x 1 mm is 0x000040, height -2 mm 0xFFFF80.
TEST(TrackerPacket, FreeDIsReadAsItIsWritten) {
  std::vector<std::byte> packet = BytesOf({0xD1, 5, 0, 0x80, 0,    0xFF, 0x80, 0, 0, 0, 0, 0, 0, 0x40,
                                           0,    0, 0, 0xFF, 0xFF, 0x80, 0,    0, 0, 0, 0, 0, 0, 0});
  unsigned sum = 0;
  for (const std::byte byte : packet) sum += std::to_integer<unsigned>(byte);
  packet.push_back(static_cast<std::byte>(0x40U - sum));
  const auto result = ReadFreeD(packet, 5);
  const auto& reading = std::get<TrackerReading>(result);
  EXPECT_EQ(reading.position_mm, Vector3d(1.0, 0.0, -2.0));
  EXPECT_EQ(reading.yaw_deg, 1.0);
  EXPECT_EQ(reading.pitch_deg, -1.0);
  EXPECT_EQ(FreeDPacket(reading, 5), packet);
  EXPECT_EQ(std::get<PoseFault>(ReadFreeD(packet, 6)), PoseFault::kMalformed);
}

TEST(TrackerPacket, DamagedFreeDIsMalformed) {
  std::mt19937 random(3);
  const std::vector<std::byte> good = FreeDPacket({{100.0, 200.0, 300.0}, 10.0, 20.0, 30.0}, 1);
  for (int i = 0; i < 5000; ++i) {
    std::vector<std::byte> damaged = good;
    damaged[random() % damaged.size()] ^= static_cast<std::byte>(1U << (random() % 8));
    EXPECT_EQ(std::get<PoseFault>(ReadFreeD(damaged, {})), PoseFault::kMalformed);  // one bit: always seen
  }
  for (std::size_t length = 0; length < 29; ++length)
    EXPECT_EQ(std::get<PoseFault>(ReadFreeD(std::span(good).first(length), {})), PoseFault::kMalformed);
}

TEST(TrackerPacket, OpenTrackWithoutAPoseIsRefused) {
  TrackerReading reading;
  reading.pitch_deg = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(std::get<PoseFault>(ReadOpenTrack(OpenTrackPacket(reading))), PoseFault::kNotFinite);
  reading.pitch_deg = std::numeric_limits<double>::infinity();
  EXPECT_EQ(std::get<PoseFault>(ReadOpenTrack(OpenTrackPacket(reading))), PoseFault::kNotFinite);
  reading.pitch_deg = 1e6;
  EXPECT_EQ(std::get<PoseFault>(ReadOpenTrack(OpenTrackPacket(reading))), PoseFault::kOutOfReach);
  reading = {Vector3d(1e300, 0.0, 0.0), 0.0, 0.0, 0.0};
  EXPECT_EQ(std::get<PoseFault>(ReadOpenTrack(OpenTrackPacket(reading))), PoseFault::kOutOfReach);
  const std::vector<std::byte> good = OpenTrackPacket({});
  for (const std::size_t length : {0U, 1U, 47U})
    EXPECT_EQ(std::get<PoseFault>(ReadOpenTrack(std::span(good).first(length))), PoseFault::kMalformed);
}

// A head's axes are x right, y down, z forward; a tracker's x right, y forward, z up.
TEST(TrackerFrame, TurnsAsItsWordsSay) {
  const Vector3d forward = Vector3d::UnitZ(), right = Vector3d::UnitX(), crown = -Vector3d::UnitY();
  const auto level = TrackerFromHead({}).rotation;
  EXPECT_LT((level * forward - Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((level * crown - Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((level * right - Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_GT((TrackerFromHead({{}, 20.0, 0.0, 0.0}).rotation * forward).x(), 0.3);  // to the right
  EXPECT_GT((TrackerFromHead({{}, 0.0, 20.0, 0.0}).rotation * forward).z(), 0.3);  // up
  EXPECT_GT((TrackerFromHead({{}, 0.0, 0.0, 20.0}).rotation * crown).x(), 0.3);    // to the right shoulder
}

TEST(TrackerFrame, ReadingsComeBack) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const TrackerReading reading{1000.0 * Vector3d(any(random), any(random), any(random)),
                                 179.0 * any(random), 89.0 * any(random), 179.0 * any(random)};
    const TrackerReading back = ReadingOf(TrackerFromHead(reading));
    EXPECT_NEAR(back.yaw_deg, reading.yaw_deg, 1e-9);
    EXPECT_NEAR(back.pitch_deg, reading.pitch_deg, 1e-9);
    EXPECT_NEAR(back.roll_deg, reading.roll_deg, 1e-9);
    EXPECT_EQ(back.position_mm, reading.position_mm);
  }
}

TEST(HeadFile, IsReadWithItsRegistration) {
  const test_support::TemporaryFolder folder;
  test_support::WriteText(folder.path() / "CAP.toml", CapFileText(recon::EightSidedCap()));
  test_support::WriteText(folder.path() / "HEAD.toml", R"(source = "freed"
port = 40001
camera = 3
inverted = ["yaw"]
cap = "CAP.toml"
[tracker]
position_mm = [0, -600, 400]
rotation_rpy_deg = [0, 0, 90]
[sensor]
position_mm = [0, 120, 0]
[fixed]
eyes_mm = [0, -700, 500]
looks_at_mm = [0, 0, 100]
)");
  const HeadSettings settings = ReadHeadFile(folder.path() / "HEAD.toml");
  EXPECT_EQ(settings.source, recon::HeadSource::kFreeD);
  EXPECT_EQ(settings.port_or_default(), 40001);
  EXPECT_EQ(settings.camera, 3);
  // The sensor is 100 mm before the tracker's origin, which is turned to the left by 90 degrees; the eyes are
  // 120 mm below it.
  const auto head = settings.WorldFromHead({{0.0, 100.0, 0.0}, 0.0, 0.0, 0.0});
  EXPECT_LT((head.translation_mm - Vector3d(-100.0, -600.0, 280.0)).norm(), 1e-9);
  EXPECT_LT((head.rotation * Vector3d::UnitZ() - Vector3d(-1.0, 0.0, 0.0)).norm(), 1e-9);
  // Inverted: yaw to the left, which is back along the world's y.
  const auto turned = settings.WorldFromHead({{}, 90.0, 0.0, 0.0});
  EXPECT_LT((turned.rotation * Vector3d::UnitZ() - Vector3d(0.0, -1.0, 0.0)).norm(), 1e-9);
  const recon::Cap cap = recon::EightSidedCap();
  ASSERT_EQ(settings.cap.markers.size(), cap.markers.size());
  for (std::size_t i = 0; i < cap.markers.size(); ++i) {
    const auto there = recon::CornersInCap(settings.cap.markers[i]),
               here = recon::CornersInCap(cap.markers[i]);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_LT((there[k] - here[k]).norm(), 1e-2);
  }
  const auto moved = settings.cap.cap_from_head.Inverse() * cap.cap_from_head;
  EXPECT_LT(moved.translation_mm.norm(), 1e-3);
}

TEST(HeadFile, SaysWhatIsWrong) {
  const test_support::TemporaryFolder folder;
  const auto file = folder.path() / "HEAD.toml";
  for (const char* text :
       {"source = \"nose\"", "port = 0", "port = 1.5", "camera = 256", "inverted = [\"jaw\"]",
        "cap = \"none.toml\"", "sauce = \"fixed\"", "[fixed]\neyes_mm = [0, 0, 0]\nlooks_at_mm = [0, 0, 0]",
        "[tracker]\nposition = 3"}) {
    test_support::WriteText(file, text);
    EXPECT_THROW((void)ReadHeadFile(file), core::Error) << text;
  }
  for (const char* text : {"dictionary = \"DICT_4X4_50\"\neyes_mm = [0, 0, 0]", "eyes_mm = [0, 0, 0]",
                           "dictionary = \"DICT_4X4_50\"\neyes_mm = [0, 0, 0]\n[[marker]]\nid = 1\nside_mm = "
                           "50\nposition_mm = [0, 0, "
                           "0]\nnormal = [0, 0, 1]\nup = [0, 0, 2]"}) {
    test_support::WriteText(file, text);
    EXPECT_THROW((void)ReadCapFile(file), core::Error) << text;
  }
}

}  // namespace
}  // namespace elbowroom::control
