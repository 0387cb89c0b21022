// What verdicts allow for, from RIG.yml's covariance to the report, with the program as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "recon/rig_files/rig_file.h"
#include "sessions/session_reader.h"
#include "tests/app/mask_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

// Ready masks of a ball, and a box whose nearest face is at x = 75 mm, 15 mm from it.
class ErrorBudgetTrial : public testing::Test {
 protected:
  ErrorBudgetTrial() {
    rig_ = test_support::WriteBallRig(folder_.path() / "rig");
    test_support::WriteBoxStl(folder_ / "box.stl", 20.0);
    test_support::WriteText(
        folder_ / "layout.toml",
        "unit = \"mm\"\n[[part]]\nname = \"box\"\nfile = \"box.stl\"\nposition_mm = [85.0, "
        "0.0, 200.0]\n");
  }

  // Gives the rig a covariance of independent parameters: the cameras' places by so much along each axis, and
  // little else.
  void GiveCovariance(double place_mm) const {
    recon::RigFile file = recon::ReadRigFile(rig_);
    std::vector<double> sigmas;
    for (const core::CameraModel& camera : file.rig.cameras) {
      sigmas.insert(sigmas.end(), {0.02, 0.02, 0.02, 0.02});
      sigmas.insert(sigmas.end(), camera.calibration().distortion_coefficients.size(), 0.0);
      sigmas.insert(sigmas.end(), {1e-5, 1e-5, 1e-5, place_mm, place_mm, place_mm, 0.0});
    }
    const Eigen::VectorXd variances =
        Eigen::Map<Eigen::VectorXd>(sigmas.data(), static_cast<Eigen::Index>(sigmas.size())).array().square();
    file.calibration = recon::RigCalibration{
        "2026-11-01T00:00:00Z", "a board", 0.2, 0.3, 0.2, variances.asDiagonal().toDenseMatrix()};
    recon::WriteRigFile(file, rig_);
  }

  [[nodiscard]] test_support::ProgramRun Run(const std::string& more, double required_mm = 10.0) const {
    fs::remove(session_);
    test_support::WriteText(folder_ / "trial.toml",
                            "rig = \"rig/rig.yml\"\nlayout = \"layout.toml\"\nrequired_clearance_mm = " +
                                std::to_string(required_mm) + "\n" + more);
    return test_support::RunProgram(test_support::ProgramFile(),
                                    {"trial", "run", (folder_ / "trial.toml").string(), "--session",
                                     session_.string(), "--headless", "--json"});
  }

  [[nodiscard]] core::PartContact Recorded() const {
    return sessions::SessionReader(session_).ReadFrame(0).contacts.at(0);
  }

  [[nodiscard]] std::string Report() const {
    const fs::path out = folder_ / "report";
    const test_support::ProgramRun run = test_support::RunProgram(
        test_support::ProgramFile(), {"report", session_.string(), "--out", out.string()});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return test_support::ReadText(out / "report.html");
  }

  test_support::TemporaryFolder folder_;
  fs::path rig_;
  fs::path session_ = folder_ / "s.db";
};

TEST_F(ErrorBudgetTrial, WithoutACovarianceAllIsAsBefore) {
  const test_support::ProgramRun run = Run("");
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(Recorded().verdict, core::Verdict::kClear);
  EXPECT_FALSE(Recorded().clearance.value().budget);
  EXPECT_TRUE(nlohmann::json::parse(run.out)["parts"][0]["largest_uncertainty_mm"].is_null());
  EXPECT_THAT(Report(), HasSubstr("Verdicts allow for no error of the rig"));
}

TEST_F(ErrorBudgetTrial, IsComputedFromTheCovarianceAndDecides) {
  GiveCovariance(0.1);
  ASSERT_EQ(Run("").exit_status, 0);
  const core::PartContact exact = Recorded();
  const core::ErrorBudget little = exact.clearance.value().budget.value();
  EXPECT_EQ(exact.verdict, core::Verdict::kClear);
  EXPECT_GT(little.calibration_mm, 0.0);
  EXPECT_GT(little.footprint_mm, 0.0);     // ready masks end between pixels
  EXPECT_EQ(little.segmentation_mm, 0.0);  // nothing was segmented
  // The same part is undecided where the cameras are known to 5 mm.
  GiveCovariance(5.0);
  const test_support::ProgramRun run = Run("");
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const core::PartContact coarse = Recorded();
  const core::ErrorBudget much = coarse.clearance.value().budget.value();
  EXPECT_EQ(coarse.verdict, core::Verdict::kUndecided);
  EXPECT_GT(much.calibration_mm, 10.0 * little.calibration_mm);
  EXPECT_NEAR(much.footprint_mm, little.footprint_mm, 1e-9);
  const auto part = nlohmann::json::parse(run.out)["parts"][0];
  EXPECT_EQ(part["largest_uncertainty_mm"], much.ExpandedMm());
  EXPECT_EQ(part["largest_budget"]["calibration_mm"], much.calibration_mm);
  const std::string report = Report();
  EXPECT_THAT(report, HasSubstr("What a verdict allows for is computed"));
  EXPECT_THAT(report, HasSubstr("<td>box"));
}

