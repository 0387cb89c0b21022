// Replays that segment the footage again that a live trial recorded beside its session.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "app/control/outcome_tracker.h"
#include "app/control/replay/replay.h"
#include "app/control/trial_runner.h"
#include "core/error.h"
#include "core/system/file_hash.h"
#include "recon/capture/live_rig.h"
#include "recon/recording/footage_recorder.h"
#include "sessions/archive/session_check.h"
#include "sessions/session_reader.h"
#include "tests/app/live_demo.h"
#include "tests/app/replay/session_rows.h"
#include "tests/recon/capture/own_network.h"
#include "tests/recon/capture/served_rig.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const auto* const kOwnNetwork = ::testing::AddGlobalTestEnvironment(new recon::testing::OwnNetwork(kCameras));

// A live trial whose cameras lose pictures, recorded once; each test has a copy.
class SegmentFootage : public testing::Test {
 protected:
  static constexpr core::FrameIndex kFrames = 30;
  static constexpr int kIgnoredColumns = 40;

  static void SetUpTestSuite() {
    recorded_ = new test_support::TemporaryFolder();
    const DemoFootage demo = RenderDemo();
    recon::testing::ServedRig served(demo.sets, kRateHz);
    const recon::RigFile rig_file = LiveRigFile(demo, served, recorded_->path());
    TrialSetup setup = demo.setup;
    const core::CameraModel& camera = rig_file.rig.cameras[0];
    core::BitMask edge(camera.width_px(), camera.height_px());
    for (int x = 0; x < kIgnoredColumns; ++x)
      for (int y = 0; y < camera.height_px(); ++y) edge.Set(x, y, true);
    setup.segmentation.cameras.push_back({camera.name(), std::nullopt, std::nullopt, edge});
    // Its encoders give way to all else: on a busy machine many pictures wait for them.
    recon::FootageRecorderOptions recording;
    recording.most_waiting_bytes = std::uint64_t{1} << 30U;
    setup.footage = std::make_shared<recon::FootageRecorder>(rig_file, recording);
    setup.source = std::make_shared<recon::LiveRig>(rig_file, setup.footage->Taps());
    TrialOptions options;
    options.session = *recorded_ / "s.db";
    options.frames.end = kFrames;
    options.on_frame = [&](const SharedFrameResult& result, const RecordedFrames&) {
      if (result->record.frame == kFrames / 3) served.Switch(1, false);
      if (result->record.frame == 2 * kFrames / 3) served.Switch(1, true);
    };
    TrialControls controls;
    outcome_ = new TrialOutcome(RunTrial(setup, options, controls, {}));
  }
  static void TearDownTestSuite() {
    delete outcome_;
    delete recorded_;
  }

