// A live trial that keeps its footage: played again, it is the same pictures with the same stamps, and gives
// the same contacts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <memory>
#include <set>
#include <stop_token>

#include "app/control/cameras/camera_recording.h"
#include "app/control/trial_runner.h"
#include "core/error.h"
#include "recon/capture/live_rig.h"
#include "recon/footage/recorded_rig.h"
#include "sessions/archive/session_check.h"
#include "tests/app/live_demo.h"
#include "tests/recon/capture/served_rig.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using recon::testing::ServedRig;
using test_support::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Which picture of each camera a frame is made of.
using PictureNumbers = std::vector<std::uint64_t>;
std::optional<PictureNumbers> NumbersIn(const recon::FrameSet& set) {
  PictureNumbers numbers;
  for (const recon::CameraFrame& frame : set.cameras) {
    if (!frame.stamp) return std::nullopt;
    numbers.push_back(frame.stamp->picture);
  }
  return numbers;
}

// What a trial found in the frames that have all cameras, by their pictures, with the stamps relative to the
// first camera's.
struct Judged {
  Found found;
  std::vector<double> stamps_s;
  std::vector<cv::Mat> pictures;
};
std::map<PictureNumbers, Judged> JudgedIn(const TrialSetup& setup, const TrialOptions& asked,
                                          TrialOutcome* outcome, std::size_t* losses = nullptr) {
  std::map<PictureNumbers, Judged> judged;
  TrialOptions options = asked;
  options.on_frame = [&](const SharedFrameResult& result, const RecordedFrames&) {
    if (losses != nullptr) *losses += result->record.losses.size();
    const auto numbers = NumbersIn(*result->camera_frames);
    if (!numbers) return;
    Judged& frame = judged[*numbers];
    frame.found = FoundIn(result->record);
    for (const recon::CameraFrame& camera : result->camera_frames->cameras) {
      frame.stamps_s.push_back(camera.stamp->time_s - result->camera_frames->cameras[0].stamp->time_s);
      frame.pictures.push_back(camera.image_bgr.clone());
    }
  };
  TrialControls controls;
  *outcome = RunTrial(setup, options, controls, {});
  return judged;
}

TEST(RecordedTrial, GivesWhatTheLiveTrialGave) {
  const DemoFootage demo = RenderDemo();
  const TemporaryFolder folder;
  ServedRig served(demo.sets, kRateHz);
  const recon::RigFile rig_file = LiveRigFile(demo, served, folder.path());
  TrialSetup setup = demo.setup;
  setup.info.required_clearance_mm = 0.0;  // contacts only
  setup.footage = std::make_shared<recon::FootageRecorder>(rig_file);
  setup.source = std::make_shared<recon::LiveRig>(rig_file, setup.footage->Taps());
  TrialOptions options;
  options.session = folder / "live.db";
  options.frames.end = kSets;
  TrialOutcome live_outcome;
  std::size_t losses = 0;
  const std::map<PictureNumbers, Judged> live = JudgedIn(setup, options, &live_outcome, &losses);
  ASSERT_TRUE(live_outcome.footage.has_value());
  EXPECT_THAT(live_outcome.footage->Troubles(), IsEmpty());
  ASSERT_EQ(live_outcome.footage->rig_file, folder / "live.footage" / "RIG.yml");
  const sessions::SessionCheck check = sessions::CheckSession(folder / "live.db", {}, {});
  EXPECT_TRUE(check.is_sound()) << check.problems.front();
  EXPECT_GT(check.footage_files, static_cast<std::int64_t>(rig_file.rig.cameras.size()));
  EXPECT_EQ(sessions::SessionReader(folder / "live.db").footage().front().file, "live.footage/RIG.yml");

  setup.footage.reset();
  setup.source = std::make_shared<recon::RecordedRig>(recon::ReadRigFile(live_outcome.footage->rig_file));
  TrialOptions again;
  again.session = folder / "again.db";
  TrialOutcome outcome;
  const std::map<PictureNumbers, Judged> played = JudgedIn(setup, again, &outcome);
  EXPECT_FALSE(outcome.footage.has_value());
  constexpr double kRoundedS = 1e-9;  // a table of stamps has whole nanoseconds
  std::size_t compared = 0, contacts = 0;
  for (const auto& [numbers, frame] : live) {
    const auto same = played.find(numbers);
    if (same == played.end()) continue;  // a picture of it wasn't written
    ++compared;
    EXPECT_EQ(same->second.found, frame.found);
    for (std::size_t i = 0; i < kCameras; ++i) {
      EXPECT_EQ(cv::norm(same->second.pictures[i], frame.pictures[i], cv::NORM_INF), 0.0);
      EXPECT_NEAR(same->second.stamps_s[i], frame.stamps_s[i], kRoundedS);
    }
    for (const auto& part : frame.found) contacts += std::get<0>(part) == core::Verdict::kContact ? 1U : 0U;
  }
  EXPECT_GT(compared, 0U);
  EXPECT_GT(contacts, 0U);
  // Where a picture came too late for its live set, as on a busy machine, another camera may have led from
  // then on, and sets were made of other pictures than the recording's.
  if (losses > 0) return;
  // Else only what wasn't written, or is at the edge of the recording, is in the live trial alone.
  std::uint64_t unwritten = 0;
  for (const recon::CameraRecording& camera : live_outcome.footage->cameras) unwritten += camera.unwritten;
  constexpr std::uint64_t kEdges = 2;
  EXPECT_LE(live.size() - compared, unwritten + kEdges);
}

TEST(RecordedTrial, NeedsAnEmptyFolderBesideTheSession) {
  const DemoFootage demo;
  const TemporaryFolder folder;
  TrialSetup setup = demo.setup;
  setup.footage = std::make_shared<recon::FootageRecorder>(recon::RigFile());
  test_support::WriteText(folder / "s.footage/notes.txt", "mine");
  TrialOptions options;
  options.session = folder / "s.db";
  TrialControls controls;
  try {
    (void)RunTrial(setup, options, controls, {});
    FAIL() << "it ran";
  } catch (const core::Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("s.footage: there is something in it already"));
  }
  EXPECT_FALSE(std::filesystem::exists(options.session));
}

TEST(RecordCameras, AStopEndsTheRecordingInOrder) {
  const DemoFootage demo = RenderDemo();
  const TemporaryFolder folder;
  ServedRig served(demo.sets, kRateHz);
  const recon::RigFile rig_file = LiveRigFile(demo, served, folder.path());
  std::stop_source stop;
  const core::Progress progress([&](std::int64_t done, std::int64_t, const std::string&) {
    if (done >= 1) stop.request_stop();
  });
  const CamerasRecorded recorded =
      RecordCameras(rig_file, folder / "out", std::nullopt, progress, stop.get_token());
  EXPECT_FALSE(recorded.ended_early);
  EXPECT_THAT(recorded.warnings, IsEmpty());
  recon::RecordedRig rig(recon::ReadRigFile(recorded.footage.rig_file));
  ASSERT_GT(rig.frame_count().value(), 0);
  for (const recon::CameraRecording& camera : recorded.footage.cameras) EXPECT_GT(camera.frames, 0);
  EXPECT_EQ(rig.ReadBackgrounds({}, {}).size(), std::size_t{kCameras});
}

TEST(RecordCameras, TakesLiveRigsOnly) {
  const TemporaryFolder folder;
  try {
    (void)RecordCameras(recon::RigFile(), folder / "out", 1.0, {}, {});
    FAIL() << "it recorded";
  } catch (const core::Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("has no live cameras"));
  }
}

}  // namespace
}  // namespace elbowroom::control
