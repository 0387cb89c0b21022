#include "recon/footage/stamped_frames.h"

#include <gtest/gtest.h>

#include <random>

#include "core/error.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::recon {
namespace {

using test_support::TemporaryFolder;
using test_support::WriteText;

FrameStamps Read(const std::string& text) {
  const TemporaryFolder folder;
  WriteText(folder / "stamps.csv", text);
  return ReadFrameStamps(folder / "stamps.csv", "camera 'cam1'");
}

std::string ErrorOf(const std::string& text) {
  try {
    (void)Read(text);
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

TEST(FrameStamps, AreReadByColumnNames) {
  const FrameStamps stamps = Read("time_s,camera,frame\r\n1.5,cam1,0\r\n 2.5 ,cam1,\"2\"\n\n");
  ASSERT_EQ(stamps.size(), 3U);
  EXPECT_EQ(stamps[0], 1.5);
  EXPECT_FALSE(stamps[1].has_value());
  EXPECT_EQ(stamps[2], 2.5);
}

TEST(FrameStamps, WrongTablesAreRefusedWithTheLine) {
  EXPECT_NE(ErrorOf("frame,time_s\n0,1.0\n1,0.5\n").find("line 3: the stamp of frame 1 goes back, from 1"),
            std::string::npos);
  EXPECT_NE(ErrorOf("frame,time\n0,1.0\n").find("line 1: has no column 'time_s'"), std::string::npos);
  EXPECT_NE(ErrorOf("frame,time_s\n0,soon\n").find("line 2: 'soon' is no time"), std::string::npos);
  EXPECT_NE(ErrorOf("frame,time_s\n0,nan\n").find("'nan' is no time"), std::string::npos);
  EXPECT_NE(ErrorOf("frame,time_s\n-1,1\n").find("'-1' is no frame's number"), std::string::npos);
  EXPECT_NE(ErrorOf("frame,time_s\n1,1\n0,2\n").find("line 3: frame 0 comes after frame 1"),
            std::string::npos);
  EXPECT_NE(ErrorOf("frame,time_s,picture\n1,1,x\n").find("line 2: 'x' is no picture's number"),
            std::string::npos);
  EXPECT_NE(ErrorOf("frame,time_s,picture\n1,1\n").find("line 2: has too few columns"), std::string::npos);
  EXPECT_NE(ErrorOf("frame,time_s\n1\n").find("line 2: has too few columns"), std::string::npos);
  EXPECT_NE(ErrorOf("frame,time_s\n").find("has no stamps"), std::string::npos);
  EXPECT_NE(ErrorOf("").find("is empty"), std::string::npos);
}

FrameStamps Regular(int count, double start_s, double period_s) {
  FrameStamps stamps;
  for (int i = 0; i < count; ++i) stamps.emplace_back(start_s + i * period_s);
  return stamps;
}

TEST(SetsByNearestStamp, PairFramesOfFreeRunningCameras) {
  // The second camera starts two frames early and runs 10 ms late.
  const std::vector<FrameStamps> cameras{Regular(10, 5.0, 0.04), Regular(12, 4.93, 0.04)};
  const std::vector<StampedSet> sets = SetsByNearestStamp(cameras);
  ASSERT_EQ(sets.size(), 10U);
  for (std::size_t i = 0; i < sets.size(); ++i) {
    EXPECT_EQ(sets[i].frames[0].value().frame, static_cast<core::FrameIndex>(i));
    EXPECT_EQ(sets[i].frames[1].value().frame, static_cast<core::FrameIndex>(i + 2));
    EXPECT_NEAR(sets[i].frames[1]->time_s - sets[i].frames[0]->time_s, 0.01, 1e-9);
  }
}

TEST(SetsByNearestStamp, LeaveOutWhatIsTooFar) {
  FrameStamps with_gap = Regular(10, 0.0, 0.1);
  with_gap[4] = with_gap[5] = std::nullopt;
  const std::vector<FrameStamps> cameras{with_gap, Regular(20, 0.001, 0.1)};
  const std::vector<StampedSet> sets = SetsByNearestStamp(cameras);
  ASSERT_EQ(sets.size(), 8U);
  EXPECT_EQ(sets[4].frames[0].value().frame, 6);
  EXPECT_EQ(sets[4].frames[1].value().frame, 6);
}

// Against the plain rule, frame by frame.
TEST(SetsByNearestStamp, NoFrameIsUsedTwiceAndAllAreNear) {
  std::mt19937_64 engine(22);
  for (int trial = 0; trial < 200; ++trial) {
    std::uniform_real_distribution<double> jitter(-0.3, 0.3), start(0.0, 0.2);
    std::vector<FrameStamps> cameras(3);
    for (FrameStamps& stamps : cameras) {
      const double first_s = start(engine);
      const int count = std::uniform_int_distribution(2, 40)(engine);
      for (int i = 0; i < count; ++i) stamps.emplace_back(first_s + 0.04 * (i + jitter(engine)));
    }
    const std::vector<StampedSet> sets = SetsByNearestStamp(cameras);
    for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
      core::FrameIndex last = -1;
      for (const StampedSet& set : sets) {
        if (!set.frames[camera]) continue;
        EXPECT_GT(set.frames[camera]->frame, last) << "each frame once, in order";
        last = set.frames[camera]->frame;
        EXPECT_EQ(set.frames[camera]->time_s, cameras[camera][static_cast<std::size_t>(last)]);
        for (const auto& other : set.frames) {
          if (!other) continue;
          EXPECT_LE(std::abs(other->time_s - set.frames[camera]->time_s), 0.065);
        }
      }
    }
  }
}

TEST(SetsByNearestStamp, NeedStampsOfEveryCamera) {
  const std::vector<FrameStamps> cameras{Regular(3, 0.0, 0.1), FrameStamps()};
  EXPECT_TRUE(SetsByNearestStamp(cameras).empty());
  EXPECT_TRUE(SetsByNearestStamp({}).empty());
}

TEST(SetsOfAllTimes, LeaveNoTimeOutWhileOneCameraSees) {
  // All of 10 Hz, within 20 ms of each other; the middle one leads. Each camera is away for a while, the
  // leader alone at 3 and 4, with another one at 5, and at 6 all are.
  std::vector<FrameStamps> cameras{Regular(12, 0.02, 0.1), Regular(12, 0.0, 0.1), Regular(12, -0.02, 0.1)};
  for (const std::size_t away : {3, 4, 5, 6}) cameras[1][away].reset();
  for (const std::size_t away : {5, 6, 8}) cameras[0][away].reset();
  cameras[2][6].reset();
  const std::vector<StampedSet> sets = SetsOfAllTimes(cameras);
  ASSERT_EQ(sets.size(), 11U);
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const core::FrameIndex number = static_cast<core::FrameIndex>(i < 6 ? i : i + 1);
    for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
      const bool is_there = cameras[camera][static_cast<std::size_t>(number)].has_value();
      ASSERT_EQ(sets[i].frames[camera].has_value(), is_there) << number << " of camera " << camera;
      if (!is_there) continue;
      EXPECT_EQ(sets[i].frames[camera]->frame, number);
    }
  }
}

