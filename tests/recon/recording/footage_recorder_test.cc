// Live cameras that are recorded: what is in the files is what came.
#include "recon/recording/footage_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string_view>

#include "recon/footage/image_source.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "tests/recon/capture/own_network.h"
#include "tests/recon/capture/served_rig.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/recon/recording/recorded_tables.h"
#include "tests/support/text_file.h"

namespace elbowroom::recon {
namespace {

namespace fs = std::filesystem;
using core::CameraIndex;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::LossRow;
using testing::ServedRig;
using testing::StampRow;
using testing::TestFolder;

constexpr int kCameras = 4;
constexpr double kRateHz = 15.0;

const auto* const kNetwork = ::testing::AddGlobalTestEnvironment(new testing::OwnNetwork(kCameras));

std::vector<FrameSet> DemoSets() {
  SyntheticRig rig(FourCameraRig(), [](double t) { return DemoSceneAt(t).objects; });
  constexpr core::FrameIndex kFirst = 60, kSets = 30;
  std::vector<FrameSet> sets;
  for (core::FrameIndex i = 0; i < kSets; ++i) sets.push_back(rig.Read(kFirst + i));
  return sets;
}

std::size_t HashOf(const cv::Mat& picture) {
  return std::hash<std::string_view>()(
      {reinterpret_cast<const char*>(picture.data), picture.total() * picture.elemSize()});
}

// What came of one camera, seen beside the recorder.
struct Came {
  std::size_t hash = 0;
  CaptureClock::time_point taken_at;
};

class Witness {
 public:
  // Passes all on to the recorder, and keeps it.
  [[nodiscard]] LiveTaps Taps(FootageRecorder& recorder) {
    LiveTaps taps = recorder.Taps();
    taps.on_picture = [this, record = taps.on_picture](CameraIndex camera, const CapturedPicture& picture) {
      {
        const std::lock_guard lock(mutex_);
        came_[camera][picture.number] = {HashOf(picture.image_bgr), picture.taken_at};
      }
      record(camera, picture);
      has_come_.notify_all();
    };
    return taps;
  }

  // Waits until so many more pictures of each camera have come.
  void WaitFor(std::size_t pictures) {
    std::unique_lock lock(mutex_);
    const auto before = came_;
    has_come_.wait(lock, [&] {
      for (CameraIndex i = 0; i < kCameras; ++i)
        if (came_[i].size() < before[i].size() + pictures) return false;
      return true;
    });
  }

  [[nodiscard]] std::map<std::uint64_t, Came> came(CameraIndex camera) {
    const std::lock_guard lock(mutex_);
    return came_[camera];
  }

