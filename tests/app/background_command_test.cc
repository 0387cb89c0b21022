// elbowroom background with the simulated rig's cameras, served by GigE Vision.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/cameras/background_taking.h"
#include "core/error.h"
#include "recon/footage/background_reader.h"
#include "recon/rig_files/rig_file.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "tests/recon/capture/own_network.h"
#include "tests/recon/capture/served_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using recon::testing::ServedRig;
using test_support::ProgramRun;
using test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kCameras = 4;
constexpr double kRateHz = 20.0;
constexpr int kSets = 40;

const auto* const kNetwork = ::testing::AddGlobalTestEnvironment(new recon::testing::OwnNetwork(kCameras));

// Pictures of the empty scene, as the simulated cameras' noise has them.
const std::vector<recon::FrameSet>& EmptySets() {
  static const std::vector<recon::FrameSet> sets = [] {
    recon::SyntheticRig simulated(recon::FourCameraRig(),
                                  [](double) { return std::vector<recon::SyntheticObject>(); }, {});
    std::vector<recon::FrameSet> drawn;
    for (core::FrameIndex i = 0; i < kSets; ++i) drawn.push_back(simulated.Read(i));
    return drawn;
  }();
  return sets;
}

// The rig that is served, in `folder`, with all that its file can say.
std::filesystem::path WriteLiveRig(const ServedRig& served, const std::filesystem::path& folder) {
  recon::RigFile rig_file{recon::FourCameraRig()};
  for (std::size_t i = 0; i < kCameras; ++i) {
    rig_file.sources.push_back(served.SourcesOf(i));
    rig_file.sources.back().time_offset_s = 0.001 * static_cast<double>(i);
  }
  rig_file.gauge = core::RigGauge();
  rig_file.gauge->made = "2026-11-25T10:00:00Z";
  recon::WriteRigFile(rig_file, folder / "live.yml");
  return folder / "live.yml";
}

ProgramRun TakeBackground(const std::filesystem::path& rig, const std::filesystem::path& out,
                          const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"background", rig.string(), "--out", out.string(), "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return test_support::RunProgram(test_support::ProgramFile(), arguments);
}

// Nothing is left beside the rig file: neither the folder nor a part of it.
void ExpectNothingWritten(const std::filesystem::path& folder) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    found.push_back(entry.path().filename().string());
  EXPECT_THAT(found, ::testing::ElementsAre("live.yml"));
}

