// Recorded footage whose cameras have tables of stamps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <set>

#include "recon/footage/recorded_rig.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/support/places.h"
#include "tests/support/text_file.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using test_support::WriteText;
using ::testing::AllOf;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::NumberIn;
using testing::PlainRig;
using testing::TestFolder;

constexpr double kToleranceS = 1e-9;  // of sums of a few decimal fractions

// A video of `frames` numbered frames, and its table of stamps without those of `lost`.
CameraSources StampedVideo(const TestFolder& folder, const std::string& name, int frames,
                           const std::function<double(int)>& time_s, const std::set<int>& lost = {},
                           double time_offset_s = 0.0) {
  testing::WriteVideo(folder.File(name + ".avi"), frames);
  std::string table = "frame,time_s\n";
  for (int i = 0; i < frames; ++i)
    if (!lost.contains(i)) table += fmt::format("{},{}\n", i, time_s(i));
  WriteText(folder.File(name + ".csv"), table);
  CameraSources sources{folder.File(name + ".avi"), "", ""};
  sources.timestamps = folder.File(name + ".csv");
  sources.time_offset_s = time_offset_s;
  return sources;
}

TEST(StampedRig, FormsSetsByTheNearestStampAfterTheOffsets) {
  const TestFolder folder;
  // Camera 2 began three frames earlier, and its stamps are 0.5 s late; it looks 10 ms after camera 1.
  RecordedRig rig(PlainRig({StampedVideo(folder, "a", 12, [](int i) { return 100.0 + 0.04 * i; }),
                            StampedVideo(
                                folder, "b", 20, [](int i) { return 100.51 + 0.04 * (i - 3); }, {}, -0.5)}));
  ASSERT_EQ(rig.frame_count(), 12);
  EXPECT_NEAR(rig.frame_rate_hz(), 25.0, 1e-6);
  for (int i = 0; i < 12; ++i) {
    const FrameSet set = rig.Read(i);
    EXPECT_EQ(NumberIn(set.cameras[0].image_bgr), i);
    EXPECT_EQ(NumberIn(set.cameras[1].image_bgr), i + 3);
    EXPECT_NEAR(set.time_s, 0.04 * i, kToleranceS);
    EXPECT_EQ(set.cameras[1].stamp->picture, static_cast<std::uint64_t>(i + 3));
    EXPECT_NEAR(set.cameras[0].stamp->time_s, set.time_s - 0.005, kToleranceS);
    EXPECT_NEAR(set.cameras[1].stamp->time_s, set.time_s + 0.005, kToleranceS);
  }
  EXPECT_EQ(rig.TryRead(12, {}), std::nullopt);
  EXPECT_THAT(rig.WhatEndsIt(), HasSubstr("12 sets"));
  // In any order.
  EXPECT_EQ(NumberIn(rig.Read(9).cameras[1].image_bgr), 12);
  EXPECT_EQ(NumberIn(rig.Read(2).cameras[1].image_bgr), 5);
}

TEST(StampedRig, ACameraWithoutAPictureNearIsMissingInTheSet) {
  const TestFolder folder;
  const auto even = [](int i) { return 0.04 * i; };
  // Camera 3 has the fewest stamps and so decides when sets are; 2 lost frames that the others have.
  RecordedRig rig(PlainRig({StampedVideo(folder, "a", 10, even), StampedVideo(folder, "b", 10, even, {4, 5}),
                            StampedVideo(folder, "c", 10, even, {0, 8, 9})}));
  ASSERT_EQ(rig.frame_count(), 7);
  for (int i = 0; i < 7; ++i) {
    const FrameSet set = rig.Read(i);
    const int number = i + 1;
    EXPECT_EQ(NumberIn(set.cameras[0].image_bgr), number);
    EXPECT_EQ(NumberIn(set.cameras[2].image_bgr), number);
    const bool is_missing = number == 4 || number == 5;
    EXPECT_EQ(set.cameras[1].stamp.has_value(), !is_missing) << number;
    EXPECT_EQ(set.cameras[1].image_bgr.empty(), is_missing) << number;
    if (is_missing) continue;
    EXPECT_EQ(NumberIn(set.cameras[1].image_bgr), number);
  }
}

TEST(StampedRig, PicturesKeepTheNumbersThatTheyCameWith) {
  const TestFolder folder;
  CameraSources sources = StampedVideo(folder, "a", 4, [](int i) { return 0.04 * i; });
  WriteText(folder.File("a.csv"), "frame,time_s,picture\n0,0.0,7\n2,0.08,9\n3,0.12,12\n");
  RecordedRig rig(PlainRig({sources}));
  ASSERT_EQ(rig.frame_count(), 3);
  EXPECT_EQ(rig.Read(0).cameras[0].stamp->picture, 7U);
  EXPECT_EQ(rig.Read(1).cameras[0].stamp->picture, 9U);
  EXPECT_EQ(rig.Read(2).cameras[0].stamp->picture, 12U);
  EXPECT_EQ(NumberIn(rig.Read(1).cameras[0].image_bgr), 2);
}

TEST(StampedRig, WithoutATableForEachCameraFramesGoByTheirNumbers) {
  const TestFolder folder;
  CameraSources without = StampedVideo(folder, "b", 8, [](int i) { return 7.0 + i; });
  without.timestamps.clear();
  RecordedRig rig(PlainRig({StampedVideo(folder, "a", 6, [](int i) { return 3.0 * i; }), without}));
  EXPECT_EQ(rig.frame_count(), 6);
  const FrameSet set = rig.Read(5);
  EXPECT_EQ(NumberIn(set.cameras[1].image_bgr), 5);
  EXPECT_FALSE(set.cameras[0].stamp.has_value());
}

