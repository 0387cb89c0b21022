// What is found of a rig before a trial, row by row.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "app/control/preflight/preflight.h"
#include "app/control/preflight/preflight_rig.h"
#include "core/error.h"
#include "core/system/utc_time.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using test_support::TemporaryFolder;
using test_support::WriteText;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

// A live rig of four cameras; each one's background is a picture in `folder`, which isn't written yet.
recon::RigFile LiveRigIn(const fs::path& folder) {
  recon::RigFile rig_file{recon::FourCameraRig()};
  for (const core::CameraModel& camera : rig_file.rig.cameras)
    rig_file.sources.push_back({"gige:" + camera.name(), (folder / (camera.name() + ".png")).string(), ""});
  return rig_file;
}

const PreflightRow& RowOf(const std::vector<PreflightRow>& rows, const std::string& subject) {
  const auto found = std::ranges::find(rows, subject, &PreflightRow::subject);
  EXPECT_NE(found, rows.end()) << subject;
  return *found;
}

TEST(Preflight, ABackgroundThatIsLackingIsAFaultThatNamesTheCamera) {
  const TemporaryFolder folder;
  recon::RigFile rig_file = LiveRigIn(folder.path());
  for (const std::size_t there : {0U, 1U, 3U}) WriteText(rig_file.sources[there].background, "x");
  const PreflightRow lacking = RowOf(RigRows(rig_file, folder.path()), "Background");
  EXPECT_EQ(lacking.state, PreflightState::kFault);
  EXPECT_THAT(lacking.finding, HasSubstr(rig_file.rig.cameras[2].name()));
  EXPECT_THAT(lacking.advice.at(0), HasSubstr("take the background"));
  rig_file.sources[2].masks = "masks/%04d.png";  // needs none
  EXPECT_EQ(RowOf(RigRows(rig_file, folder.path()), "Background").state, PreflightState::kWell);
}

TEST(Preflight, AnOldBackgroundIsToldWithItsAge) {
  const TemporaryFolder folder;
  recon::RigFile rig_file = LiveRigIn(folder.path());
  for (const auto& sources : rig_file.sources) WriteText(sources.background, "x");
  EXPECT_THAT(RowOf(RigRows(rig_file, folder.path()), "Background").finding, HasSubstr("0 min ago"));
  fs::last_write_time(rig_file.sources[1].background,
                      fs::file_time_type::clock::now() - std::chrono::hours(72));
  const PreflightRow old = RowOf(RigRows(rig_file, folder.path()), "Background");
  EXPECT_EQ(old.state, PreflightState::kAttention);
  EXPECT_THAT(old.finding, HasSubstr("3 days ago"));
}

TEST(Preflight, TheAgeOfASequenceIsThatOfItsNewestPicture) {
  const TemporaryFolder folder;
  recon::RigFile rig_file = LiveRigIn(folder.path());
  for (auto& sources : rig_file.sources) sources.background = (folder / "%04d.png").string();
  EXPECT_EQ(RowOf(RigRows(rig_file, folder.path()), "Background").state, PreflightState::kFault);
  WriteText(folder / "0000.png", "x");
  WriteText(folder / "0001.png", "x");
  fs::last_write_time(folder / "0000.png", fs::file_time_type::clock::now() - std::chrono::hours(72));
  EXPECT_EQ(RowOf(RigRows(rig_file, folder.path()), "Background").state, PreflightState::kWell);
}

TEST(Preflight, CalibrationIsJudgedByItsAgeItsErrorsAndTheGauge) {
  const TemporaryFolder folder;
  recon::RigFile rig_file = LiveRigIn(folder.path());
  const auto row = [&] { return RowOf(RigRows(rig_file, folder.path()), "Calibration"); };
  EXPECT_EQ(row().state, PreflightState::kAttention);
  EXPECT_THAT(row().finding, HasSubstr("says nothing"));
  rig_file.calibration = recon::RigCalibration{core::NowUtc(), "board", 0.3, std::nullopt, 0.2, {}};
  EXPECT_EQ(row().state, PreflightState::kWell);
  EXPECT_THAT(row().advice, IsEmpty());
  std::size_t parameters = 0;
  for (const core::CameraModel& camera : rig_file.rig.cameras)
    parameters += 11 + camera.calibration().distortion_coefficients.size();
  const auto size = static_cast<Eigen::Index>(parameters);
  rig_file.calibration->covariance = 1e-8 * Eigen::MatrixXd::Identity(size, size);
  EXPECT_THAT(row().finding, HasSubstr("a point is known to ±"));
  EXPECT_GT(PointErrorsMm(rig_file)->median, 0.0);
  rig_file.calibration->made = "2020-01-01T00:00:00Z";
  EXPECT_EQ(row().state, PreflightState::kAttention);
  rig_file.gauge = core::RigGauge{"", 20.0, 23.0, 3.0, 1.0, 5, false};
  EXPECT_EQ(row().state, PreflightState::kFault);
  EXPECT_THAT(row().finding, HasSubstr("3.00 mm off"));
}

