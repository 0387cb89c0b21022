// Meshes that nobody here made: ../shared/data/cad, where it is present.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cad_import/formats/file_format.h"
#include "cad_import/mesh_file.h"
#include "core/error.h"
#include "tests/support/places.h"

namespace elbowroom::cad_import {
namespace {

const std::filesystem::path kCad = test_support::SharedDataFolder() / "cad";

#define SKIP_WITHOUT_SHARED_DATA()                                                              \
  if (!std::filesystem::is_directory(kCad)) {                                                   \
    GTEST_SKIP() << "NOT TESTED: the real CAD files of " << kCad << " are not on this machine"; \
  }

ImportedMesh ImportMetres(const std::string& name) {
  return ImportMeshFile(kCad / "nasa42" / name, {.unit = core::LengthUnit::kMetre});
}

TEST(SharedCad, CubeSatsHaveExactlyTheirVolume) {
  SKIP_WITHOUT_SHARED_DATA();
  // Files of decimal numbers read in single precision.
  constexpr double kRelative = 1e-6;
  const std::map<std::string, double> kVolumesM3 = {{"Cubesat_1U.obj", 0.001},
                                                    {"Cubesat_3U.obj", 0.003},
                                                    {"Cubesat_6U.obj", 0.006},
                                                    {"TestSlab1.obj", 100.0}};
  for (const auto& [name, volume_m3] : kVolumesM3) {
    const ImportedMesh imported = ImportMetres(name);
    EXPECT_TRUE(imported.report.watertight) << name;
    EXPECT_NEAR(core::VolumeMm3(*imported.mesh) / 1e9, volume_m3, volume_m3 * kRelative) << name;
  }
}

// Its modeller wrote 1e-17 for 0 here and there; its STEP twin has 190,532 mm3.
TEST(SharedCad, AnExportWithNoiseAroundZeroIsClosedWithItsTwinsVolume) {
  SKIP_WITHOUT_SHARED_DATA();
  constexpr double kFacetsForArcs = 1e-4;  // relative
  const ImportedMesh imported =
      ImportMeshFile(kCad / "trimesh_models" / "featuretype.STL", {.unit = core::LengthUnit::kInch});
  EXPECT_TRUE(imported.report.watertight);
  EXPECT_NEAR(core::VolumeMm3(*imported.mesh), 190'532.0, 190'532.0 * kFacetsForArcs);
}

TEST(SharedCad, HubbleIsMadeOfManyPartsSomeTrianglesWithoutArea) {
  SKIP_WITHOUT_SHARED_DATA();
  const ImportedMesh hubble = ImportMetres("HST.obj");
  EXPECT_EQ(hubble.report.parts, 173);
  // Its degenerate triangles have three different corners each and close the surface.
  EXPECT_TRUE(hubble.report.watertight);
  ASSERT_FALSE(hubble.report.warnings.empty());
  EXPECT_NE(hubble.report.warnings[0].find("12 triangles have no area but hold"), std::string::npos);
}

TEST(SharedCad, ANonManifoldTrussIsNotCalledWatertight) {
  SKIP_WITHOUT_SHARED_DATA();
  const ImportedMesh truss = ImportMetres("ISS_SolarTruss.obj");
  EXPECT_FALSE(truss.report.watertight);
  EXPECT_FALSE(truss.report.warnings.empty());
}

// 182 of its edges are of one triangle (counted by an independent script): holes under its feet.
TEST(SharedCad, TheBunnysHolesAreSeen) {
  SKIP_WITHOUT_SHARED_DATA();
  const auto bunny = kCad.parent_path() / "bunny6" / "ground_truth.ply";
  const ImportedMesh imported = ImportMeshFile(bunny, {.unit = core::LengthUnit::kMillimetre});
  EXPECT_EQ(imported.report.parts, 1);
  EXPECT_EQ(imported.report.triangles, 30338);
  EXPECT_EQ(imported.mesh->vertices_mm.size(), 15258U);
  EXPECT_FALSE(imported.report.watertight);
  ASSERT_EQ(imported.report.warnings.size(), 2U);
  EXPECT_NE(imported.report.warnings[0].find("runs through itself"), std::string::npos);
  EXPECT_NE(imported.report.warnings[1].find("182 open edges"), std::string::npos);
}

// Enough for every sound file.
constexpr ImportLimits kSharedLimits{.memory_bytes = std::int64_t{2} << 30, .time_s = 60.0};

bool IsMeshFile(const std::filesystem::path& path) {
  try {
    (void)FormatOfExtension(path);
    return true;
  } catch (const core::Error&) {
    return false;
  }
}

// Broken on purpose, many of them: each is imported or refused with one line, none ends the program.
TEST(SharedCad, EveryMeshFileIsImportedOrRefusedNeverACrash) {
  SKIP_WITHOUT_SHARED_DATA();
  int imported = 0, refused = 0;
  for (const char* folder : {"trimesh_models", "assimp_invalid", "nasa42"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kCad / folder)) {
      if (!entry.is_regular_file() || !IsMeshFile(entry.path())) continue;
      try {
        (void)ImportMeshFile(entry.path(), {.unit = core::LengthUnit::kMillimetre, .limits = kSharedLimits});
        ++imported;
      } catch (const core::Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_TRUE(message.starts_with(entry.path().string())) << message;
        ++refused;
      }
    }
  }
  // Most of them are sound; a reader that refuses everything must not pass.
  EXPECT_GT(imported, 100);
  EXPECT_GT(refused, 5);
  RecordProperty("imported", imported);
  RecordProperty("refused", refused);
}

}  // namespace
}  // namespace elbowroom::cad_import
