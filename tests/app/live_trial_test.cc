// A trial with live cameras: the demo's motion, served by four GigE Vision cameras, judged as its recording
// is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/frame_pipeline.h"
#include "app/control/trial_runner.h"
#include "recon/capture/live_rig.h"
#include "sessions/session_reader.h"
#include "tests/recon/capture/live_accounts.h"
#include "tests/recon/capture/own_network.h"
#include "tests/recon/capture/served_rig.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

using recon::testing::LiveAccounts;
using recon::testing::ServedRig;
using test_support::TemporaryFolder;

constexpr int kCameras = 4;
// The demo's own rate; slow enough for a machine that also renders, sends and judges.
constexpr double kRateHz = 15.0;
// In these the hand lowers the pipe between the payloads, and touches them.
constexpr core::FrameIndex kFirst = 60, kSets = 60;

const auto* const kNetwork = ::testing::AddGlobalTestEnvironment(new recon::testing::OwnNetwork(kCameras));

// The demo, some of its frame sets, and its empty scene.
struct Footage {
  TrialSetup setup = MakeDemoTrial(DemoPlay::kForever);
  std::vector<recon::FrameSet> sets;
  std::vector<recon::BackgroundReference> backgrounds;
};

Footage Render() {
  Footage footage;
  for (core::FrameIndex i = 0; i < kSets; ++i) footage.sets.push_back(footage.setup.source->Read(kFirst + i));
  footage.backgrounds = footage.setup.source->ReadBackgrounds({}, {});
  return footage;
}

// The rig with its live cameras, and pictures of the empty scene in `folder`.
recon::RigFile LiveRigFile(const Footage& footage, const ServedRig& served, const TemporaryFolder& folder) {
  recon::RigFile rig_file{footage.setup.source->rig()};
  for (std::size_t i = 0; i < kCameras; ++i) {
    cv::Mat mean;
    footage.backgrounds[i].mean_bgr.convertTo(mean, CV_8U);
    const std::filesystem::path background = folder / ("background" + std::to_string(i) + ".png");
    cv::imwrite(background.string(), mean);
    rig_file.sources.push_back(served.SourcesOf(i));
    rig_file.sources.back().background = background.string();
  }
  return rig_file;
}

// What was found of each part, as numbers that are equal for equal pictures.
std::vector<std::tuple<core::Verdict, std::int64_t, double>> FoundIn(const core::FrameRecord& record) {
  std::vector<std::tuple<core::Verdict, std::int64_t, double>> found;
  for (const core::PartContact& contact : record.contacts)
    found.emplace_back(contact.verdict, contact.contact_point_count, contact.contact_area_mm2);
  return found;
}

TEST(LiveTrial, FindsWhatTheRecordingFinds) {
  Footage footage = Render();
  const TemporaryFolder folder;
  ServedRig served(footage.sets, kRateHz);
  const recon::RigFile rig_file = LiveRigFile(footage, served, folder);
  TrialSetup setup = footage.setup;
  setup.source = std::make_shared<recon::LiveRig>(rig_file);
  // What the recording gives, set by set.
  FramePipeline recorded(footage.setup.source->rig(), footage.setup.layout,
                         setup.source->ReadBackgrounds({}, {}), footage.setup.segmentation);
  const std::vector<double> gaps = footage.setup.layout.InitialSpacings();
  std::vector<std::vector<std::tuple<core::Verdict, std::int64_t, double>>> expected;
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
  Footage footage = Render();
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
  setup.source = std::make_shared<recon::LiveRig>(LiveRigFile(footage, served, folder));
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