 private:
  std::mutex mutex_;
  std::condition_variable has_come_;
  std::array<std::map<std::uint64_t, Came>, kCameras> came_;
};

std::string ExactSeconds(CaptureClock::time_point at) {
  std::string ns = std::to_string(at.time_since_epoch().count());
  return ns.insert(ns.size() - 9, ".");
}

// Each picture of the video is the one that came with that number and stamp.
void ExpectAsItCame(const CameraRecording& recording, const core::CameraModel& camera,
                    const std::map<std::uint64_t, Came>& came) {
  const auto source = OpenImageSource(recording.video.string(), camera, {});
  const std::vector<StampRow> stamps = testing::StampRowsOf(recording.timestamps);
  ASSERT_EQ(static_cast<std::int64_t>(stamps.size()), recording.frames);
  EXPECT_EQ(source->frame_count(), recording.frames);
  for (const StampRow& row : stamps) {
    const auto picture = source->Read(row.frame, {});
    ASSERT_TRUE(picture.has_value()) << row.frame;
    const auto wanted = came.find(row.picture);
    ASSERT_NE(wanted, came.end()) << row.picture;
    EXPECT_EQ(HashOf(picture->image_bgr), wanted->second.hash) << row.picture;
    EXPECT_EQ(row.time_s, ExactSeconds(wanted->second.taken_at));
  }
}

// Every number between the first and the last is in the video or among the losses, once.
void ExpectNoNumberMissing(const CameraRecording& recording) {
  std::map<std::uint64_t, std::string> numbers;
  for (const StampRow& row : testing::StampRowsOf(recording.timestamps))
    numbers[row.picture] = "in the video";
  ASSERT_FALSE(numbers.empty());
  const std::uint64_t first = numbers.begin()->first;
  for (const LossRow& row : testing::LossRowsOf(recording.video.parent_path() / "losses.csv"))
    for (std::uint64_t i = row.first; i <= row.last; ++i)
      EXPECT_TRUE(numbers.emplace(i, row.reason).second) << i << ": " << numbers[i] << " and " << row.reason;
  for (std::uint64_t i = first; i <= numbers.rbegin()->first; ++i) EXPECT_TRUE(numbers.contains(i)) << i;
}

TEST(FootageRecorder, HasEveryPictureAsItCameOrNamesIt) {
  const TestFolder folder;
  ServedRig served(DemoSets(), kRateHz);
  RigFile rig_file{FourCameraRig()};
  for (std::size_t i = 0; i < kCameras; ++i) rig_file.sources.push_back(served.SourcesOf(i));
  rig_file.sources[2].time_offset_s = 0.003;
  test_support::WriteText(folder.path() / "empty.png", "stands for a picture");
  rig_file.sources[0].background = folder.File("empty.png");

  FootageRecorder recorder(rig_file);
  Witness witness;
  FootageRecording recording;
  {
    LiveRig rig(rig_file, witness.Taps(recorder));
    recorder.Begin(folder.path() / "out");
    constexpr std::size_t kPictures = 15;
    witness.WaitFor(kPictures);
    served.SetPacketLoss(1, 0.01);
    witness.WaitFor(kPictures);
    recording = recorder.End();
  }
  EXPECT_THAT(recording.Troubles(), ::testing::IsEmpty());
  ASSERT_EQ(recording.cameras.size(), std::size_t{kCameras});
  std::uint64_t bytes = 0;
  for (CameraIndex i = 0; i < kCameras; ++i) {
    SCOPED_TRACE(recording.cameras[i].name);
    EXPECT_GT(recording.cameras[i].frames, 0);
    ExpectAsItCame(recording.cameras[i], rig_file.rig.cameras[i], witness.came(i));
    ExpectNoNumberMissing(recording.cameras[i]);
    bytes += recording.cameras[i].bytes;
  }
  EXPECT_GT(recording.cameras[1].lost, 0U);
  EXPECT_EQ(recording.bytes, bytes);

  // RIG.yml plays it, from wherever the folder is.
  const fs::path elsewhere = folder.path() / "elsewhere";
  fs::rename(folder.path() / "out", elsewhere);
  const RigFile played = ReadRigFile(elsewhere / "RIG.yml");
  EXPECT_EQ(played.rig.cameras.size(), std::size_t{kCameras});
  EXPECT_EQ(played.sources[2].time_offset_s, 0.003);
  for (const CameraSources& sources : played.sources) {
    EXPECT_TRUE(fs::exists(sources.frames));
    EXPECT_TRUE(fs::exists(sources.timestamps));
    EXPECT_TRUE(sources.frames.starts_with(elsewhere.string()));
  }
  EXPECT_TRUE(fs::exists(played.sources[0].background));
  EXPECT_TRUE(played.sources[0].background.starts_with(elsewhere.string()));
}

TEST(FootageRecorder, NeedsANewFolder) {
  const TestFolder folder;
  test_support::WriteText(folder.path() / "notes.txt", "mine");
  const auto begin = [&](const fs::path& into) {
    return ErrorOf(core::ErrorKind::kFile, [&] { FootageRecorder(RigFile()).Begin(into); });
  };
  EXPECT_THAT(begin(folder.path()), HasSubstr("there is something in it already; choose a new folder"));
  EXPECT_THAT(begin(folder.path() / "notes.txt"), HasSubstr("it is not a folder"));
}

}  // namespace
}  // namespace elbowroom::recon
