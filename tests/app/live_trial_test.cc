// A trial with live cameras: the demo's motion, served by four GigE Vision cameras, judged as its recording
// is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <utility>
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

// Which of the served sets each camera's picture is of, told by its pixels: where the machine is busy, the
// pictures' times may be a period off, and so may a set be put together of two.
std::vector<std::size_t> SetsOf(const recon::FrameSet& frames, const std::vector<recon::FrameSet>& served) {
  std::vector<std::size_t> sets;
  for (std::size_t i = 0; i < frames.cameras.size(); ++i) {
    const cv::Mat& picture = frames.cameras[i].image_bgr;
    const auto found = std::ranges::find_if(served, [&](const recon::FrameSet& set) {
      return cv::norm(set.cameras[i].image_bgr, picture, cv::NORM_INF) == 0.0;
    });
    EXPECT_NE(found, served.end()) << "camera " << i << " of frame " << frames.index;
    if (found == served.end()) return {};
    sets.push_back(static_cast<std::size_t>(found - served.begin()));
  }
  return sets;
}

// What the recording of the served pictures gives, set by set.
class RecordedAnswers {
 public:
  RecordedAnswers(const DemoFootage& footage, std::vector<recon::BackgroundReference> backgrounds)
      : footage_(footage),
        pipeline_(footage.setup.source->rig(), footage.setup.layout, backgrounds, footage.setup.segmentation),
        gaps_mm_(footage.setup.layout.InitialSpacings()) {}

  const Found& Of(const std::vector<std::size_t>& set_of_camera) {
    const auto [answer, is_new] = answers_.try_emplace(set_of_camera);
    if (!is_new) return answer->second;
    recon::FrameSet frames = footage_.sets.at(set_of_camera.front());
    for (std::size_t i = 0; i < set_of_camera.size(); ++i)
      frames.cameras[i] = footage_.sets.at(set_of_camera[i]).cameras[i];
    return answer->second = FoundIn(pipeline_.Process(std::move(frames), gaps_mm_)->record);
  }

 private:
  const DemoFootage& footage_;
  FramePipeline pipeline_;
  std::vector<double> gaps_mm_;
  std::map<std::vector<std::size_t>, Found> answers_;
};

TEST(LiveTrial, FindsWhatTheRecordingFinds) {
  DemoFootage footage = RenderDemo();
  const TemporaryFolder folder;
  ServedRig served(footage.sets, kRateHz);
  const recon::RigFile rig_file = LiveRigFile(footage, served, folder.path());
  TrialSetup setup = footage.setup;
  setup.source = std::make_shared<recon::LiveRig>(rig_file);
  RecordedAnswers recorded(footage, setup.source->ReadBackgrounds({}, {}));
  bool has_contact = false;
  for (std::size_t set = 0; set < footage.sets.size(); ++set)
    for (const auto& part : recorded.Of(std::vector(kCameras, set)))
      has_contact = has_contact || std::get<0>(part) == core::Verdict::kContact;
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
    if (frames.index == kSets / 2) served.SetPacketLoss(1, 0.002);
    if (result->record.LacksCamera()) {
      ++incomplete;
      return;
    }
    ++compared;
    const std::vector<std::size_t> sets = SetsOf(frames, footage.sets);
    if (sets.empty()) return;
    const Found found = FoundIn(result->record);
    EXPECT_EQ(found, recorded.Of(sets)) << "live frame " << frames.index;
    for (const auto& part : found) contacts += std::get<0>(part) == core::Verdict::kContact ? 1 : 0;
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
  const DemoFootage footage = RenderDemo();
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