TEST(BackgroundCommand, KeepsMeanAndNoiseOfEveryPixelAndAllElseOfTheRig) {
  const TemporaryFolder folder;
  const ServedRig served(EmptySets(), kRateHz);
  const std::filesystem::path rig = WriteLiveRig(served, folder.path());
  const std::filesystem::path out = folder / "empty";
  std::filesystem::create_directory(out);  // an empty folder is as good as none
  const ProgramRun run = TakeBackground(rig, out, {"--seconds", "2"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty());
  const nlohmann::json json = nlohmann::json::parse(run.out);

  const recon::RigFile before = recon::ReadRigFile(rig), after = recon::ReadRigFile(out / "RIG.yml");
  EXPECT_EQ(after.rig.name, before.rig.name);
  ASSERT_TRUE(after.gauge.has_value());
  EXPECT_EQ(after.gauge->made, before.gauge->made);
  const auto references = recon::ReadBackgroundReferences(after, {}, {});
  ASSERT_EQ(json["cameras"].size(), static_cast<std::size_t>(kCameras));
  for (std::size_t i = 0; i < kCameras; ++i) {
    recon::CameraSources sources = after.sources[i];
    EXPECT_EQ(sources.background, (out / before.rig.cameras[i].name() / "%04d.png").string());
    sources.background.clear();
    EXPECT_EQ(sources, before.sources[i]);
    const nlohmann::json& camera = json["cameras"][i];
    EXPECT_EQ(camera["name"], before.rig.cameras[i].name());
    EXPECT_EQ(camera["frames"], references[i].frames);
    EXPECT_GE(references[i].frames, 10);
    EXPECT_FALSE(camera["moved"].get<bool>());
    EXPECT_THAT(camera["faults"], IsEmpty());
    // The pictures come without a change, so mean and noise are those of the sets that were served.
    cv::Mat served_mean = cv::Mat::zeros(references[i].mean_bgr.size(), CV_32FC3);
    for (const recon::FrameSet& set : EmptySets()) cv::accumulate(set.cameras[i].image_bgr, served_mean);
    served_mean /= kSets;
    const double off_levels = cv::norm(references[i].mean_bgr, served_mean, cv::NORM_L1) /
                              static_cast<double>(3 * served_mean.total());
    const double sigma_levels = camera["sigma_median_levels"];
    EXPECT_GT(sigma_levels, 0.1);
    EXPECT_LT(off_levels, sigma_levels);
    EXPECT_NEAR(camera["mean_level"], cv::mean(served_mean.reshape(1))[0], 0.1);
    EXPECT_GT(camera["suggested_k_sigma"], 3.0);
    EXPECT_NEAR(camera["suggested_floor_levels"].get<double>() / camera["suggested_k_sigma"].get<double>(),
                sigma_levels, 0.5 * sigma_levels);
  }
}

TEST(BackgroundCommand, GivesCamerasCheckTheLightToCompareWith) {
  const TemporaryFolder folder;
  const std::filesystem::path out = folder / "empty";
  std::filesystem::path rig;
  {
    const ServedRig served(EmptySets(), kRateHz);
    rig = WriteLiveRig(served, folder.path());
    ASSERT_EQ(TakeBackground(rig, out, {"--seconds", "2"}).exit_status, 0);
    const ProgramRun without = test_support::RunProgram(
        test_support::ProgramFile(), {"cameras", "check", rig.string(), "--seconds", "1", "--json"});
    ASSERT_EQ(without.exit_status, 0) << without.err;
    EXPECT_TRUE(nlohmann::json::parse(without.out)["cameras"][0]["light"].is_null());
  }
  std::vector<recon::FrameSet> darker = EmptySets();
  for (recon::FrameSet& set : darker) {
    for (recon::CameraFrame& frame : set.cameras) {
      cv::Mat dimmed;
      frame.image_bgr.convertTo(dimmed, CV_8U, 0.8);
      frame.image_bgr = dimmed;
    }
  }
  const ServedRig served(darker, kRateHz);
  const ProgramRun run =
      test_support::RunProgram(test_support::ProgramFile(),
                               {"cameras", "check", (out / "RIG.yml").string(), "--seconds", "1", "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const nlohmann::json json = nlohmann::json::parse(run.out);
  EXPECT_FALSE(json["well"].get<bool>());
  for (const nlohmann::json& camera : json["cameras"]) {
    constexpr double kGainTolerance = 0.02;  // the simulated exposure flickers by 1 %
    EXPECT_NEAR(camera["light"]["gain"], 0.8, kGainTolerance);
    std::string advice;
    for (const nlohmann::json& line : camera["advice"]) advice += line.get<std::string>() + "\n";
    EXPECT_THAT(advice, HasSubstr("darker than when the background was taken"));
  }
}

TEST(BackgroundCommand, RefusesSomethingThatMovesAndNamesCameraAndPlace) {
  std::vector<recon::FrameSet> sets = EmptySets();
  // A sleeve at the picture's edge, in camera 3 only, in some pictures of each second.
  for (std::size_t i = 0; i < sets.size(); i += 4) {
    sets[i].cameras[2].image_bgr = sets[i].cameras[2].image_bgr.clone();
    cv::Mat& image = sets[i].cameras[2].image_bgr;
    cv::rectangle(image, cv::Rect(image.cols - 40, image.rows - 50, 40, 50), cv::Scalar(200, 200, 210),
                  cv::FILLED);
  }
  const TemporaryFolder folder;
  const ServedRig served(sets, kRateHz);
  const std::filesystem::path rig = WriteLiveRig(served, folder.path());
  const ProgramRun refused = TakeBackground(rig, folder / "empty", {"--seconds", "2"});
  EXPECT_EQ(refused.exit_status, 1);
  EXPECT_THAT(refused.out, IsEmpty());
  EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
  const std::string name = recon::FourCameraRig().cameras[2].name();
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr(fmt::format("camera '{}': something moved in the lower right", name)),
                    HasSubstr("--anyway")));
  ExpectNothingWritten(folder.path());

  const ProgramRun taken = TakeBackground(rig, folder / "empty", {"--seconds", "2", "--anyway"});
  ASSERT_EQ(taken.exit_status, 0) << taken.err;
  const nlohmann::json json = nlohmann::json::parse(taken.out);
  for (std::size_t i = 0; i < kCameras; ++i) {
    EXPECT_EQ(json["cameras"][i]["moved"], i == 2) << i;
    EXPECT_EQ(json["cameras"][i]["suggested_k_sigma"].is_null(), i == 2) << i;
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "empty" / "RIG.yml"));
}

