// STEP files that nobody here made: ../shared/data/cad/step, where it is present. Volumes are those of its
// README, sizes those that OpenCASCADE's own bounding box of the faces gives.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include <filesystem>
#include <ostream>
#include <string>

#include "cad_import/cad_file.h"
#include "core/error.h"
#include "tests/support/places.h"

namespace elbowroom::cad_import {
namespace {

const std::filesystem::path kStep = test_support::SharedDataFolder() / "cad/step";

struct Expected {
  const char* file;
  std::int64_t parts;
  const char* unit;
  Eigen::Vector3d size_mm;
  double volume_mm3;  // 0: not told
};

// In the names of tests.
void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.file; }

class SharedStep : public ::testing::TestWithParam<Expected> {};

TEST_P(SharedStep, HasItsSizeItsPartsAndItsVolume) {
  if (!std::filesystem::is_directory(kStep))
    GTEST_SKIP() << "NOT TESTED: " << kStep << " is not on this machine";
  const Expected& expected = GetParam();
  const CadModel model = ImportCadFile(kStep / expected.file);
  const ImportReport& report = model.report;
  EXPECT_EQ(report.parts, expected.parts);
  EXPECT_EQ(report.unit, expected.unit);
  EXPECT_TRUE(report.watertight);
  // A bound of curved faces is reached by no vertex: it may be off by the tolerance at each end.
  EXPECT_TRUE((report.bounds_mm.sizes() - expected.size_mm).cwiseAbs().maxCoeff() <=
              2.0 * report.deviation_mm)
      << report.bounds_mm.sizes().transpose();
  EXPECT_LE(report.deviation_mm, kUsualToleranceMm);
  const FlatModel flat = Flatten(model);
  EXPECT_EQ(flat.mesh->deviation_mm, report.deviation_mm);
  if (expected.volume_mm3 == 0.0) return;
  // No more of the surface can be gained or lost than its area times the tolerance; measured: a hundredth of
  // that.
  const double most_mm3 = core::AreaMm2(*flat.mesh) * report.deviation_mm;
  EXPECT_NEAR(core::VolumeMm3(*flat.mesh), expected.volume_mm3, most_mm3 + 1e-3 * expected.volume_mm3);
}

INSTANTIATE_TEST_SUITE_P(
    Files, SharedStep,
    ::testing::Values(
        Expected{"ap203_ap214/as1-oc-214.stp", 18, "mm", {200, 150, 84}, 0.0},
        Expected{"ap203_ap214/base_interface_AP203.STEP", 1, "in", {599.412, 638.672, 4.7625}, 1.25799e6},
        Expected{"ap203_ap214/base_interface_AP214.STEP", 1, "in", {599.412, 638.672, 4.7625}, 1.25799e6},
        Expected{"ap203_ap214/box_sides.STEP", 10, "in", {184.15, 114.3, 95.25}, 0.0},
        Expected{"ap203_ap214/featuretype.STEP", 1, "in", {127, 63.5, 34.925}, 190'532.0},
        Expected{"nist_ap242/nist_ctc_01_asme1_ap242-e1.stp", 1, "mm", {800, 450, 150}, 1.464e7},
        Expected{"nist_ap242/nist_ctc_03_asme1_ap242-e2.stp", 1, "mm", {302.96, 485.445, 162.69}, 3.321e5},
        Expected{"nist_ap242/nist_ctc_05_asme1_ap242-e1.stp", 1, "in", {527.05, 558.8, 482.6}, 1.269e7},
        Expected{"nist_ap242/nist_stc_06_asme1_ap242-e3.stp", 1, "mm", {247.65, 304.8, 97.79}, 3.324e6}),
    [](const auto& test) {
      std::string name = std::filesystem::path(test.param.file).stem().string();
      std::ranges::replace_if(
          name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
      return name;
    });

TEST(SharedStep, AnAssemblySharesItsMeshes) {
  if (!std::filesystem::is_directory(kStep))
    GTEST_SKIP() << "NOT TESTED: " << kStep << " is not on this machine";
  const CadModel model = ImportCadFile(kStep / "ap203_ap214/as1-oc-214.stp");
  EXPECT_EQ(model.instances.size(), 18U);
  EXPECT_EQ(model.shapes.size(), 5U);  // nut, rod, bolt, bracket, plate
  EXPECT_EQ(model.instances.front().path.substr(0, 4), "as1/");
}

TEST(SharedStep, AnImplausibleSizeIsWarnedOfWithTheLikelyUnit) {
  if (!std::filesystem::is_directory(kStep))
    GTEST_SKIP() << "NOT TESTED: " << kStep << " is not on this machine";
  const CadModel model = ImportCadFile(kStep / "ap203_ap214/as1_pe_203.stp");
  EXPECT_EQ(model.report.parts, 18);
  EXPECT_NE(model.report.warnings.back().find(
                "is implausible for a payload; is its unit really in? If it is mm, that would be "
                "200 x 87 x 150 mm."),
            std::string::npos)
      << model.report.warnings.back();
  const CadModel in_mm =
      ImportCadFile(kStep / "ap203_ap214/as1_pe_203.stp", {.unit = core::LengthUnit::kMillimetre});
  EXPECT_TRUE(in_mm.report.bounds_mm.sizes().isApprox(Eigen::Vector3d(200, 87, 150), 1e-3));
}

}  // namespace
}  // namespace elbowroom::cad_import
