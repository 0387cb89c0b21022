// The models that assimp is tested with, where Debian's assimp-testmodels is installed. Sizes are those that
// other readers give (docs/cad_models.md).
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "cad_import/cad_file.h"
#include "core/error.h"
#include "tests/cad_models/model_files.h"

namespace elbowroom::cad_import {
namespace {

using cad_models::ModelFile;

constexpr const char* kPackage = "assimp-testmodels";
constexpr ImportLimits kDebianLimits{.memory_bytes = std::int64_t{1} << 30, .time_s = 60.0};
constexpr double kNodePrecision = 1e-5;  // relative: nodes are placed one upon another
constexpr long kMostGrowthKb = 100'000;  // the models are small

#define SKIP_WITHOUT(files)                                                                             \
  if (!(files).has_value()) {                                                                           \
    GTEST_SKIP() << "NOT TESTED: Debian's package " << kPackage << " is not installed on this machine"; \
  }

// By folder or name.
bool IsInvalid(const std::string& name) {
  constexpr std::array<std::string_view, 11> kInvalid = {
      "/invalid/",       "/invalid.",      "IndexOutOfRange", "MissingBin",
      "RecursiveNodes",  "SchemaFailures", "TestNoRootNode",  "IncorrectVertex",
      "BoxWithInfinite", "wrongTypes",     "transparentTest"};
  return std::ranges::any_of(kInvalid, [&](auto part) { return name.find(part) != std::string::npos; });
}

long MaxRssKb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

// One of them asks for terabytes, one hangs on itself; what can be saved of two is said to be less.
TEST(DebianModels, InvalidOnesEndInOneLineOrAWarning) {
  const auto files = cad_models::FilesOfPackage(kPackage);
  SKIP_WITHOUT(files);
  int refused = 0, imported = 0;
  const long before_kb = MaxRssKb();
  for (const ModelFile& file : *files) {
    if (!IsInvalid(file.name)) continue;
    try {
      const CadModel model = ImportCadFile(
          file.path, {.unit_if_file_has_none = core::LengthUnit::kMillimetre, .limits = kDebianLimits});
      EXPECT_FALSE(model.report.warnings.empty()) << file.name;
      ++imported;
    } catch (const core::Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_TRUE(message.starts_with(file.path.string() + ": ")) << message;
      EXPECT_EQ(message.find("its reader crashed"), std::string::npos) << message;
      ++refused;
    }
  }
  EXPECT_LT(MaxRssKb() - before_kb, kMostGrowthKb);
  EXPECT_GE(refused, 20);
  EXPECT_LE(imported, 2);
}

struct ExpectedModel {
  const char* ending;
  std::int64_t parts;
  std::int64_t triangles;
  const char* unit;
  Eigen::Vector3d size_mm;
};

// In the names of tests.
void PrintTo(const ExpectedModel& expected, std::ostream* out) { *out << expected.ending; }

class DebianModel : public ::testing::TestWithParam<ExpectedModel> {};

TEST_P(DebianModel, HasItsPartsItsTrianglesAndItsSize) {
  const auto files = cad_models::FilesOfPackage(kPackage);
  SKIP_WITHOUT(files);
  const ExpectedModel& expected = GetParam();
  const auto file = std::ranges::find_if(
      *files, [&](const ModelFile& model) { return model.name.ends_with(expected.ending); });
  ASSERT_NE(file, files->end());
  const ImportReport report =
      ImportCadFile(file->path, {.unit_if_file_has_none = core::LengthUnit::kMillimetre}).report;
  EXPECT_EQ(report.parts, expected.parts);
  EXPECT_EQ(report.triangles + report.dropped_triangles, expected.triangles);
  EXPECT_EQ(report.unit, expected.unit);
  EXPECT_TRUE(report.bounds_mm.sizes().isApprox(expected.size_mm, kNodePrecision))
      << report.bounds_mm.sizes().transpose();
}

INSTANTIATE_TEST_SUITE_P(
    Files, DebianModel,
    ::testing::Values(
        ExpectedModel{"3DS/fels.3ds", 1, 768, "mm", {3.504798, 3.205552, 4.681601}},
        ExpectedModel{"3MF/box.3mf", 1, 12, "mm", {10, 20, 30}},
        ExpectedModel{"Collada/cube_UTF16LE.dae", 1, 12, "cm", {1000, 1000, 1000}},
        ExpectedModel{"Collada/duck.dae", 1, 4212, "cm", {1654.784, 1540.406, 1152.534}},
        ExpectedModel{
            "Collada/teapots.DAE", 3, 2976, "cm", {1006.5007, 1285.3010, 493.2196}},  // decimal commas
        ExpectedModel{
            "FBX/cubes_with_mirroring_and_pivot.fbx", 4, 420, "m", {209.32762, 304.96148, 327.71107}},
        ExpectedModel{"FBX/huesitos.fbx", 1, 120, "cm", {5357.72252, 5438.37266, 3215.35042}},
        ExpectedModel{"OBJ/box_UTF16BE.obj", 1, 12, "mm", {1, 1, 1}},
        ExpectedModel{"OFF/Wuson.off", 51, 3732, "mm", {0.919952, 1.515817, 3.244484}},
        ExpectedModel{"PLY/Wuson.ply", 51, 3732, "mm", {0.919952, 1.515817, 3.244484}},
        ExpectedModel{"STL/Wuson.stl", 51, 3732, "mm", {0.919952, 1.515817, 3.244484}}),
    [](const auto& test) {
      std::string name = test.param.ending;
      std::ranges::replace_if(
          name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
      return name;
    });

TEST(DebianModels, CamerasAndLightsAreNoParts) {
  const auto files = cad_models::FilesOfPackage(kPackage);
  SKIP_WITHOUT(files);
  int checked = 0;
  for (const ModelFile& file : *files) {
    if (!file.name.ends_with("Collada/cameras.dae") && !file.name.ends_with("Collada/lights.dae")) continue;
    EXPECT_THROW((void)ImportCadFile(file.path), core::Error) << file.name;
    ++checked;
  }
  EXPECT_EQ(checked, 2);
}

}  // namespace
}  // namespace elbowroom::cad_import