TEST(BackgroundCommand, RefusesLightThatIsNotSteady) {
  std::vector<recon::FrameSet> sets = EmptySets();
  for (std::size_t i = 0; i < sets.size(); ++i) {
    // Once in two seconds to 10 % above and below.
    const double gain = 1.0 + 0.1 * std::sin(2.0 * CV_PI * static_cast<double>(i) / kSets);
    cv::Mat changed;
    sets[i].cameras[1].image_bgr.convertTo(changed, CV_8U, gain);
    sets[i].cameras[1].image_bgr = changed;
  }
  const TemporaryFolder folder;
  const ServedRig served(sets, kRateHz);
  const std::filesystem::path rig = WriteLiveRig(served, folder.path());
  const ProgramRun run = TakeBackground(rig, folder / "empty", {"--seconds", "2"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_THAT(run.err,
              HasSubstr(fmt::format("camera '{}': the light", recon::FourCameraRig().cameras[1].name())));
  ExpectNothingWritten(folder.path());
}

TEST(BackgroundCommand, LeavesAFolderThatIsInUseAlone) {
  const TemporaryFolder folder;
  const ServedRig served(EmptySets(), kRateHz);
  const std::filesystem::path rig = WriteLiveRig(served, folder.path());
  const ProgramRun run = TakeBackground(rig, folder.path());
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_THAT(run.err, HasSubstr("is not empty; choose a folder that is new or empty"));
  ExpectNothingWritten(folder.path());
  EXPECT_THAT(TakeBackground(rig, folder / "50%").err, HasSubstr("has a '%'"));
}

// Stopped while people leave, while pictures are taken, and while they are written.
TEST(BackgroundCommand, LeavesNothingBehindWhenItIsStopped) {
  const TemporaryFolder folder;
  const ServedRig served(EmptySets(), kRateHz);
  const recon::RigFile rig = recon::ReadRigFile(WriteLiveRig(served, folder.path()));
  for (const std::string at :
       {"leave the cameras' view", "taking the background", "writing the background"}) {
    std::stop_source source;
    const core::Progress progress([&](std::int64_t, std::int64_t, const std::string& what) {
      if (what.starts_with(at)) source.request_stop();
    });
    control::BackgroundOptions options;
    options.countdown_s = 0.2;
    options.seconds = 1.0;
    try {
      (void)control::TakeBackground(rig, folder / "empty", options, progress, source.get_token());
      ADD_FAILURE() << at << ": not stopped";
    } catch (const core::Error& error) {
      EXPECT_EQ(error.kind(), core::ErrorKind::kCancelled) << error.what();
    }
    ExpectNothingWritten(folder.path());
  }
}

TEST(BackgroundCommand, NeedsLiveCamerasAndEnoughPictures) {
  const TemporaryFolder folder;
  const ServedRig served(EmptySets(), kRateHz);
  const std::filesystem::path rig = WriteLiveRig(served, folder.path());
  EXPECT_THAT(TakeBackground(rig, folder / "empty", {"--seconds", "0.2"}).err,
              HasSubstr("a background needs 10"));
  recon::RigFile recorded = recon::ReadRigFile(rig);
  for (recon::CameraSources& sources : recorded.sources) sources.frames = "/nowhere/video.avi";
  recon::WriteRigFile(recorded, rig);
  EXPECT_THAT(TakeBackground(rig, folder / "empty").err, HasSubstr("has no live cameras"));
  ExpectNothingWritten(folder.path());
}

}  // namespace
}  // namespace elbowroom
