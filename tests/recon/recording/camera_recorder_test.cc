#include "recon/recording/camera_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <set>

#include "recon/footage/image_source.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/recon/recording/recorded_tables.h"

namespace elbowroom::recon {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kHeightPx;
using testing::kWidthPx;
using testing::LossRow;
using testing::LossRowsOf;
using testing::NumberedPicture;
using testing::NumberIn;
using testing::StampRow;
using testing::StampRowsOf;
using testing::TestFolder;

CapturedPicture PictureAt(std::uint64_t number, std::chrono::nanoseconds at) {
  const CaptureClock::time_point taken_at{at};
  return {NumberedPicture(static_cast<int>(number % 256)), number, taken_at, taken_at, StampSource::kDevice};
}

CameraRecorderOptions OptionsIn(const TestFolder& folder) {
  CameraRecorderOptions options;
  options.name = "cam1";
  options.folder = folder.path();
  options.size_px = {kWidthPx, kHeightPx};
  return options;
}

TEST(CameraRecorder, WritesPicturesStampsAndLosses) {
  const TestFolder folder;
  CameraRecorder recorder(OptionsIn(folder));
  using std::chrono::nanoseconds;
  recorder.Add(PictureAt(7, nanoseconds(5'000'000'001)));
  recorder.AddLoss({0, 8, 9, core::LossReason::kIncomplete});
  recorder.Add(PictureAt(10, nanoseconds(5'100'000'000)));
  recorder.Add(PictureAt(11, nanoseconds(5'100'000'000)));  // no later
  recorder.AddLoss({0, 12, 12, core::LossReason::kNotSent});
  recorder.AddLoss({0, 13, 14, core::LossReason::kNotSent});
  recorder.Close();
  recorder.Add(PictureAt(15, nanoseconds(6'000'000'000)));
  const CameraRecording recording = recorder.Finish();
  EXPECT_EQ(recording.trouble, "");
  EXPECT_EQ(recording.frames, 2);
  EXPECT_EQ(recording.lost, 5U);
  EXPECT_EQ(recording.unwritten, 1U);
  EXPECT_THAT(recording.missing,
              ElementsAre(MissingPictures{8, 9, "incomplete"}, MissingPictures{11, 11, kStampGoesBack},
                          MissingPictures{12, 14, "not sent"}));
  const std::vector<StampRow> stamps = StampRowsOf(recording.timestamps);
  ASSERT_EQ(stamps.size(), 2U);
  EXPECT_EQ(stamps[0].time_s, "5.000000001");
  EXPECT_EQ(stamps[0].picture, 7U);
  EXPECT_EQ(stamps[1].time_s, "5.100000000");
  EXPECT_EQ(stamps[1].frame, 1);
  EXPECT_EQ(LossRowsOf(folder.path() / "losses.csv").size(), 3U);
  const auto source = OpenImageSource(recording.video.string(), testing::PlainCamera("cam1"), {});
  EXPECT_EQ(NumberIn(source->Read(1, {})->image_bgr), 10);
}

// The encoder's program has hardly started when all pictures have come.
TEST(CameraRecorder, NamesEachPictureThatItIsTooSlowFor) {
  const TestFolder folder;
  CameraRecorderOptions options = OptionsIn(folder);
  options.most_waiting = 1;
  CameraRecorder recorder(options);
  constexpr std::uint64_t kPictures = 2000;
  const CapturedPicture first = PictureAt(0, std::chrono::nanoseconds(1));
  for (std::uint64_t i = 0; i < kPictures; ++i) {
    CapturedPicture picture = first;
    picture.number = i;
    picture.taken_at += std::chrono::milliseconds(i);
    recorder.Add(picture);
  }
  recorder.Close();
  const CameraRecording recording = recorder.Finish();
  EXPECT_EQ(recording.trouble, "");
  EXPECT_GT(recording.frames, 0);
  EXPECT_GT(recording.unwritten, 0U);
  EXPECT_EQ(static_cast<std::uint64_t>(recording.frames) + recording.unwritten, kPictures);
  std::set<std::uint64_t> numbers;
  for (const StampRow& row : StampRowsOf(recording.timestamps)) numbers.insert(row.picture);
  EXPECT_EQ(numbers.size(), static_cast<std::size_t>(recording.frames));
  for (const LossRow& row : LossRowsOf(folder.path() / "losses.csv")) {
    EXPECT_EQ(row.reason, "not written");
    for (std::uint64_t i = row.first; i <= row.last; ++i) EXPECT_TRUE(numbers.insert(i).second) << i;
  }
  EXPECT_EQ(numbers.size(), kPictures);
}

TEST(CameraRecorder, EndsInOrderWhileThereIsRoomOnTheDisk) {
  const TestFolder folder;
  CameraRecorderOptions options = OptionsIn(folder);
  options.least_free_bytes = std::numeric_limits<std::uint64_t>::max();
  CameraRecorder recorder(options);
  recorder.Add(PictureAt(1, std::chrono::nanoseconds(1)));
  recorder.Add(PictureAt(2, std::chrono::nanoseconds(2)));
  recorder.Close();
  const CameraRecording recording = recorder.Finish();
  EXPECT_TRUE(recorder.has_ended());
  EXPECT_THAT(recording.trouble, HasSubstr("camera 'cam1': the disk is full but for"));
  EXPECT_EQ(recording.unwritten, 2U);
  EXPECT_THAT(recording.missing, ElementsAre(MissingPictures{1, 2, kNotWritten}));
  EXPECT_EQ(recording.video, "");
}

// A file that isn't whole doesn't have the name of one.
TEST(CameraRecorder, AVideoThatFailsIsPlainlyIncomplete) {
  const TestFolder folder;
  fs::create_symlink("/dev/full", folder.path() / "video.avi.part");
  CameraRecorder recorder(OptionsIn(folder));
  for (int i = 0; i < 10; ++i)
    recorder.Add(PictureAt(static_cast<std::uint64_t>(i), std::chrono::nanoseconds(i + 1)));
  recorder.Close();
  const CameraRecording recording = recorder.Finish();
  EXPECT_TRUE(recorder.has_ended());
  EXPECT_THAT(recording.trouble, HasSubstr("the disk is full"));
  EXPECT_EQ(recording.frames, 0);
  EXPECT_EQ(recording.unwritten, 10U);
  EXPECT_THAT(recording.missing, ElementsAre(MissingPictures{0, 9, kNotWritten}));
  EXPECT_FALSE(fs::exists(folder.path() / "video.avi"));
  EXPECT_FALSE(fs::exists(folder.path() / "stamps.csv"));
}

TEST(CameraRecorder, SaysThatNoPictureCame) {
  const TestFolder folder;
  CameraRecorder recorder(OptionsIn(folder));
  recorder.Close();
  EXPECT_THAT(recorder.Finish().trouble, HasSubstr("camera 'cam1': no picture came"));
}

}  // namespace
}  // namespace elbowroom::recon
