#include "app/control/watch/knock_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/control/demo_trial.h"
#include "recon/segmentation/frame_segmenter.h"
#include "sessions/session_reader.h"
#include "tests/app/hand_footage.h"
#include "tests/app/mask_rig.h"
#include "tests/recon/consistency/hand_stage.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

core::FrameRecord FrameOf(double time_s, std::vector<core::SoftMask> masks) {
  core::FrameRecord frame;
  frame.time_s = time_s;
  frame.masks = std::make_shared<const std::vector<core::SoftMask>>(std::move(masks));
  frame.stamps.resize(frame.masks->size(), core::CameraStamp());
  return frame;
}

TEST(KnockWatch, ComparesOnlyWhatIsNewAndWhole) {
  const recon::testing::HandStage stage(recon::testing::HandRig(3));
  KnockWatch watch(stage.rig);
  core::FrameRecord frame = FrameOf(0.0, stage.MasksOf(recon::testing::HandsAt({}, 0.0)));
  EXPECT_EQ(watch.Add(frame), std::nullopt);
  EXPECT_EQ(watch.report().frames_compared, 1);
  frame.time_s = 0.1;  // the same masks
  EXPECT_EQ(watch.Add(frame), std::nullopt);
  core::FrameRecord lacking = FrameOf(0.2, stage.MasksOf(recon::testing::HandsAt({}, 0.2)));
  lacking.stamps[1].reset();
  EXPECT_EQ(watch.Add(lacking), std::nullopt);
  EXPECT_EQ(watch.Add(FrameOf(0.3, stage.MasksOf({}))), std::nullopt);
  EXPECT_EQ(watch.report().frames_compared, 1);
  EXPECT_EQ(watch.report().frames_skipped, 3);
  EXPECT_EQ(watch.report().state, KnockState::kLearning);
  EXPECT_EQ(watch.report().advice, "");
}

// The demo's arm leaves the workspace, cut by the pictures' borders; its task is played over and over.
TEST(KnockWatch, SaysNothingOfTheDemosCameras) {
  const TrialSetup setup = MakeDemoTrial(DemoPlay::kForever);
  const recon::FrameSegmenter segmenter(setup.source->ReadBackgrounds({}, {}), setup.segmentation,
                                        setup.source->rig());
  KnockWatch watch(setup.source->rig());
  constexpr core::FrameIndex kFrames = 1200;
  for (core::FrameIndex i = 0; i < kFrames; ++i) {
    const recon::FrameSet frames = setup.source->Read(i);
    EXPECT_EQ(watch.Add(FrameOf(frames.time_s, segmenter.SegmentSoft(frames))), std::nullopt) << i;
  }
  EXPECT_EQ(watch.report().state, KnockState::kSteady);
  EXPECT_GT(watch.report().evidence_s, 60.0);
  EXPECT_LT(watch.report().noise_factor, 2.0);
}

TEST(KnockWatch, ARigWithoutPairsIsNeverJudged) {
  core::Rig rig = recon::testing::HandRig(3);
  rig.cameras.resize(1, rig.cameras.front());
  const recon::testing::HandStage stage(rig);
  KnockWatch watch(rig);
  EXPECT_EQ(watch.Add(FrameOf(0.0, stage.MasksOf(recon::testing::HandsAt({}, 0.0)))), std::nullopt);
  EXPECT_EQ(watch.report().frames_skipped, 1);
}

// The whole way: masks on disk, the program, the session's note.
class KnockedTrial : public ::testing::Test {
 protected:
  nlohmann::json Run(const test_support::HandFootage& footage) {
    test_support::WriteHandFootage(folder_ / "rig", footage);
    test_support::WriteBoxStl(folder_ / "box.stl", 40.0);
    test_support::WriteText(folder_ / "layout.toml",
                            "unit = \"mm\"\n[[part]]\nname = \"box\"\nfile = \"box.stl\"\n"
                            "position_mm = [0, 0, 600]\n");
    test_support::WriteText(folder_ / "trial.toml", "rig = \"rig/rig.yml\"\nlayout = \"layout.toml\"\n");
    const test_support::ProgramRun run = test_support::RunProgram(
        test_support::ProgramFile(), {"trial", "run", (folder_ / "trial.toml").string(), "--session",
                                      Session().string(), "--headless", "--json"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
  }

  [[nodiscard]] std::filesystem::path Session() const { return folder_ / "session.db"; }

  [[nodiscard]] std::vector<std::string> Notes() const {
    std::vector<std::string> notes;
    for (const core::SessionEvent& event : sessions::SessionReader(Session()).events())
      if (const auto* note = std::get_if<core::Note>(&event.what)) notes.push_back(note->text);
    return notes;
  }

  TemporaryFolder folder_;
};

TEST_F(KnockedTrial, NamesTheCameraInTheSession) {
  constexpr double kAtS = 33.0, kTurnPx = 0.8;
  const nlohmann::json summary = Run({.offset_s = {0.0, 0.0, 0.0, 0.0},
                                      .seconds = 45.0,
                                      .rate_hz = 12.0,
                                      .knock = test_support::CameraKnock{2, kAtS, kTurnPx}});
  const nlohmann::json& knocks = summary["knocks"];
  ASSERT_EQ(knocks["state"], "named") << knocks;
  EXPECT_THAT(knocks["cameras"].get<std::vector<std::string>>(), ElementsAre("cam3"));
  EXPECT_NEAR(knocks["since_s"].get<double>(), kAtS, 2.0);
  EXPECT_NEAR(knocks["shift_px"].get<double>(), kTurnPx, 0.35 * kTurnPx + 0.1);  // "about how much"
  EXPECT_THAT(summary["warnings"].dump(),
              AllOf(HasSubstr("camera 'cam3' was knocked"), HasSubstr("calibrate again")));
  EXPECT_THAT(Notes(), ::testing::Contains(HasSubstr("camera 'cam3' was knocked")).Times(1));
}

TEST_F(KnockedTrial, SaysNothingOfCamerasThatStand) {
  const nlohmann::json summary = Run({.offset_s = {0.0, 0.0, 0.0, 0.0}, .seconds = 45.0, .rate_hz = 12.0});
  EXPECT_EQ(summary["knocks"]["state"], "steady");
  EXPECT_THAT(summary["warnings"], IsEmpty());
  EXPECT_THAT(Notes(), ::testing::Not(::testing::Contains(HasSubstr("knocked"))));
}

}  // namespace
}  // namespace elbowroom::control