using PictureNumbers = std::vector<std::optional<std::uint64_t>>;

TEST(StampedRig, PicturesAreFoundByTheirNumbersWhateverTheirSets) {
  const TestFolder folder;
  CameraSources a = StampedVideo(folder, "a", 4, [](int i) { return 0.04 * i; });
  CameraSources b = StampedVideo(folder, "b", 60, [](int i) { return 0.04 * i; });
  WriteText(folder.File("a.csv"), "frame,time_s,picture\n0,0.0,7\n2,0.08,9\n3,0.12,12\n8,0.36,20\n");
  RecordedRig rig(PlainRig({a, b}));
  const auto read = [&](const PictureNumbers& numbers) {
    std::vector<int> found;
    for (const auto& picture : rig.ReadPictures(numbers, {}))
      found.push_back(picture ? NumberIn(picture->image_bgr) : -1);
    return found;
  };
  using Found = std::vector<int>;
  EXPECT_EQ(read({9, 40}), (Found{2, 40}));
  EXPECT_EQ(read({12, 41}), (Found{3, 41}));
  EXPECT_EQ(read({7, 3}), (Found{0, 3}));
  EXPECT_EQ(read({8, 59}), (Found{-1, 59}));  // the table doesn't have it
  EXPECT_EQ(read({0, std::nullopt}), (Found{-1, -1}));
  EXPECT_EQ(read({std::nullopt, 4}), (Found{-1, 4}));
  EXPECT_THAT(ErrorOf(ErrorKind::kFile,
                      [&] {
                        (void)read({20, 5});
                      }),
              AllOf(HasSubstr("camera 'cam1'"), HasSubstr("no frame 8, which is its picture 20")));
  EXPECT_EQ(read({9, 6}), (Found{2, 6}));
  // Sets are read as before.
  EXPECT_EQ(NumberIn(rig.Read(1).cameras[1].image_bgr), 2);
}

TEST(StampedRig, WithoutStampsPicturesAreFoundByTheFramesNumbers) {
  const TestFolder folder;
  CameraSources without = StampedVideo(folder, "b", 8, [](int i) { return 7.0 + i; });
  without.timestamps.clear();
  RecordedRig rig(PlainRig({StampedVideo(folder, "a", 6, [](int i) { return 3.0 * i; }), without}));
  const PictureNumbers numbers{5, 7};
  const auto pictures = rig.ReadPictures(numbers, {});
  EXPECT_EQ(NumberIn(pictures[0]->image_bgr), 5);
  EXPECT_EQ(NumberIn(pictures[1]->image_bgr), 7);
}

TEST(StampedRig, ATableThatCantBeReadIsNamed) {
  const TestFolder folder;
  CameraSources sources = StampedVideo(folder, "a", 3, [](int i) { return 0.1 * i; });
  WriteText(folder.File("a.csv"), "frame,time_s\n0,0.2\n1,0.1\n");
  EXPECT_THAT(ErrorOf(ErrorKind::kFormat, [&] { RecordedRig rig(PlainRig({sources})); }),
              HasSubstr("camera 'cam1': stamps"));
  WriteText(folder.File("a.csv"), "frame,time_s\n70,0.2\n71,0.3\n");
  EXPECT_THAT(ErrorOf(ErrorKind::kFormat, [&] { RecordedRig rig(PlainRig({sources})); }),
              HasSubstr("name no picture that their footage has"));
}

// Four webcams that share no clock.
TEST(StampedRig, RealWebcamsPlayAtTheirStamps) {
  const std::filesystem::path webcams = test_support::SharedDataFolder() / "calibration" / "webcams";
  if (!std::filesystem::exists(webcams)) GTEST_SKIP() << "NOT TESTED: no footage at " << webcams;
  std::vector<CameraSources> sources;
  for (int i = 0; i < 4; ++i) {
    sources.push_back({(webcams / fmt::format("cam_{}.mp4", i)).string(), "", ""});
    sources.back().timestamps = (webcams / "stamps" / fmt::format("cam_{}.csv", i)).string();
  }
  RigFile rig_file = PlainRig(sources);
  for (core::CameraModel& camera : rig_file.rig.cameras) {
    core::CameraCalibration calibration = camera.calibration();
    calibration.image_width_px = 1280;
    calibration.image_height_px = 720;
    camera = core::CameraModel(calibration);
  }
  RecordedRig rig(rig_file);
  ASSERT_GT(rig.frame_count(), 90) << "of about 111 pictures a camera";
  double last_s = -1.0, farthest_s = 0.0;
  int missing = 0;
  for (core::FrameIndex i = 0; i < 20; ++i) {
    const FrameSet set = rig.Read(i);
    EXPECT_GT(set.time_s, last_s);
    last_s = set.time_s;
    for (const CameraFrame& camera : set.cameras) {
      missing += camera.stamp ? 0 : 1;
      EXPECT_EQ(camera.stamp.has_value(), !camera.image_bgr.empty());
      if (camera.stamp) farthest_s = std::max(farthest_s, std::abs(camera.stamp->time_s - set.time_s));
    }
  }
  std::printf("%lld sets at %.2f Hz; of the first 20, cameras within %.1f ms of the set's time, %d missing\n",
              static_cast<long long>(*rig.frame_count()), rig.frame_rate_hz(), 1e3 * farthest_s, missing);
  EXPECT_GT(farthest_s, 1e-4) << "they are free-running";
  EXPECT_LT(farthest_s, 1.0 / rig.frame_rate_hz());
  EXPECT_LT(missing, 20);
}

}  // namespace
}  // namespace elbowroom::recon