TEST_F(ErrorBudgetTrial, ATypedInValueWins) {
  GiveCovariance(5.0);
  for (const char* value : {"0.0", "1.5"}) {
    ASSERT_EQ(Run(std::string("uncertainty_mm = ") + value + "\n").exit_status, 0);
    EXPECT_EQ(Recorded().verdict, core::Verdict::kClear);
    EXPECT_FALSE(Recorded().clearance.value().budget);
  }
  EXPECT_THAT(Report(), HasSubstr("Verdicts allow for 1.50 mm, as the trial says"));
}

TEST_F(ErrorBudgetTrial, TheSweepOfASessionAllowsForTheSame) {
  GiveCovariance(5.0);
  test_support::WriteText(
      folder_ / "layout.toml",
      "unit = \"mm\"\n[[part]]\nname = \"box\"\nfile = \"box.stl\"\nposition_mm = [85.0, 0.0, "
      "200.0]\n[[part]]\nname = \"wall\"\nfile = \"box.stl\"\nposition_mm = [-300.0, 0.0, "
      "200.0]\n[[spacing]]\nname = \"gap\"\nmoving = \"box\"\nreference = \"wall\"\naxis = "
      "\"x\"\nmin_mm = 0.0\nmax_mm = 500.0\ninitial_mm = 365.0\n");
  ASSERT_EQ(Run("").exit_status, 0);
  const core::PartContact recorded = Recorded();
  const test_support::ProgramRun sweep = test_support::RunProgram(
      test_support::ProgramFile(), {"sweep", session_.string(), "--spacing", "gap=355:375:10", "--out",
                                    (folder_ / "sweep").string(), "--json"});
  ASSERT_EQ(sweep.exit_status, 0) << sweep.err;
  EXPECT_EQ(recorded.verdict, core::Verdict::kUndecided);
  const std::string csv = test_support::ReadText(folder_ / "sweep" / "sweep.csv");
  EXPECT_THAT(csv, HasSubstr("365,box,1,0,0,1,0"));
}

TEST_F(ErrorBudgetTrial, AFailedGaugeDecidesNothingAndSaysSo) {
  core::RigGauge gauge{"2026-11-02T00:00:00Z", 10.0, 11.25, 1.25, 0.5, 27, false};
  recon::SaveGauge(gauge, rig_);
  const test_support::ProgramRun run = Run("");
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(Recorded().verdict, core::Verdict::kUndecided);
  EXPECT_THAT(run.out, HasSubstr("the gauge of rig"));
  EXPECT_EQ(sessions::SessionReader(session_).header().rig_quality.gauge, gauge);
  EXPECT_THAT(Report(), HasSubstr("gauge failed: a rod of 10.00&nbsp;mm measured 11.25&nbsp;mm"));
  // Without a required clearance, too.
  ASSERT_EQ(Run("", 0.0).exit_status, 0);
  EXPECT_EQ(Recorded().verdict, core::Verdict::kUndecided);
  gauge.passed = true;
  recon::SaveGauge(gauge, rig_);
  ASSERT_EQ(Run("").exit_status, 0);
  EXPECT_EQ(Recorded().verdict, core::Verdict::kClear);
  EXPECT_THAT(Report(), Not(HasSubstr("gauge failed")));
}

TEST_F(ErrorBudgetTrial, TheClearanceCommandSaysTheSame) {
  GiveCovariance(5.0);
  ASSERT_EQ(Run("").exit_status, 0);
  const core::ErrorBudget recorded = Recorded().clearance.value().budget.value();
  test_support::WriteText(folder_ / "pose.yml",
                          "%YAML:1.0\nrotation_world_from_part: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
                          "translation_world_from_part_mm: [85, 0, 200]\n");
  const auto clearance = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"clearance",
                                          rig_.string(),
                                          "--frame",
                                          "0",
                                          "--mesh",
                                          (folder_ / "box.stl").string(),
                                          "--world-from-part",
                                          (folder_ / "pose.yml").string(),
                                          "--unit",
                                          "mm",
                                          "--required",
                                          "10",
                                          "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const test_support::ProgramRun run = test_support::RunProgram(test_support::ProgramFile(), arguments);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return nlohmann::json::parse(run.out);
  };
  const auto computed = clearance({});
  EXPECT_EQ(computed["verdict"], "undecided");
  // The searches end at witness points up to the tolerance apart.
  EXPECT_NEAR(computed["uncertainty_mm"].get<double>() / recorded.ExpandedMm(), 1.0, 0.05);
  EXPECT_NEAR(computed["budget"]["calibration_mm"].get<double>() / recorded.calibration_mm, 1.0, 0.05);
  const auto given = clearance({"--uncertainty", "0.5"});
  EXPECT_EQ(given["verdict"], "clear");
  EXPECT_EQ(given["uncertainty_mm"], 0.5);
  EXPECT_TRUE(given["budget"].is_null());
}

}  // namespace
}  // namespace elbowroom
