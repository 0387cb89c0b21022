// Meshes with a number at each vertex, as other programs read them: CGAL .ply and .stl, assimp .glb and .stl.
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh/IO/PLY.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <array>
#include <assimp/Importer.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "cad_import/mesh_file.h"
#include "core/error.h"
#include "tests/cad_import/error_of.h"
#include "tests/core/solids.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::cad_import {
namespace {

using core::ErrorKind;
using Point = CGAL::Simple_cartesian<double>::Point_3;
using Surface = CGAL::Surface_mesh<Point>;

core::TriangleMesh Brick() { return core::testing::Box({100, 200, 300}); }

// 0.5, 1.5, ... seconds; from black to white; a name that would end the line and the JSON.
VertexField DwellOf(const core::TriangleMesh& mesh) {
  VertexField field{"dwell_s", {}, {}, {{"error", "at most 4 mm"}, {"session", "a\"b\n</script>.db"}}};
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
    field.values.push_back(0.5 + static_cast<double>(i));
    const float share = static_cast<float>(i) / static_cast<float>(mesh.vertices_mm.size() - 1);
    field.colors.push_back({share, share, share});
  }
  return field;
}

std::string WrittenAs(const std::filesystem::path& file) {
  WriteFieldFile(Brick(), DwellOf(Brick()), file);
  return test_support::ReadText(file);
}

TEST(WriteFieldFile, CgalReadsPlyWithTheValueOfEachVertex) {
  const test_support::TemporaryFolder folder;
  WrittenAs(folder / "brick.ply");
  Surface surface;
  std::string comments;
  std::ifstream stream(folder / "brick.ply", std::ios::binary);
  ASSERT_TRUE(CGAL::IO::read_PLY(stream, surface, comments));
  EXPECT_NE(comments.find("error: at most 4 mm"), std::string::npos) << comments;
  EXPECT_NE(comments.find("session: a\"b </script>.db"), std::string::npos) << comments;
  const auto [dwell_s, has_dwell] = surface.property_map<Surface::Vertex_index, float>("v:dwell_s");
  ASSERT_TRUE(has_dwell);
  const core::TriangleMesh brick = Brick();
  ASSERT_EQ(surface.number_of_vertices(), brick.vertices_mm.size());
  EXPECT_EQ(surface.number_of_faces(), brick.triangles.size());
  EXPECT_TRUE(CGAL::is_closed(surface));
  std::size_t i = 0;
  for (const Surface::Vertex_index vertex : surface.vertices()) {
    const Point& point = surface.point(vertex);
    EXPECT_EQ(Eigen::Vector3d(point.x(), point.y(), point.z()), brick.vertices_mm[i]);
    EXPECT_EQ(dwell_s[vertex], 0.5F + static_cast<float>(i++));
  }
}

TEST(WriteFieldFile, StlIsReadByCgalAndByAssimp) {
  const test_support::TemporaryFolder folder;
  const std::string bytes = WrittenAs(folder / "brick.stl");
  EXPECT_EQ(bytes.size(), 84 + 50 * Brick().triangles.size());
  EXPECT_TRUE(bytes.starts_with("elbowroom; error: at most 4 mm")) << bytes.substr(0, 80);
  std::vector<Point> points;
  std::vector<std::array<std::size_t, 3>> triangles;
  ASSERT_TRUE(CGAL::IO::read_STL((folder / "brick.stl").string(), points, triangles));
  EXPECT_EQ(points.size(), 8U);
  EXPECT_EQ(triangles.size(), Brick().triangles.size());
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile((folder / "brick.stl").string(), 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  EXPECT_EQ(scene->mMeshes[0]->mNumFaces, Brick().triangles.size());
}

TEST(WriteFieldFile, AssimpReadsGlbInMetresWithColours) {
  const test_support::TemporaryFolder folder;
  WrittenAs(folder / "brick.glb");
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile((folder / "brick.glb").string(), aiProcess_ValidateDataStructure);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 1U);
  const aiMesh& mesh = *scene->mMeshes[0];
  const core::TriangleMesh brick = Brick();
  ASSERT_EQ(mesh.mNumVertices, brick.vertices_mm.size());
  EXPECT_EQ(mesh.mNumFaces, brick.triangles.size());
  ASSERT_TRUE(mesh.HasVertexColors(0));
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& at = mesh.mVertices[i];
    EXPECT_LT((Eigen::Vector3f(at.x, at.y, at.z).cast<double>() * 1000.0 - brick.vertices_mm[i]).norm(),
              1e-4);
  }
  EXPECT_EQ(mesh.mColors[0][0].r, 0.0F);
  EXPECT_EQ(mesh.mColors[0][mesh.mNumVertices - 1].r, 1.0F);
}

std::uint32_t WordAt(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

// By the specification of glTF 2.0: a header of 12 bytes, then chunks of their length, type and bytes.
TEST(WriteFieldFile, GlbHasTheValuesAsAnAttribute) {
  const test_support::TemporaryFolder folder;
  const std::string bytes = WrittenAs(folder / "brick.glb");
  ASSERT_EQ(WordAt(bytes, 8), bytes.size());
  const std::size_t json_bytes = WordAt(bytes, 12), data_at = 20 + json_bytes + 8;
  const auto json = nlohmann::json::parse(bytes.substr(20, json_bytes));
  EXPECT_EQ(json["asset"]["extras"]["session"], "a\"b\n</script>.db");
  const auto& attributes = json["meshes"][0]["primitives"][0]["attributes"];
  ASSERT_TRUE(attributes.contains("_DWELL_S"));
  const auto& accessor = json["accessors"][attributes["_DWELL_S"].get<std::size_t>()];
  EXPECT_EQ(accessor["componentType"], 5126);
  EXPECT_EQ(accessor["type"], "SCALAR");
  ASSERT_EQ(accessor["count"], 8);
  const auto& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  for (std::size_t i = 0; i < 8; ++i) {
    float value = 0.0F;
    std::memcpy(&value, bytes.data() + data_at + view["byteOffset"].get<std::size_t>() + 4 * i, sizeof value);
    EXPECT_EQ(value, 0.5F + static_cast<float>(i));
  }
}

TEST(WriteFieldFile, BadMeshesAndPlacesLeaveNoFile) {
  const test_support::TemporaryFolder folder;
  for (const char* name : {"bad.ply", "bad.stl", "bad.glb"}) {
    core::TriangleMesh with_nan = Brick();
    with_nan.vertices_mm[0].x() = std::numeric_limits<double>::quiet_NaN();
    (void)testing::ErrorOf(ErrorKind::kGeometry,
                           [&] { WriteFieldFile(with_nan, DwellOf(with_nan), folder / name); });
    (void)testing::ErrorOf(ErrorKind::kFile,
                           [&] { WriteFieldFile(Brick(), DwellOf(Brick()), folder / "missing" / name); });
  }
  EXPECT_THROW(WriteFieldFile(Brick(), DwellOf(Brick()), folder / "bad.obj"), core::Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace elbowroom::cad_import
