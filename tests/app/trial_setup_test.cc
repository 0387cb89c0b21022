#include "app/control/trial_setup.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <tuple>

#include "app/control/layout_editing/trial_draft.h"
#include "app/control/preflight/preflight_rig.h"
#include "app/control/segmentation/segmentation_settings.h"
#include "core/error.h"
#include "tests/app/mask_rig.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using test_support::WriteText;

constexpr const char* kHead = R"(%YAML:1.0
---
name: "head"
image_width: 64
image_height: 48
camera_matrix: [60, 0, 31.5, 0, 60, 23.5, 0, 0, 1]
distortion_model: "plumb_bob"
distortion_coefficients: [0, 0, 0, 0, 0]
rotation_cam_from_world: [1, 0, 0, 0, -1, 0, 0, 0, -1]
translation_cam_from_world_mm: [0, 0, 900]
)";

constexpr const char* kLayout = R"(unit = "mm"
[[part]]
name = "box"
file = "box.stl"
position_mm = [0, 0, 200]
)";

// A trial of one frame with a viewer camera, whose table is as given.
class ViewerTrial {
 public:
  explicit ViewerTrial(const std::string& viewer) {
    test_support::WriteBallRig(folder_.path());
    test_support::WriteBoxStl(folder_ / "box.stl", 40.0);
    WriteText(folder_ / "layout.toml", kLayout);
    WriteText(folder_ / "head.yml", kHead);
    WriteText(folder_ / "flat.yml", fmt::format("{}projection: \"orthographic\"\n", kHead));
    cv::imwrite((folder_ / "head_0.png").string(), cv::Mat(48, 64, CV_8UC3, cv::Scalar(0, 200, 0)));
    WriteText(file(), "rig = \"rig.yml\"\nlayout = \"layout.toml\"\n[viewer]\n" + viewer);
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_ / "trial.toml"; }

 private:
  test_support::TemporaryFolder folder_;
};

TEST(ReadTrialFile, TheViewersPicturesComeWithTheFrames) {
  const ViewerTrial trial("camera = \"head.yml\"\nframes = \"head_%d.png\"\n");
  const TrialSetup setup = ReadTrialFile(trial.file());
  EXPECT_TRUE(setup.warnings.empty());
  const recon::FrameSet frames = setup.source->Read(0);
  ASSERT_TRUE(frames.viewer.has_value());
  EXPECT_EQ(frames.viewer->camera->name(), "head");
  EXPECT_EQ(frames.viewer->image_bgr.at<cv::Vec3b>(20, 20), cv::Vec3b(0, 200, 0));
}

TEST(ReadTrialFile, FootageIsKeptOfLiveCamerasAlone) {
  const ViewerTrial trial("camera = \"head.yml\"\nframes = \"head_%d.png\"\n");
  const std::string table = "rig = \"rig.yml\"\nlayout = \"layout.toml\"\nrecord = ";
  WriteText(trial.file(), table + "\"footage\"\n");
  const TrialSetup setup = ReadTrialFile(trial.file());
  EXPECT_EQ(setup.footage, nullptr);
  ASSERT_EQ(setup.warnings.size(), 1U);
  EXPECT_NE(setup.warnings[0].find("record = \"footage\" is for live cameras"), std::string::npos);
  WriteText(trial.file(), table + "\"silhouettes\"\n");
  EXPECT_TRUE(ReadTrialFile(trial.file()).warnings.empty());
  WriteText(trial.file(), table + "\"all\"\n");
  try {
    (void)ReadTrialFile(trial.file());
    FAIL() << "it was read";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("\"silhouettes\" or \"footage\""), std::string::npos);
  }
}

