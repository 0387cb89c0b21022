// Replays that segment the footage again: of trials on recorded pictures, whose RIG.yml the user gives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "app/control/outcome_tracker.h"
#include "app/control/replay/replay.h"
#include "app/control/trial_runner.h"
#include "core/error.h"
#include "core/gives_way.h"
#include "recon/footage/recorded_rig.h"
#include "sessions/session_reader.h"
#include "tests/app/live_demo.h"
#include "tests/app/replay/session_rows.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// The demo's pictures on disk, where the hand touches the payloads, and trials on them.
class SegmentPictures : public testing::Test {
 protected:
  static constexpr core::FrameIndex kFrames = 24;
  static constexpr double kTooHighLevels = 90.0;

  static void SetUpTestSuite() {
    demo_ = new DemoFootage(RenderDemo());
    pictures_ = new test_support::TemporaryFolder();
    for (std::size_t i = 0; i < kCameras; ++i) {
      const fs::path camera = *pictures_ / fmt::format("cam{}", i + 1);
      fs::create_directories(camera);
      for (core::FrameIndex frame = 0; frame < kFrames; ++frame)
        cv::imwrite((camera / fmt::format("{:04}.png", frame)).string(),
                    demo_->sets[static_cast<std::size_t>(frame)].cameras[i].image_bgr);
      cv::Mat mean;
      demo_->backgrounds[i].mean_bgr.convertTo(mean, CV_8U);
      cv::imwrite((camera / "empty.png").string(), mean);
    }
  }
  static void TearDownTestSuite() {
    delete pictures_;
    delete demo_;
  }