TEST(SetsOfAllTimes, TheSlowestCameraNearestToTheOthersLeads) {
  // Around the first one, the third's frame would be another one; the fourth is twice as fast.
  const std::vector<FrameStamps> cameras{Regular(20, 0.0, 0.1), Regular(20, 0.03, 0.1),
                                         Regular(20, 0.06, 0.1), Regular(40, 0.03, 0.05)};
  const std::vector<StampedSet> sets = SetsOfAllTimes(cameras);
  ASSERT_EQ(sets.size(), 20U);
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const auto number = static_cast<core::FrameIndex>(i);
    for (std::size_t camera = 0; camera < 3; ++camera)
      EXPECT_EQ(sets[i].frames[camera].value().frame, number);
    EXPECT_EQ(sets[i].frames[3].value().frame, 2 * number);
  }
}

// Against the plain rule: every frame once, in order, and near the others; none of the leader's left out.
TEST(SetsOfAllTimes, UseEachFrameOnceInOrder) {
  std::mt19937_64 engine(23);
  for (int trial = 0; trial < 200; ++trial) {
    std::uniform_real_distribution<double> jitter(-0.2, 0.2), start(0.0, 0.03), chance(0.0, 1.0);
    std::vector<FrameStamps> cameras(3);
    for (FrameStamps& stamps : cameras) {
      const double first_s = start(engine);
      for (int i = 0; i < 60; ++i) {
        stamps.emplace_back(first_s + 0.04 * (i + jitter(engine)));
        if (i > 0 && i < 59 && chance(engine) < 0.2) stamps.back().reset();
      }
    }
    const std::vector<StampedSet> sets = SetsOfAllTimes(cameras);
    constexpr std::size_t kLeastSets = 52;  // of 60: less the ends, and the few times that all cameras miss
    EXPECT_GE(sets.size(), kLeastSets);
    for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
      core::FrameIndex last = -1;
      for (const StampedSet& set : sets) {
        if (!set.frames[camera]) continue;
        EXPECT_GT(set.frames[camera]->frame, last);
        last = set.frames[camera]->frame;
        EXPECT_EQ(set.frames[camera]->time_s, cameras[camera][static_cast<std::size_t>(last)]);
        for (const auto& other : set.frames) {
          if (!other) continue;
          EXPECT_LE(std::abs(other->time_s - set.frames[camera]->time_s), 0.065);
        }
      }
    }
  }
}

TEST(SetsOfAllTimes, NeedStampsOfEveryCamera) {
  EXPECT_TRUE(SetsOfAllTimes(std::vector<FrameStamps>{Regular(3, 0.0, 0.1), FrameStamps()}).empty());
  EXPECT_TRUE(SetsOfAllTimes({}).empty());
}

}  // namespace
}  // namespace elbowroom::recon
