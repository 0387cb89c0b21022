#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <limits>
#include <memory>

#include "cad_import/cad_file.h"
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

constexpr double kFloatPrecision = 2e-7;  // of the largest coordinate: files hold floats

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
  const double tolerance_mm = kFloatPrecision * core::BoundsOf(ball).max().cwiseAbs().maxCoeff();
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

// Two shapes, one of them in three places and two colours, in groups.
CadModel Rack() {
  CadModel model;
  const auto add_shape = [&](const char* name, const TriangleMesh& mesh) {
    model.shapes.push_back({name, std::make_shared<const TriangleMesh>(mesh), {}, {}});
  };
  add_shape("bolt", core::testing::Box({5, 5, 20}));
  add_shape("plate", core::testing::Box({200, 100, 3}));
  const ColorRgb steel{0.5F, 0.5F, 0.6F}, red{1.0F, 0.0F, 0.25F};
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  model.instances = {{"rack/plate", 1, {}, steel},
                     {"rack/bolts/left", 0, {turn, {10, 20, 30}}, steel},
                     {"rack/bolts/right", 0, {turn, {150, 20, 30}}, steel},
                     {"rack/spare", 0, {Eigen::Matrix3d::Identity(), {0, 0, 500}}, red}};
  return model;
}

TEST(WriteModelFile, GlbKeepsShapesInstancesPathsAndColours) {
  const test_support::TemporaryFolder folder;
  const CadModel model = Rack();
  WriteModelFile(model, folder / "rack.glb");
  const CadModel back = ImportCadFile(folder / "rack.glb");
  ASSERT_EQ(back.instances.size(), 4U);
  EXPECT_EQ(back.shapes.size(), 3U) << "a shape for each of its colours";
  EXPECT_EQ(back.instances[1].shape, back.instances[2].shape);
  for (const CadInstance& want : model.instances) {
    SCOPED_TRACE(want.path);
    const auto got = std::ranges::find(back.instances, want.path, &CadInstance::path);
    ASSERT_NE(got, back.instances.end());
    const double off_mm =
        (got->model_from_shape.translation_mm - want.model_from_shape.translation_mm).norm();
    EXPECT_LT(off_mm, 500.0 * kFloatPrecision);
    EXPECT_LT((got->model_from_shape.rotation - want.model_from_shape.rotation).norm(), 1e-6);
    ASSERT_TRUE(got->color);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR((*got->color)[i], (*want.color)[i], 1e-5);
    EXPECT_EQ(back.shapes[got->shape].mesh->triangles.size(),
              model.shapes[want.shape].mesh->triangles.size());
  }
  const core::SharedMesh flat = Flatten(model).mesh, flat_back = Flatten(back).mesh;
  EXPECT_TRUE(core::BoundsOf(*flat_back).isApprox(core::BoundsOf(*flat), 1e-6));
}

// Its bounds are widened by it wherever it is judged.
TEST(WriteModelFile, GlbKeepsWhatTessellationCost) {
  const test_support::TemporaryFolder folder;
  CadModel model = Rack();
  TriangleMesh bolt = *model.shapes[0].mesh;
  bolt.deviation_mm = 1.0 / 3.0;
  model.shapes[0].mesh = std::make_shared<const TriangleMesh>(std::move(bolt));
  WriteModelFile(model, folder / "rack.glb");
  const CadModel back = ImportCadFile(folder / "rack.glb");
  EXPECT_DOUBLE_EQ(back.report.deviation_mm, 1.0 / 3.0);
  EXPECT_EQ(back.report.parts, 4);
  for (const CadShape& shape : back.shapes) EXPECT_DOUBLE_EQ(shape.mesh->deviation_mm, 1.0 / 3.0);
  WriteModelFile(Rack(), folder / "exact.glb");
  EXPECT_EQ(ImportCadFile(folder / "exact.glb").report.deviation_mm, 0.0);
}

TEST(WriteModelFile, PathsWithoutACommonRootAreBelowTheFilesName) {
  const test_support::TemporaryFolder folder;
  CadModel model = Rack();
  model.instances = {{"left", 0, {}, std::nullopt}, {"group/right", 0, {}, std::nullopt}};
  WriteModelFile(model, folder / "pair.glb");
  const CadModel back = ImportCadFile(folder / "pair.glb");
  ASSERT_EQ(back.instances.size(), 2U);
  EXPECT_EQ(back.instances[0].path, "pair/left");
  EXPECT_EQ(back.instances[1].path, "pair/group/right");
}

TEST(WriteModelFile, OtherFormatsHoldAllInstancesInOneMesh) {
  const test_support::TemporaryFolder folder;
  const CadModel model = Rack();
  WriteModelFile(model, folder / "rack.stl");
  const ImportedMesh back = ImportMeshFile(folder / "rack.stl", {.unit = LengthUnit::kMillimetre});
  EXPECT_EQ(back.report.triangles, 48);
  EXPECT_TRUE(back.report.bounds_mm.isApprox(core::BoundsOf(*Flatten(model).mesh), 1e-6));
}

TEST(WriteModelFile, NothingLeavesNoFile) {
  const test_support::TemporaryFolder folder;
  for (const char* name : {"nothing.glb", "nothing.stl"})
    EXPECT_TRUE(
        Mentions(ErrorOf(ErrorKind::kGeometry, [&] { WriteModelFile({}, folder / name); }), "no triangles"));
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