  void SetUp() override {
    fs::copy(pictures_->path(), folder_.path(),
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    recon::RigFile rig_file{demo_->setup.source->rig()};
    for (std::size_t i = 0; i < kCameras; ++i) {
      const fs::path camera = folder_ / fmt::format("cam{}", i + 1);
      rig_file.sources.push_back({(camera / "%04d.png").string(), (camera / "empty.png").string(), ""});
    }
    recon::WriteRigFile(rig_file, rig());
  }

  [[nodiscard]] fs::path rig() const { return folder_ / "RIG.yml"; }
  [[nodiscard]] fs::path Session(const std::string& name) const { return folder_ / (name + ".db"); }

  // Records a trial with that floor.
  void Record(const std::string& name, double floor_levels) const {
    TrialSetup setup = demo_->setup;
    setup.segmentation.floor_levels = floor_levels;
    setup.source = std::make_shared<recon::RecordedRig>(recon::ReadRigFile(rig()));
    TrialOptions options;
    options.session = Session(name);
    TrialControls controls;
    (void)RunTrial(setup, options, controls, {});
  }
  [[nodiscard]] fs::path SettingsFile(double floor_levels) const {
    const fs::path file = folder_ / "settings.toml";
    test_support::WriteText(file, fmt::format("[segmentation]\nfloor_levels = {}\n", floor_levels));
    return file;
  }
  [[nodiscard]] ReplayOutcome Segmented(const std::string& recorded, const std::string& name,
                                        const SegmentingOptions& segmenting, FrameRange frames = {},
                                        ReplayChanges changes = {}) const {
    const sessions::SessionReader reader = OpenWithOutcome(Session(recorded), {}, {});
    return RunReplay(reader, {Session(name), std::move(changes), frames, segmenting}, {}, {});
  }
  [[nodiscard]] std::string ErrorOf(const std::string& recorded, const SegmentingOptions& segmenting) const {
    try {
      (void)Segmented(recorded, "new", segmenting);
    } catch (const core::Error& error) {
      EXPECT_FALSE(fs::exists(Session("new")));
      return error.what();
    }
    return "no error";
  }

  static DemoFootage* demo_;
  static test_support::TemporaryFolder* pictures_;
  test_support::TemporaryFolder folder_;
  double right_levels_ = recon::SegmentationOptions().floor_levels;
};

DemoFootage* SegmentPictures::demo_ = nullptr;
test_support::TemporaryFolder* SegmentPictures::pictures_ = nullptr;

TEST_F(SegmentPictures, WithTheRecordedSettingsIsTheRecording) {
  Record("s", right_levels_);
  const ReplayOutcome outcome = Segmented("s", "again", {"", rig()});
  EXPECT_THAT(outcome.changes, IsEmpty());
  ASSERT_TRUE(outcome.compared.has_value());
  EXPECT_EQ(outcome.compared->frames_that_differ, 0);
  ASSERT_TRUE(outcome.segmented.has_value());
  EXPECT_EQ(outcome.segmented->count.pictures, kCameras * kFrames);
  EXPECT_EQ(outcome.segmented->count.silhouettes_that_differ, 0);
  EXPECT_GT(outcome.contact_rows, 0);
  EXPECT_EQ(RowsThatDiffer(Session("s"), Session("again")), 0);
  const ReplayOutcome part = Segmented("s", "part", {"", rig()}, {9, 17});
  EXPECT_EQ(part.frames, 8);
  EXPECT_EQ(part.compared->frames_that_differ, 0);
  EXPECT_EQ(RowsThatDiffer(Session("s"), Session("part"), "frame_index BETWEEN 9 AND 16"), 0);
}

// The trial that was right at once is the oracle.
TEST_F(SegmentPictures, WithTheRightThresholdIsTheTrialThatWasRightAtOnce) {
  Record("wrong", kTooHighLevels);
  Record("right", right_levels_);
  ASSERT_GT(RowsThatDiffer(Session("wrong"), Session("right")), 0);
  const ReplayOutcome outcome = Segmented("wrong", "repaired", {SettingsFile(right_levels_), rig()});
  EXPECT_THAT(outcome.changes, Contains(fmt::format("segmentation.floor_levels: {} instead of {}",
                                                    right_levels_, kTooHighLevels)));
  EXPECT_FALSE(outcome.compared.has_value());
  EXPECT_GT(outcome.segmented->count.silhouettes_that_differ, 0);
  EXPECT_EQ(RowsThatDiffer(Session("right"), Session("repaired")), 0);
  const sessions::SessionReader right(Session("right")), repaired(Session("repaired"));
  EXPECT_EQ(repaired.episodes().size(), right.episodes().size());
  EXPECT_EQ(repaired.header().settings.at("segmentation.floor_levels"),
            right.header().settings.at("segmentation.floor_levels"));
  EXPECT_EQ(repaired.header().settings.at("segmentation.pictures"), rig().string());
  ASSERT_TRUE(repaired.header().origin.has_value());
  EXPECT_EQ(repaired.header().origin->changes, outcome.changes);
}

TEST_F(SegmentPictures, TogetherWithAnotherGapIsTheTrialAtThatGap) {
  constexpr double kGapMm = 160.0;
  const std::string gap = demo_->setup.layout.spacings[0].name;
  Record("wrong", kTooHighLevels);
  TrialSetup& setup = demo_->setup;
  const double usual_mm = std::exchange(setup.layout.spacings[0].initial_mm, kGapMm);
  Record("right", right_levels_);
  setup.layout.spacings[0].initial_mm = usual_mm;
  const ReplayOutcome outcome =
      Segmented("wrong", "repaired", {SettingsFile(right_levels_), rig()}, {}, {.held_mm = {{gap, kGapMm}}});
  EXPECT_EQ(outcome.changes.size(), 2U);
  EXPECT_EQ(RowsThatDiffer(Session("right"), Session("repaired")), 0);
}

TEST_F(SegmentPictures, WithPartsThatGiveWayTakesTheSameSteps) {
  TrialSetup& setup = demo_->setup;
  setup.layout.parts[1].gives_way = core::PushRule{};
  Record("wrong", kTooHighLevels);
  Record("right", right_levels_);
  setup.layout.parts[1].gives_way = {};
  EXPECT_EQ(Segmented("right", "again", {"", rig()}).compared->frames_that_differ, 0);
  (void)Segmented("wrong", "repaired", {SettingsFile(right_levels_), rig()});
  EXPECT_EQ(RowsThatDiffer(Session("right"), Session("repaired")), 0);
}

// What verdicts allow for is part of the table.
TEST_F(SegmentPictures, TheBoundarysErrorIsThatOfTheFile) {
  TrialSetup& setup = demo_->setup;
  Eigen::Index parameters = 0;
  constexpr Eigen::Index kOfEach = 4 + 6 + 1;  // beside the lens's coefficients
  for (const core::CameraModel& camera : setup.source->rig().cameras)
    parameters += kOfEach + static_cast<Eigen::Index>(camera.calibration().distortion_coefficients.size());
  const core::RigQuality usual = setup.rig_quality;
  setup.rig_quality.errors = core::RigErrors{1e-8 * Eigen::MatrixXd::Identity(parameters, parameters), 0.2};
  Record("wrong", right_levels_);
  setup.rig_quality.errors->boundary_sigma_px = 0.7;
  Record("right", right_levels_);
  setup.rig_quality = usual;
  ASSERT_GT(RowsThatDiffer(Session("wrong"), Session("right")), 0);
  const fs::path file = folder_ / "boundary.toml";
  test_support::WriteText(file, "[segmentation]\nboundary_sigma_px = 0.7\n");
  const ReplayOutcome outcome = Segmented("wrong", "repaired", {file, rig()});
  EXPECT_THAT(outcome.changes, Contains("segmentation.boundary_sigma_px: 0.7 instead of 0.2"));
  EXPECT_EQ(RowsThatDiffer(Session("right"), Session("repaired")), 0);
  EXPECT_EQ(sessions::SessionReader(Session("repaired")).header().rig_quality.errors->boundary_sigma_px, 0.7);
}

TEST_F(SegmentPictures, SomeFramesWithOtherSettingsTouchWhereAllFramesDo) {
  Record("wrong", kTooHighLevels);
  Record("right", right_levels_);
  (void)Segmented("wrong", "part", {SettingsFile(right_levels_), rig()}, {9, 17});
  const sessions::SessionReader right(Session("right")), part(Session("part"));
  ASSERT_EQ(part.frame_count(), 8);
  for (core::FrameIndex frame = 9; frame < 17; ++frame) {
    EXPECT_EQ(*part.ReadFrame(frame).masks, *right.ReadFrame(frame).masks);
    EXPECT_EQ(FoundIn(part.ReadFrame(frame)), FoundIn(right.ReadFrame(frame)));
  }
}

TEST_F(SegmentPictures, NeedsTheCamerasThatRecorded) {
  Record("s", right_levels_);
  EXPECT_THAT(ErrorOf("s", {}), AllOf(HasSubstr("names no footage"), HasSubstr("--rig")));
  EXPECT_THAT(ErrorOf("s", {"", folder_ / "none.yml"}), HasSubstr("none.yml"));
  recon::RigFile moved = recon::ReadRigFile(rig());
  core::CameraCalibration calibration = moved.rig.cameras[2].calibration();
  calibration.cam_from_world.translation_mm.x() += 0.5;
  moved.rig.cameras[2] = core::CameraModel(calibration);
  recon::WriteRigFile(moved, folder_ / "moved.yml");
  EXPECT_THAT(ErrorOf("s", {"", folder_ / "moved.yml"}),
              AllOf(HasSubstr("moved.yml"), HasSubstr(calibration.name), HasSubstr("same calibration")));
  recon::RigFile fewer = recon::ReadRigFile(rig());
  fewer.rig.cameras.pop_back();
  fewer.sources.pop_back();
  recon::WriteRigFile(fewer, folder_ / "fewer.yml");
  EXPECT_THAT(ErrorOf("s", {"", folder_ / "fewer.yml"}), HasSubstr("has no camera"));
}

TEST_F(SegmentPictures, FootageThatIsTooShortOrBrokenIsOneLine) {
  Record("s", right_levels_);
  fs::remove(folder_ / "cam2" / fmt::format("{:04}.png", kFrames - 1));
  EXPECT_THAT(ErrorOf("s", {"", rig()}), AllOf(HasSubstr("has no frame 23"), HasSubstr("too short")));
  test_support::WriteText(folder_ / "cam3" / "0007.png", "no picture");
  EXPECT_THAT(ErrorOf("s", {"", rig()}), HasSubstr("0007.png"));
}

// Its boundaries move by fractions of a pixel.
TEST_F(SegmentPictures, ALossyCopyIsToldFromTheFootage) {
  Record("s", right_levels_);
  recon::RigFile copy = recon::ReadRigFile(rig());
  for (std::size_t i = 0; i < kCameras; ++i) {
    const fs::path camera = folder_ / fmt::format("jpeg{}", i + 1);
    fs::create_directories(camera);
    for (core::FrameIndex frame = 0; frame < kFrames; ++frame)
      cv::imwrite((camera / fmt::format("{:04}.jpg", frame)).string(),
                  demo_->sets[static_cast<std::size_t>(frame)].cameras[i].image_bgr,
                  {cv::IMWRITE_JPEG_QUALITY, 95});
    copy.sources[i].frames = (camera / "%04d.jpg").string();
  }
  recon::WriteRigFile(copy, folder_ / "copy.yml");
  const ReplayOutcome outcome = Segmented("s", "copied", {"", folder_ / "copy.yml"});
  ASSERT_TRUE(outcome.compared.has_value());
  EXPECT_GT(outcome.compared->frames_that_differ, 0);
  EXPECT_GT(outcome.segmented->count.silhouettes_that_differ, 0);
  constexpr double kMostOfArea = 0.005;  // as docs/replay.md says
  const sessions::SessionReader exact(Session("s")), copied(Session("copied"));
  for (core::FrameIndex frame = 0; frame < kFrames; ++frame) {
    for (std::size_t i = 0; i < kCameras; ++i) {
      const auto area = [&](const sessions::SessionReader& session) {
        return static_cast<double>((*session.ReadFrame(frame).masks)[i].mask.CountObjectPixels());
      };
      EXPECT_NEAR(area(copied), area(exact), kMostOfArea * area(exact));
    }
  }
}

TEST_F(SegmentPictures, IgnoredPixelsMustBeGivenAgain) {
  TrialSetup setup = demo_->setup;
  const core::CameraModel& camera = setup.source->rig().cameras[0];
  core::BitMask window(camera.width_px(), camera.height_px());
  for (int x = 0; x < 90; ++x)
    for (int y = 0; y < camera.height_px(); ++y) window.Set(x, y, true);
  setup.segmentation.cameras.push_back({camera.name(), 6.0, std::nullopt, window});
  setup.source = std::make_shared<recon::RecordedRig>(recon::ReadRigFile(rig()));
  TrialOptions options;
  options.session = Session("s");
  TrialControls controls;
  (void)RunTrial(setup, options, controls, {});
  EXPECT_THAT(ErrorOf("s", {"", rig()}), AllOf(HasSubstr("were ignored"), HasSubstr("--segmentation")));
  cv::Mat picture(camera.height_px(), camera.width_px(), CV_8U, cv::Scalar(0));
  picture.colRange(0, 90).setTo(255);
  cv::imwrite((folder_ / "window.png").string(), picture);
  test_support::WriteText(folder_ / "trial.toml",
                          fmt::format("rig = \"x\"\nlayout = \"y\"\n[segmentation]\n[[segmentation.camera]]\n"
                                      "name = \"{}\"\nk_sigma = 6.0\nignore = \"window.png\"\n",
                                      camera.name()));
  const ReplayOutcome outcome = Segmented("s", "again", {folder_ / "trial.toml", rig()});
  EXPECT_THAT(outcome.changes, IsEmpty());
  EXPECT_EQ(outcome.compared->frames_that_differ, 0);
  EXPECT_EQ(outcome.segmented->count.silhouettes_that_differ, 0);
}

TEST_F(SegmentPictures, AStopLeavesNoFile) {
  Record("s", right_levels_);
  const sessions::SessionReader reader = OpenWithOutcome(Session("s"), {}, {});
  std::stop_source stop;
  const core::Progress progress([&](std::int64_t, std::int64_t, const std::string& what) {
    if (what == "replaying frame") stop.request_stop();
  });
  for (const fs::path& settings : {fs::path(), SettingsFile(kTooHighLevels)}) {
    EXPECT_THROW((void)RunReplay(reader, {Session("new"), {}, {}, SegmentingOptions{settings, rig()}},
                                 progress, stop.get_token()),
                 core::Error);
    EXPECT_FALSE(fs::exists(Session("new")));
  }
}

// As a user runs it.
TEST_F(SegmentPictures, Command) {
  Record("s", kTooHighLevels);
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"replay", Session("s").string(), "--session", Session("new").string(),
                                       "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test_support::RunProgram(test_support::ProgramFile(), arguments);
  };
  EXPECT_EQ(run({"--rig", rig().string()}).exit_status, 2);
  EXPECT_EQ(run({"--segmentation", SettingsFile(20.0).string()}).exit_status, 2);
  const auto expect_refused = [&](const std::vector<std::string>& more, const std::string& told) {
    const test_support::ProgramRun refused = run(more);
    EXPECT_EQ(refused.exit_status, 1);
    EXPECT_THAT(refused.err, HasSubstr(told));
    EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
    EXPECT_FALSE(fs::exists(Session("new")));
  };
  expect_refused({"--segment"}, "names no footage");
  test_support::WriteText(folder_ / "empty.toml", "");
  expect_refused({"--segment", "--rig", rig().string(), "--segmentation", (folder_ / "empty.toml").string()},
                 "has no [segmentation]");
  test_support::WriteText(folder_ / "wrong.toml", "[segmentation]\nk_sigmas = 4\n");
  expect_refused({"--segment", "--rig", rig().string(), "--segmentation", (folder_ / "wrong.toml").string()},
                 "wrong.toml:2");
  const test_support::ProgramRun done =
      run({"--segment", "--rig", rig().string(), "--segmentation", SettingsFile(right_levels_).string()});
  ASSERT_EQ(done.exit_status, 0) << done.err;
  const auto json = nlohmann::json::parse(done.out);
  EXPECT_TRUE(json["identical"].is_null());
  EXPECT_EQ(json["segmented"]["pictures"], kCameras * kFrames);
  EXPECT_EQ(json["segmented"]["missing_pictures"], 0);
  EXPECT_GT(json["segmented"]["silhouettes_that_differ"], 0);
  EXPECT_THAT(json["changes"][0].get<std::string>(), HasSubstr("floor_levels"));
}

}  // namespace
}  // namespace elbowroom::control