TEST(Preflight, DaysBetweenTwoTimes) {
  EXPECT_DOUBLE_EQ(DaysSince("2026-02-27T06:00:00Z", "2026-03-01T12:00:00Z").value(), 2.25);
  EXPECT_FALSE(DaysSince("", "2026-03-01T12:00:00Z"));
  EXPECT_FALSE(DaysSince("2026-13-01T12:00:00Z", "2026-03-01T12:00:00Z"));
}

TEST(Preflight, DiskSpaceIsThatOfTheFolderThatTheSessionWillBeIn) {
  const TemporaryFolder folder;
  const auto rows = RigRows(LiveRigIn(folder.path()), folder / "not" / "there" / "yet");
  EXPECT_THAT(RowOf(rows, "Disk").finding, HasSubstr("GB free in " + folder.path().string()));
}

CameraHealth WellCamera(const std::string& name) {
  CameraHealth camera;
  camera.name = name;
  camera.state.presence = recon::CameraPresence::kRunning;
  camera.frames = 150;
  camera.rate_hz = 30.0;
  camera.latency_ms = core::Spread{6.0, 7.0, 9.0};
  camera.skew_ms = core::Spread{0.4, 0.5, 0.6};
  return camera;
}

TEST(Preflight, EachCameraHasARowWithTheMostUrgentAdviceFirst) {
  RigHealth health;
  health.sets = 150;
  health.cameras = {WellCamera("cam1"), WellCamera("cam2"), WellCamera("cam3"), WellCamera("cam4")};
  health.cameras[1].advice = {"its picture is dark", "it looks 9 ms beside the others"};
  health.cameras[1].losses[core::LossReason::kIncomplete] = 3;
  health.cameras[2].state.presence = recon::CameraPresence::kGone;
  health.cameras[2].advice = {"it is gone: no answer"};
  health.cameras[3].frames = 0;
  const std::vector<PreflightRow> rows = CameraRows(health);
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_EQ(rows[0].state, PreflightState::kWell);
  EXPECT_EQ(rows[0].finding, "30.0 Hz, 0 lost, 6 ms late, skew 0.4 ms");
  EXPECT_EQ(rows[1].state, PreflightState::kAttention);
  EXPECT_EQ(rows[1].advice.at(0), "its picture is dark");
  EXPECT_THAT(rows[1].finding, HasSubstr("3 lost"));
  EXPECT_EQ(rows[2].state, PreflightState::kFault);
  EXPECT_EQ(rows[3].state, PreflightState::kFault);
  EXPECT_FALSE(rows[3].advice.empty());
  EXPECT_EQ(rows[4].state, PreflightState::kWell);
  health.incomplete_sets = 30;
  EXPECT_EQ(CameraRows(health)[4].state, PreflightState::kAttention);
  EXPECT_THAT(CameraRows(health)[4].finding, HasSubstr("120 of 150"));
}

TEST(PreflightRig, IsFoundThroughTheTrialWithoutOpeningItsCameras) {
  const TemporaryFolder folder;
  recon::WriteRigFile(LiveRigIn(folder.path()), folder / "rig.yml");
  WriteText(folder / "trial.toml", "rig = \"rig.yml\"\nlayout = \"none.toml\"\n");
  for (const char* name : {"trial.toml", "rig.yml"}) {
    const PreflightRig rig = ReadPreflightRig(folder / name);
    EXPECT_TRUE(rig.is_live);
    EXPECT_EQ(rig.path, folder / "rig.yml");
    EXPECT_EQ(rig.rig_file.rig.cameras.size(), 4U);
  }
  WriteText(folder / "trial.toml", "layout = \"none.toml\"\n");
  EXPECT_THROW((void)ReadPreflightRig(folder / "trial.toml"), core::Error);
  recon::RigFile recorded = LiveRigIn(folder.path());
  for (auto& sources : recorded.sources) sources.frames = (folder / "video.avi").string();
  recon::WriteRigFile(recorded, folder / "rig.yml");
  EXPECT_FALSE(ReadPreflightRig(folder / "rig.yml").is_live);
}

}  // namespace
}  // namespace elbowroom::control
