// A trial with live cameras: the demo's motion, served by four GigE Vision cameras, judged as its recording
// is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/frame_pipeline.h"
#include "app/control/trial_runner.h"
#include "recon/capture/live_rig.h"
#include "sessions/session_reader.h"
#include "tests/app/live_demo.h"
#include "tests/recon/capture/live_accounts.h"
#include "tests/recon/capture/own_network.h"
#include "tests/recon/capture/served_rig.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

using recon::testing::LiveAccounts;
using recon::testing::ServedRig;
using test_support::TemporaryFolder;

const auto* const kNetwork = ::testing::AddGlobalTestEnvironment(new recon::testing::OwnNetwork(kCameras));

TEST(LiveTrial, FindsWhatTheRecordingFinds) {
  DemoFootage footage = RenderDemo();
  const TemporaryFolder folder;
  ServedRig served(footage.sets, kRateHz);
  const recon::RigFile rig_file = LiveRigFile(footage, served, folder.path());
  TrialSetup setup = footage.setup;
  setup.source = std::make_shared<recon::LiveRig>(rig_file);
  // What the recording gives, set by set.
  FramePipeline recorded(footage.setup.source->rig(), footage.setup.layout,
                         setup.source->ReadBackgrounds({}, {}), footage.setup.segmentation);
  const std::vector<double> gaps = footage.setup.layout.InitialSpacings();
  std::vector<Found> expected;
  bool has_contact = false;
  for (const recon::FrameSet& set : footage.sets) {
    const SharedFrameResult result = recorded.Process(set, gaps);
    expected.push_back(FoundIn(result->record));
    for (const core::PartContact& contact : result->record.contacts)
      has_contact = has_contact || contact.verdict == core::Verdict::kContact;
  }
  ASSERT_TRUE(has_contact);

  setup.info.required_clearance_mm = 0.0;  // contacts only, as above
  LiveAccounts accounts(kCameras);
  int compared = 0, contacts = 0;
  std::int64_t incomplete = 0;
  TrialOptions options;
  options.session = folder / "live.db";
  options.frames.end = 2 * kSets;
  options.on_frame = [&](const SharedFrameResult& result, const RecordedFrames&) {
    const recon::FrameSet& frames = *result->camera_frames;
    accounts.Add(frames);
    if (result->record.LacksCamera()) {
      ++incomplete;
      return;
    }
    ++compared;
    const auto& wanted = expected.at(served.SetAt(frames.taken_at.value()));
    const auto found = FoundIn(result->record);
    EXPECT_EQ(found, wanted) << "live frame " << frames.index;
    for (const auto& part : found) contacts += std::get<0>(part) == core::Verdict::kContact ? 1 : 0;
    if (frames.index == kSets / 2) served.SetPacketLoss(1, 0.002);
  };
  TrialControls controls;
  const TrialOutcome outcome = RunTrial(setup, options, controls, {});
  accounts.ExpectWhole();
  EXPECT_EQ(outcome.frames, 2 * kSets);
  EXPECT_EQ(outcome.frames_without_camera, incomplete);
  EXPECT_GT(contacts, 0);
  EXPECT_GT(compared, kSets / 2);
  EXPECT_TRUE(outcome.latencies.MedianMs().has_value());
  std::int64_t lost = 0;
  for (const std::int64_t of_camera : outcome.pictures_lost) lost += of_camera;
  EXPECT_GT(lost, 0);  // packets were lost on purpose
  // The session names them.
  std::int64_t named = 0;
  const sessions::SessionReader session(outcome.session);
  for (const core::SessionEvent& event : session.events()) {
    const auto* note = std::get_if<core::Note>(&event.what);
    if (note != nullptr && note->text.find("lost (incomplete)") != std::string::npos) ++named;
  }
  EXPECT_GT(named, 0);
}

TEST(LiveTrial, LightThatChangedIsANoteOfTheSession) {
  DemoFootage footage = RenderDemo();
  const TemporaryFolder folder;
  constexpr double kBrighter = 1.2;
  std::vector<recon::FrameSet> brighter = footage.sets;
  for (recon::FrameSet& set : brighter) {
    for (recon::CameraFrame& frame : set.cameras) {
      cv::Mat lit;
      frame.image_bgr.convertTo(lit, CV_8U, kBrighter);
      frame.image_bgr = lit;
    }
  }
  const ServedRig served(std::move(brighter), kRateHz);
  TrialSetup setup = footage.setup;
  setup.source = std::make_shared<recon::LiveRig>(LiveRigFile(footage, served, folder.path()));
  std::atomic<int> reports = 0;
  TrialOptions options;
  options.session = folder / "light.db";
  options.frames.end = kSets;
  options.on_light = [&](const recon::LightReport&) { ++reports; };
  TrialControls controls;
  const TrialOutcome outcome = RunTrial(setup, options, controls, {});
  ASSERT_EQ(outcome.light.size(), static_cast<std::size_t>(kCameras));
  constexpr double kGainTolerance = 0.03;  // the scene flickers by 1 %, and two seconds may be few frames
  for (const recon::LightReport& light : outcome.light) EXPECT_NEAR(light.gain, kBrighter, kGainTolerance);
  EXPECT_EQ(outcome.light_advice.size(), static_cast<std::size_t>(kCameras));
  EXPECT_GE(reports, kCameras);
  std::vector<std::string> notes;
  const sessions::SessionReader session(outcome.session);
  for (const core::SessionEvent& event : session.events())
    if (const auto* note = std::get_if<core::Note>(&event.what)) notes.push_back(note->text);
  for (const std::string& advice : outcome.light_advice) {
    EXPECT_THAT(advice, ::testing::HasSubstr("brighter than when the background was taken"));
    EXPECT_EQ(std::ranges::count(notes, advice), 1) << advice;
  }
}

}  // namespace
}  // namespace elbowroom::control
