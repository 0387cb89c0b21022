#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <limits>

#include "cad_import/mesh_file.h"
#include "core/error.h"
#include "tests/cad_import/error_of.h"
#include "tests/core/solids.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::cad_import {
namespace {

using core::ErrorKind;
using core::LengthUnit;
using core::TriangleMesh;
using testing::ErrorOf;
using testing::Mentions;

constexpr double kSinglePrecision = 2e-7;  // of the largest coordinate: files hold floats

// A ball of about 2,000 triangles, off centre: coordinates of no round numbers.
TriangleMesh Ball() {
  constexpr int kRings = 24, kSectors = 48;
  TriangleMesh mesh;
  const Eigen::Vector3d centre_mm(123.4, -56.7, 890.1);
  mesh.vertices_mm.push_back(centre_mm + Eigen::Vector3d(0, 0, 70));
  for (int ring = 1; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      const double polar = M_PI * ring / kRings, azimuth = 2 * M_PI * sector / kSectors;
      mesh.vertices_mm.push_back(centre_mm + 70 * Eigen::Vector3d(std::sin(polar) * std::cos(azimuth),
                                                                  std::sin(polar) * std::sin(azimuth),
                                                                  std::cos(polar)));
    }
  }
  mesh.vertices_mm.push_back(centre_mm - Eigen::Vector3d(0, 0, 70));
  const auto at = [](int ring, int sector) { return 1 + (ring - 1) * kSectors + sector % kSectors; };
  const int south = 1 + (kRings - 1) * kSectors;
  for (int s = 0; s < kSectors; ++s) {
    mesh.triangles.push_back({0, at(1, s), at(1, s + 1)});
    mesh.triangles.push_back({south, at(kRings - 1, s + 1), at(kRings - 1, s)});
    for (int r = 1; r < kRings - 1; ++r) {
      mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
  }
  return mesh;
}

class MeshWriter : public ::testing::TestWithParam<const char*> {
 protected:
  test_support::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Formats, MeshWriter, ::testing::Values("ply", "stl", "glb"),
                         [](const auto& format) { return std::string(format.param); });

TEST_P(MeshWriter, ComesBackWithSizeTrianglesAndClosedness) {
  const TriangleMesh ball = Ball();
  ASSERT_TRUE(core::IsWatertight(ball));
  const auto path = folder_ / (std::string("ball.") + GetParam());
  WriteMeshFile(ball, path);
  const ImportedMesh back = ImportMeshFile(path, {.unit_if_file_has_none = LengthUnit::kMillimetre});
  EXPECT_EQ(back.report.triangles, static_cast<std::int64_t>(ball.triangles.size()));
  EXPECT_EQ(back.mesh->vertices_mm.size(), ball.vertices_mm.size());
  EXPECT_TRUE(back.report.watertight);
  EXPECT_FALSE(back.report.repaired);
  EXPECT_TRUE(back.report.warnings.empty()) << back.report.warnings.front();
  const double tolerance_mm = kSinglePrecision * core::BoundsOf(ball).max().cwiseAbs().maxCoeff();
  EXPECT_LT((core::BoundsOf(*back.mesh).min() - core::BoundsOf(ball).min()).norm(), tolerance_mm);
  EXPECT_LT((core::BoundsOf(*back.mesh).max() - core::BoundsOf(ball).max()).norm(), tolerance_mm);
  EXPECT_NEAR(core::VolumeMm3(*back.mesh) / core::VolumeMm3(ball), 1.0,
              1e-5);  // area times rounding over volume
}

TEST_P(MeshWriter, ReplacesAnOlderFileAndLeavesNothingElse) {
  const auto path = folder_ / (std::string("box.") + GetParam());
  test_support::WriteText(path, "older");
  WriteMeshFile(core::testing::Box({1, 2, 3}), path);
  EXPECT_EQ(ImportMeshFile(path, {.unit_if_file_has_none = LengthUnit::kMillimetre}).report.triangles, 12);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

TEST_P(MeshWriter, BadMeshesAndPlacesLeaveNoFile) {
  const auto path = folder_ / (std::string("bad.") + GetParam());
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kGeometry, [&] { WriteMeshFile({}, path); }), "no triangles"));
  TriangleMesh with_nan = core::testing::Box({1, 1, 1});
  with_nan.vertices_mm[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kGeometry, [&] { WriteMeshFile(with_nan, path); }), "bad."));
  const auto nowhere = folder_ / "missing" / path.filename();
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kFile,
                               [&] {
                                 WriteMeshFile(core::testing::Box({1, 1, 1}), nowhere);
                               }),
                       "can't be written"));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST(WriteMeshFile, OtherExtensionsAreRefused) {
  const test_support::TemporaryFolder folder;
  for (const char* name : {"a.obj", "a.gltf", "a.step", "a"}) {
    EXPECT_THROW(WriteMeshFile(core::testing::Box({1, 1, 1}), folder / name), core::Error);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Read by what other programs go by, not by this project's reader.
TEST(WriteMeshFile, GlbHoldsMetres) {
  const test_support::TemporaryFolder folder;
  WriteMeshFile(core::testing::Box({1000, 2000, 3000}), folder / "box.glb");
  const std::string bytes = test_support::ReadText(folder / "box.glb");
  EXPECT_TRUE(bytes.starts_with("glTF"));
  const std::size_t at = bytes.find("\"max\":[");
  ASSERT_NE(at, std::string::npos);
  double largest_m = 0.0;  // of the position accessor: the indices' maximum is 7
  for (std::size_t from = at; from != std::string::npos; from = bytes.find("\"max\":[", from + 1)) {
    const std::string list = bytes.substr(from + 7, bytes.find(']', from) - from - 7);
    if (std::count(list.begin(), list.end(), ',') == 2)
      largest_m = std::stod(list.substr(list.rfind(',') + 1));
  }
  EXPECT_DOUBLE_EQ(largest_m, 3.0);
}

TEST(WriteMeshFile, PlyIsBinaryLittleEndianMillimetres) {
  const test_support::TemporaryFolder folder;
  WriteMeshFile(core::testing::Box({1, 2, 3}), folder / "box.ply");
  const std::string bytes = test_support::ReadText(folder / "box.ply");
  EXPECT_TRUE(Mentions(bytes, "format binary_little_endian 1.0"));
  EXPECT_TRUE(Mentions(bytes, "element vertex 8"));
  EXPECT_TRUE(Mentions(bytes, "element face 12"));
}

}  // namespace
}  // namespace elbowroom::cad_import