TEST(ReadTrialFile, WhatAViewerHasWrongIsOneLine) {
  for (const auto& [viewer, said] :
       {std::pair{"camera = \"head.yml\"\n", "frames"},
        {"frames = \"head_%d.png\"\n", "camera"},
        {"camera = \"none.yml\"\nframes = \"head_%d.png\"\n", "none.yml"},
        {"camera = \"flat.yml\"\nframes = \"head_%d.png\"\n", "orthographic"},
        {"camera = \"head.yml\"\nframes = \"other_%d.png\"\n", "other_%d.png"},
        {"camera = \"head.yml\"\nframes = \"head_%d.png\"\nlens = 3\n", "lens"}}) {
    const ViewerTrial trial(viewer);
    try {
      (void)ReadTrialFile(trial.file());
      FAIL() << viewer;
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
}

// A trial whose cameras have segmentation settings of their own, as given.
class SegmentedTrial {
 public:
  explicit SegmentedTrial(const std::string& cameras) {
    test_support::WriteBallFootage(folder_.path());
    test_support::WriteBoxStl(folder_ / "box.stl", 40.0);
    WriteText(folder_ / "layout.toml", kLayout);
    cv::Mat window(240, 320, CV_8U, cv::Scalar(0));
    window(cv::Rect(10, 20, 30, 40)).setTo(255);
    cv::imwrite((folder_ / "window.png").string(), window);
    cv::imwrite((folder_ / "small.png").string(), window(cv::Rect(0, 0, 64, 48)));
    WriteText(file(), "rig = \"rig.yml\"\nlayout = \"layout.toml\"\n[segmentation]\nk_sigma = 6\n" + cameras);
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_ / "trial.toml"; }

 private:
  test_support::TemporaryFolder folder_;
};

TEST(ReadTrialFile, CamerasHaveThresholdsAndIgnoreMasksOfTheirOwn) {
  const SegmentedTrial trial(
      "[[segmentation.camera]]\nname = \"cam2\"\nk_sigma = 8.0\nfloor_levels = 12\n"
      "[[segmentation.camera]]\nname = \"cam4\"\nignore = \"window.png\"\n");
  const recon::SegmentationOptions options = ReadTrialFile(trial.file()).segmentation;
  ASSERT_EQ(options.cameras.size(), 2U);
  EXPECT_EQ(options.ForCamera("cam1").k_sigma, 6.0);
  EXPECT_EQ(options.ForCamera("cam2").k_sigma, 8.0);
  EXPECT_EQ(options.ForCamera("cam2").floor_levels, 12.0);
  EXPECT_EQ(options.OfCamera("cam2")->ignore.CountObjectPixels(), 0U);
  EXPECT_EQ(options.ForCamera("cam4").k_sigma, 6.0);
  EXPECT_EQ(options.OfCamera("cam4")->ignore.CountObjectPixels(), 30U * 40U);
  const auto settings = SettingsOf(options);
  EXPECT_EQ(settings.at("segmentation.camera.cam2.k_sigma"), "8");
  EXPECT_EQ(settings.at("segmentation.camera.cam2.floor_levels"), "12");
  EXPECT_EQ(settings.at("segmentation.camera.cam4.ignored_pixels"), "1200");
}

TEST(ReadTrialFile, WhatACamerasSegmentationHasWrongIsOneLine) {
  const std::string camera = "[[segmentation.camera]]\n";
  for (const auto& [cameras, said] :
       {std::pair{camera + "k_sigma = 4.0\n", "name"},
        {camera + "name = \"cam9\"\n", "'cam9' isn't in the rig, whose cameras are 'cam1'"},
        {camera + "name = \"cam1\"\nk_sigma = 0\n", "k_sigma"},
        {camera + "name = \"cam1\"\nfloor_levels = 300\n", "floor_levels"},
        {camera + "name = \"cam1\"\nignore = \"none.png\"\n", "none.png"},
        {camera + "name = \"cam1\"\nignore = \"small.png\"\n",
         "64 x 48 pixels, but its pictures have 320 x 240"},
        {camera + "name = \"cam1\"\nmask = \"window.png\"\n", "mask"},
        {camera + "name = \"cam1\"\n" + camera + "name = \"cam1\"\n", "second time"},
        {std::string("camera = 3\n"), "[[camera]]"}}) {
    const SegmentedTrial trial(cameras);
    try {
      (void)ReadTrialFile(trial.file());
      FAIL() << cameras;
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
}

// A trial file with these lines, read as the console reads it before a trial.
core::TrialInfo InfoWith(const std::string& lines) {
  const test_support::TemporaryFolder folder;
  WriteText(folder / "trial.toml", "rig = \"rig.yml\"\nlayout = \"layout.toml\"\n" + lines);
  return ReadTrialInfo(folder / "trial.toml");
}

std::string FaultOf(const std::string& lines) {
  try {
    (void)InfoWith(lines);
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

TEST(ReadTrialInfo, HasConditionOrderStepsAndSurvey) {
  const core::TrialInfo trial = InfoWith(R"(condition = "gloves"
order = 3
[[step]]
name = "reach in"
[[step]]
name = "screw"
[[survey]]
when = "before"
item = "How sure?"
[[survey]]
when = "after"
item = "How sure?"
scale = [-3, 3]
)");
  EXPECT_EQ(trial.condition, "gloves");
  EXPECT_EQ(trial.order, 3);
  EXPECT_EQ(trial.steps, (std::vector<std::string>{"reach in", "screw"}));
  EXPECT_EQ(trial.survey, (std::vector<core::SurveyItem>{{core::AskedWhen::kBefore, "How sure?", 1, 7},
                                                         {core::AskedWhen::kAfter, "How sure?", -3, 3}}));
  EXPECT_TRUE(InfoWith("").survey.empty());
}

TEST(ReadTrialInfo, NamesWhatIsWrongInAProcedure) {
  const auto expect_fault = [](const std::string& lines, const std::string& fault) {
    EXPECT_NE(FaultOf(lines).find(fault), std::string::npos) << lines << FaultOf(lines);
  };
  expect_fault("conditon = \"a\"", "unknown key 'conditon'; did you mean 'condition'?");
  expect_fault("[[step]]\nnane = \"a\"", "[[step]]: unknown key 'nane'; did you mean 'name'?");
  expect_fault("[[step]]\nname = \"a\"\n[[step]]\nname = \"a\"",
               "trial.toml:6: [[step]]: key 'name' 'a' is the name");
  expect_fault("order = 0", "key 'order' must be a whole number from 1");
  expect_fault("order = 1.5", "key 'order' must be a whole number from 1");
  const std::string item = "[[survey]]\nwhen = \"after\"\nitem = \"a\"\n";
  expect_fault("[[survey]]\nwhen = \"later\"\nitem = \"a\"", "key 'when' must be \"before\" or \"after\"");
  expect_fault(item + "scale = [7, 1]", "key 'scale' must be two whole numbers, the least first");
  expect_fault(item + "scale = [1, 7.5]", "key 'scale' must be two whole numbers");
  expect_fault(item + "scale = [1, 100000]", "key 'scale' must be two whole numbers");
  expect_fault(item + item, "'a' is asked after the trial already");
  expect_fault("[[survey]]\nwhen = \"after\"", "key 'item' is missing");
}

// A trial whose survey is in a file of another folder, and planned trials of it.
class PlannedTrialFile : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"asked", "plan"}) std::filesystem::create_directory(folder_ / name);
    WriteText(folder_ / "asked/q.toml", "name = \"presence\"\n[[item]]\nid = \"there\"\ntext = \"There?\"\n");
    test_support::WriteBallRig(folder_.path());
    test_support::WriteBoxStl(folder_ / "box.stl", 40.0);
    WriteText(folder_ / "layout.toml", kLayout);
    WriteBase("");
  }
  void WriteBase(const std::string& more) const {
    WriteText(folder_ / "trial.toml", R"(rig = "rig.yml"
layout = "layout.toml"
participant = "nobody"
task = "reach"
condition = "bare"
estimate_mm = 12
[[survey]]
when = "after"
file = "asked/q.toml"
[segmentation]
k_sigma = 7.5
)" + more);
  }
  [[nodiscard]] std::filesystem::path Planned(const std::string& lines) const {
    WriteText(folder_ / "plan/P01-2.toml", lines);
    return folder_ / "plan/P01-2.toml";
  }
  [[nodiscard]] std::string FaultOfPlanned(const std::string& lines) const {
    try {
      (void)ReadTrialInfo(Planned(lines));
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  }
  test_support::TemporaryFolder folder_;
};

constexpr const char* kPlanned = R"(base = "../trial.toml"
participant = "P01"
condition = "gloves"
order = 2
block = "timed"
)";

TEST_F(PlannedTrialFile, SaysWhoAndWhenAndItsBaseAllElse) {
  const TrialSetup setup = ReadTrialFile(Planned(kPlanned));
  EXPECT_EQ(std::tie(setup.info.participant, setup.info.condition, setup.info.order, setup.info.block),
            std::make_tuple(std::string("P01"), std::string("gloves"), 2, std::string("timed")));
  EXPECT_EQ(setup.info.task, "reach");
  EXPECT_EQ(setup.info.estimate_mm, 12.0);
  EXPECT_EQ(setup.segmentation.k_sigma, 7.5);
  EXPECT_EQ(setup.layout.parts.size(), 1U);
  ASSERT_EQ(setup.info.questionnaires.size(), 1U);
  EXPECT_EQ(setup.info.questionnaires[0].name, "presence");
  EXPECT_EQ(setup.info.questionnaires[0].when, core::AskedWhen::kAfter);
}

TEST_F(PlannedTrialFile, IsATrialToPreflightAndWindow) {
  const std::filesystem::path planned = Planned(kPlanned);
  EXPECT_EQ(KindOf(planned), TomlKind::kTrial);
  EXPECT_EQ(ReadPreflightRig(planned).rig_file.rig.name,
            ReadPreflightRig(folder_ / "rig.yml").rig_file.rig.name);
}

TEST_F(PlannedTrialFile, WhatIsWrongIsOneLine) {
  EXPECT_NE(FaultOfPlanned("base = \"nowhere.toml\"\n").find("P01-2.toml:1: key 'base' names '"),
            std::string::npos);
  EXPECT_NE(FaultOfPlanned("base = \"P01-2.toml\"\n").find("has a base itself"), std::string::npos);
  EXPECT_NE(
      FaultOfPlanned("base = \"../trial.toml\"\nrig = \"rig.yml\"\n").find("P01-2.toml:2: unknown key 'rig'"),
      std::string::npos);
  EXPECT_NE(
      FaultOfPlanned("base = \"../trial.toml\"\norder = 0\n").find("key 'order' must be a whole number"),
      std::string::npos);
  EXPECT_NE(FaultOfPlanned("base = 3\n").find("key 'base' must be a text"), std::string::npos);
  WriteBase("[[survey]]\nwhen = \"after\"\nfile = \"asked/q.toml\"\n");
  EXPECT_NE(FaultOfPlanned(kPlanned).find("'presence' is asked after the trial already"), std::string::npos);
  WriteBase("[[survey]]\nwhen = \"before\"\nfile = \"q.toml\"\n");
  EXPECT_NE(FaultOfPlanned(kPlanned).find("trial.toml:14: [[survey]]: key 'file' names '"), std::string::npos)
      << FaultOfPlanned(kPlanned);
  WriteBase("[[survey]]\nwhen = \"before\"\nfile = \"asked/q.toml\"\nitem = \"a\"\n");
  EXPECT_NE(FaultOfPlanned(kPlanned).find("key 'item' can't stand beside 'file'"), std::string::npos);
}

}  // namespace
}  // namespace elbowroom::control