  void SetUp() override {
    fs::copy(recorded_->path(), folder_.path(),
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    for (const recon::CameraRecording& camera : outcome_->footage->cameras) ASSERT_EQ(camera.unwritten, 0U);
  }

  [[nodiscard]] fs::path Session(const std::string& name) const { return folder_ / (name + ".db"); }
  [[nodiscard]] fs::path Footage(const std::string& file) const { return folder_ / "s.footage" / file; }
  [[nodiscard]] std::string CameraFolder(core::CameraIndex camera) const {
    return sessions::SessionReader(Session("s")).header().rig.cameras[camera].name();
  }
  [[nodiscard]] fs::path SettingsFile(const std::string& more) const {
    const fs::path file = folder_ / "settings.toml";
    const core::CameraModel camera = sessions::SessionReader(Session("s")).header().rig.cameras[0];
    cv::Mat picture(camera.height_px(), camera.width_px(), CV_8U, cv::Scalar(0));
    picture.colRange(0, kIgnoredColumns).setTo(255);
    cv::imwrite((folder_ / "edge.png").string(), picture);
    test_support::WriteText(file, fmt::format("[segmentation]\n{}\n[[segmentation.camera]]\nname = \"{}\"\n"
                                              "ignore = \"edge.png\"\n",
                                              more, camera.name()));
    return file;
  }
  [[nodiscard]] ReplayOutcome Segmented(const std::string& recorded, const fs::path& session,
                                        const SegmentingOptions& segmenting = {},
                                        FrameRange frames = {}) const {
    const sessions::SessionReader reader = OpenWithOutcome(Session(recorded), {}, {});
    return RunReplay(reader, {session, {}, frames, segmenting}, {}, {});
  }
  [[nodiscard]] std::string ErrorOf(const std::string& recorded,
                                    const SegmentingOptions& segmenting = {}) const {
    try {
      (void)Segmented(recorded, Session("new"), segmenting);
    } catch (const core::Error& error) {
      EXPECT_FALSE(fs::exists(Session("new")));
      return error.what();
    }
    return "no error";
  }
  // The first frame from that one on in which this camera has a picture, and others have, too: on a busy
  // machine pictures are lost.
  [[nodiscard]] core::FrameIndex FrameOf(core::CameraIndex camera, core::FrameIndex from) const {
    const sessions::SessionReader session(Session("s"));
    const auto has_it_and_others = [&](core::FrameIndex frame) {
      const auto stamps = session.ReadFrame(frame).stamps;
      return stamps[camera] && std::ranges::count_if(stamps, [](const auto& stamp) { return !!stamp; }) > 1;
    };
    while (!has_it_and_others(from)) ++from;
    return from;
  }
  // The camera's first picture that was judged in that frame or later.
  [[nodiscard]] std::uint64_t FirstPictureFrom(core::CameraIndex camera, core::FrameIndex frame) const {
    const sessions::SessionReader session(Session("s"));
    for (; frame < kFrames; ++frame)
      if (const auto stamp = session.ReadFrame(frame).stamps[camera]) return stamp->picture;
    return std::numeric_limits<std::uint64_t>::max();
  }
  // So that the session takes the file as it is now for the recorded one.
  void Accept(const fs::path& file) const {
    SQLite::Database database(Session("s").string(), SQLite::OPEN_READWRITE);
    SQLite::Statement update(database, "UPDATE footage SET bytes = ?, content_hash = ? WHERE file = ?");
    const auto hash = core::HashOfFile(file);
    update.bind(1, static_cast<std::int64_t>(fs::file_size(file)));
    update.bind(2, hash.data(), static_cast<int>(hash.size()));
    update.bind(3, file.lexically_relative(folder_.path()).string());
    ASSERT_EQ(update.exec(), 1);
  }
  // The table of stamps of a camera without the lines that `drop` is true for.
  void DropStamps(core::CameraIndex camera, const std::function<bool(std::uint64_t picture)>& drop) const {
    const fs::path file = Footage(CameraFolder(camera)) / "stamps.csv";
    std::ifstream table(file);
    std::string line, kept;
    std::getline(table, line);
    kept = line + "\n";
    while (std::getline(table, line))
      if (!drop(std::stoull(line.substr(line.rfind(',') + 1)))) kept += line + "\n";
    test_support::WriteText(file, kept);
    Accept(file);
  }

  static test_support::TemporaryFolder* recorded_;
  static TrialOutcome* outcome_;
  test_support::TemporaryFolder folder_;
};

test_support::TemporaryFolder* SegmentFootage::recorded_ = nullptr;
TrialOutcome* SegmentFootage::outcome_ = nullptr;

// Frame sets are those that were judged, with those that lack a camera.
TEST_F(SegmentFootage, WithTheRecordedSettingsIsTheLiveTrial) {
  EXPECT_GT(outcome_->frames_without_camera, 0);
  const ReplayOutcome outcome = Segmented("s", Session("again"));
  EXPECT_THAT(outcome.changes, IsEmpty());
  EXPECT_THAT(outcome.segmented->warnings, IsEmpty());
  ASSERT_TRUE(outcome.compared.has_value());
  EXPECT_EQ(outcome.compared->frames_that_differ, 0);
  EXPECT_EQ(outcome.frames, kFrames);
  EXPECT_EQ(outcome.segmented->count.missing, 0);
  EXPECT_EQ(outcome.segmented->count.silhouettes_that_differ, 0);
  EXPECT_LT(outcome.segmented->count.pictures, kCameras * kFrames);
  EXPECT_GT(outcome.contact_rows, 0);
  EXPECT_EQ(RowsThatDiffer(Session("s"), Session("again")), 0);
  const ReplayOutcome part = Segmented("s", Session("part"), {}, {12, 22});
  EXPECT_EQ(part.compared->frames_that_differ, 0);
}

TEST_F(SegmentFootage, MayBeNamedFromItsOwnFolder) {
  const fs::path here = fs::current_path();
  fs::current_path(folder_.path());
  const sessions::SessionReader reader = OpenWithOutcome("s.db", {}, {});
  const ReplayOutcome outcome = RunReplay(reader, {"again.db", {}, {0, 4}, SegmentingOptions()}, {}, {});
  fs::current_path(here);
  EXPECT_EQ(outcome.compared->frames_that_differ, 0);
  EXPECT_EQ(outcome.segmented->footage, Footage("RIG.yml"));
  EXPECT_THAT(outcome.segmented->warnings, IsEmpty());
  EXPECT_EQ(sessions::SessionReader(Session("again")).footage().front().file, "s.footage/RIG.yml");
}

// There and back: the thresholds that were right give the trial's own rows.
TEST_F(SegmentFootage, OtherThresholdsAndBackIsTheLiveTrial) {
  const ReplayOutcome wrong =
      Segmented("s", Session("wrong"), {SettingsFile("floor_levels = 90\nk_sigma = 9"), ""});
  EXPECT_EQ(wrong.changes.size(), 2U);
  EXPECT_GT(wrong.segmented->count.silhouettes_that_differ, 0);
  ASSERT_GT(RowsThatDiffer(Session("s"), Session("wrong")), 0);
  const ReplayOutcome right = Segmented("wrong", Session("right"), {SettingsFile(""), ""});
  EXPECT_EQ(right.changes.size(), 2U);
  EXPECT_EQ(RowsThatDiffer(Session("s"), Session("right")), 0);
}

TEST_F(SegmentFootage, GoesAlongWithASessionInAnotherFolder) {
  fs::create_directories(folder_ / "new" / "deep");
  (void)Segmented("s", folder_ / "new" / "deep" / "again.db");
  const sessions::SessionCheck check = sessions::CheckSession(folder_ / "new" / "deep" / "again.db", {}, {});
  EXPECT_TRUE(check.is_sound()) << check.problems.front();
  EXPECT_GT(check.footage_files, kCameras);
}

TEST_F(SegmentFootage, AnotherBackgroundIsAChangeThatMustBeGivenAgain) {
  recon::RigFile rig = recon::ReadRigFile(Footage("RIG.yml"));
  for (recon::CameraSources& sources : rig.sources) sources.frames = sources.timestamps = "";
  recon::WriteRigFile(rig, folder_ / "same.yml");
  EXPECT_THAT(Segmented("s", Session("same"), {"", folder_ / "same.yml"}).changes, IsEmpty());
  cv::Mat brighter = cv::imread(rig.sources[1].background);
  brighter += cv::Scalar::all(30);
  cv::imwrite((folder_ / "brighter.png").string(), brighter);
  rig.sources[1].background = (folder_ / "brighter.png").string();
  recon::WriteRigFile(rig, folder_ / "other.yml");
  const ReplayOutcome outcome = Segmented("s", Session("other"), {"", folder_ / "other.yml"});
  ASSERT_EQ(outcome.changes.size(), 1U);
  EXPECT_THAT(outcome.changes[0], AllOf(HasSubstr(CameraFolder(1)), HasSubstr("brighter.png")));
  EXPECT_GT(outcome.segmented->count.silhouettes_that_differ, 0);
  EXPECT_THAT(ErrorOf("other"), AllOf(HasSubstr("other.yml"), HasSubstr("--rig")));
  const ReplayOutcome again = Segmented("other", Session("again"), {"", folder_ / "other.yml"});
  EXPECT_THAT(again.changes, IsEmpty());
  EXPECT_EQ(again.compared->frames_that_differ, 0);
  const ReplayOutcome back = Segmented("other", Session("back"), {"", folder_ / "same.yml"});
  EXPECT_EQ(back.changes.size(), 1U);
  EXPECT_EQ(RowsThatDiffer(Session("s"), Session("back")), 0);
  for (recon::CameraSources& sources : rig.sources) sources.background = "";
  recon::WriteRigFile(rig, folder_ / "none.yml");
  EXPECT_THAT(ErrorOf("s", {"", folder_ / "none.yml"}), HasSubstr("names no background"));
}

TEST_F(SegmentFootage, MissingOrChangedFootageIsOneLine) {
  const fs::path video = Footage(CameraFolder(2)) / "video.avi";
  fs::rename(video, folder_ / "elsewhere.avi");
  EXPECT_THAT(ErrorOf("s"), AllOf(HasSubstr("video.avi"), HasSubstr("isn't there; put it back"),
                                  HasSubstr("without --segment"), Not(HasSubstr("\n"))));
  fs::rename(folder_ / "elsewhere.avi", video);
  {
    std::fstream file(video, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(fs::file_size(video) / 2));
    file.put('!').put('?').put('!');
  }
  EXPECT_THAT(ErrorOf("s"), AllOf(HasSubstr("video.avi"), HasSubstr("isn't the one that was recorded")));
  fs::resize_file(video, fs::file_size(video) / 2);
  EXPECT_THAT(ErrorOf("s"), AllOf(HasSubstr("video.avi"), HasSubstr("isn't the one that was recorded")));
  fs::remove_all(folder_ / "s.footage");
  EXPECT_THAT(ErrorOf("s"), AllOf(HasSubstr("RIG.yml"), HasSubstr("isn't there")));
}

// What the disk was too slow for.
TEST_F(SegmentFootage, APictureThatWasNotWrittenIsMissingInItsFrame) {
  const core::FrameIndex frame = FrameOf(0, 5);
  const std::uint64_t unwritten = FirstPictureFrom(0, frame);
  DropStamps(0, [&](std::uint64_t picture) { return picture == unwritten; });
  const ReplayOutcome outcome = Segmented("s", Session("again"));
  EXPECT_EQ(outcome.segmented->count.missing, 1);
  EXPECT_EQ(outcome.segmented->count.silhouettes_that_differ, 1);
  const sessions::SessionReader again(Session("again"));
  const sessions::SessionReader recorded(Session("s"));
  for (core::FrameIndex i = 0; i < kFrames; ++i) {
    for (core::CameraIndex camera = 0; camera < kCameras; ++camera) {
      const bool was_there = recorded.ReadFrame(i).stamps[camera].has_value();
      const bool is_there = was_there && !(i == frame && camera == 0);
      EXPECT_EQ(again.ReadFrame(i).stamps[camera].has_value(), is_there) << i << ", " << camera;
    }
  }
  std::vector<std::string> notes;
  for (const core::SessionEvent& event : again.events())
    if (const auto* note = std::get_if<core::Note>(&event.what)) notes.push_back(note->text);
  EXPECT_THAT(notes, Contains(HasSubstr("1 pictures that were judged aren't in the footage")));
}

TEST_F(SegmentFootage, FootageThatEndsEarlyIsOneLine) {
  constexpr core::FrameIndex kEnd = 8;
  for (core::CameraIndex i = 0; i < kCameras; ++i) {
    const std::uint64_t first = FirstPictureFrom(i, kEnd);
    DropStamps(i, [&](std::uint64_t picture) { return picture >= first; });
  }
  EXPECT_THAT(ErrorOf("s"),
              AllOf(HasSubstr("none of its pictures is in the footage"), HasSubstr("--frames")));
  EXPECT_EQ(Segmented("s", Session("part"), {}, {0, kEnd}).frames, kEnd);
}

}  // namespace
}  // namespace elbowroom::control
