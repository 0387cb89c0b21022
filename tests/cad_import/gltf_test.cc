// glTF and GLB: whole, against the specification, and damaged.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "tests/cad_import/mesh_file_fixture.h"
#include "tests/cad_import/sample_files.h"
#include "tests/core/solids.h"

namespace elbowroom::cad_import {
namespace {

using core::LengthUnit;
using core::TriangleMesh;
using core::testing::Box;
using test_support::WriteText;
using testing::ImportHere;
using testing::kSinglePrecision;
using testing::Mentions;
using GltfFile = testing::MeshFileTest;

TEST_F(GltfFile, GltfIsInMetresUnlessToldOtherwiseWithAWarning) {
  const auto path =
      Write("box.glb", testing::Glb(testing::Gltf(Box({100, 200, 300}), {R"({"mesh":0})"}, {0}, "")));
  // The default is for files that carry no unit; this one does.
  const auto in_metres = ImportHere(path, {.unit_if_file_has_none = LengthUnit::kMillimetre});
  EXPECT_EQ(in_metres.report.unit, "m");
  EXPECT_DOUBLE_EQ(in_metres.report.bounds_mm.sizes().x(), 100'000.0);
  const auto overridden = ImportHere(path, {.unit = LengthUnit::kMillimetre});
  EXPECT_EQ(overridden.report.unit, "mm");
  EXPECT_DOUBLE_EQ(overridden.report.bounds_mm.sizes().x(), 100.0);
  ASSERT_EQ(overridden.report.warnings.size(), 1U);
  EXPECT_TRUE(Mentions(overridden.report.warnings[0], "in m by its own word but was read in mm"));
}

// As some writers leave it, against the specification.
TEST_F(GltfFile, GlbWithoutPaddingIsReadWithAWarning) {
  auto sample = testing::Gltf(Box({1, 2, 3}), {R"({"mesh":0})"}, {0}, "");
  for (int spaces = 0; spaces < 4; ++spaces) {
    SCOPED_TRACE(spaces);
    sample.json += std::string(spaces > 0 ? 1 : 0, ' ');
    std::string bytes = testing::Glb(sample);
    const std::size_t padding = (4 - sample.json.size() % 4) % 4;
    bytes.erase(20 + sample.json.size(), padding);
    for (const std::size_t at : {8, 12}) {  // the whole's size, the JSON's
      std::uint32_t size = 0;
      std::memcpy(&size, bytes.data() + at, sizeof size);
      size -= static_cast<std::uint32_t>(padding);
      std::memcpy(bytes.data() + at, &size, sizeof size);
    }
    const ImportedMesh imported = ImportHere(Write("box.glb", bytes));
    EXPECT_TRUE(
        core::BoundsOf(*imported.mesh).sizes().isApprox(Eigen::Vector3d(1000, 2000, 3000), kSinglePrecision));
    EXPECT_EQ(std::ranges::count_if(imported.report.warnings,
                                    [](const auto& warning) { return Mentions(warning, "multiples of 4"); }),
              padding > 0 ? 1 : 0);
  }
}

TEST_F(GltfFile, GlbWhoseChunksAreOutOfStepIsAnError) {
  std::string bytes = testing::Glb(testing::Gltf(Box({1, 1, 1}), {R"({"mesh":0})"}, {0}, ""));
  bytes[12] = static_cast<char>(bytes[12] - 40);
  (void)FormatError("out_of_step.glb", bytes);
}

// Files are named by URIs, which write a space as "%20".
TEST_F(GltfFile, EscapedNamesOfBuffersAreFoundAndHeldToTheFolder) {
  const auto sample = testing::Gltf(Box({1, 2, 3}), {R"({"mesh":0})"}, {0}, "a%20b%C3%BC.bin");
  WriteText(folder_ / "a b\u00fc.bin", sample.buffer);
  EXPECT_EQ(ImportHere(Write("box.gltf", sample.json)).report.triangles, 12);
  std::filesystem::create_directory(folder_ / "inner");
  WriteText(folder_ / "outside.bin", sample.buffer);
  const auto outside = testing::Gltf(Box({1, 2, 3}), {R"({"mesh":0})"}, {0}, "%2e%2e/outside.bin");
  EXPECT_TRUE(Mentions(FormatError("inner/box.gltf", outside.json), "outside its own folder"));
  const auto literal = testing::Gltf(Box({1, 2, 3}), {R"({"mesh":0})"}, {0}, "100%.bin");
  WriteText(folder_ / "100%.bin", literal.buffer);
  EXPECT_EQ(ImportHere(Write("percent.gltf", literal.json)).report.triangles, 12);
}

// Ten thousand places for two thousand triangles: small as a file, not as one mesh.
TEST_F(GltfFile, MoreTrianglesThanAMeshMayHaveAreRefusedByWhereTheyStand) {
  TriangleMesh fan;
  fan.vertices_mm.emplace_back(0, 0, 0);
  for (int i = 0; i <= 2000; ++i) {
    fan.vertices_mm.emplace_back(std::cos(0.003 * i), std::sin(0.003 * i), 0.0);
    if (i > 0) fan.triangles.push_back({0, i, i + 1});
  }
  std::vector<int> roots(10'001);
  std::iota(roots.begin(), roots.end(), 0);
  const std::vector<std::string> nodes(roots.size(), R"({"mesh":0})");
  const auto path = Write("many.glb", testing::Glb(testing::Gltf(fan, nodes, roots, "")));
  const std::string message = testing::ErrorOf(core::ErrorKind::kCad, [&] { (void)ImportHere(path); });
  EXPECT_TRUE(Mentions(message, "20002000 triangles in 10001 places")) << message;
}

TEST_F(GltfFile, AMissingBufferIsNamed) {
  const auto sample = testing::Gltf(Box({1, 1, 1}), {R"({"mesh":0})"}, {0}, "gone.bin");
  EXPECT_TRUE(
      Mentions(FormatError("box.gltf", sample.json), "it refers to 'gone.bin', which can't be opened"));
}

// Which keeps under names what version 2.0 lists.
TEST_F(GltfFile, Gltf1IsRead) {
  const auto sample = testing::Gltf(Box({1, 2, 3}), {R"({"mesh":0})"}, {0}, "box.bin");
  WriteText(folder_ / "box.bin", sample.buffer);
  const std::string before = R"({"asset":{"version":)";
  const std::string after = R"(},"scene":"s","scenes":{"s":{"nodes":["top"]}},
    "nodes":{"top":{"children":["low","high"]},
             "low":{"meshes":["m"]},"high":{"meshes":["m"],
                    "rotation":[0,0,0.70710678,0.70710678],"translation":[10,0,5],"scale":[1,1,2]}},
    "meshes":{"m":{"primitives":[{"attributes":{"POSITION":"points"},"indices":"corners","mode":4}]}},
    "accessors":{"points":{"bufferView":"v","byteOffset":0,"byteStride":12,"componentType":5126,"count":8,
                           "type":"VEC3"},
                 "corners":{"bufferView":"c","byteOffset":0,"byteStride":0,"componentType":5123,"count":36,
                            "type":"SCALAR"}},
    "bufferViews":{"v":{"buffer":"b","byteOffset":0,"byteLength":96},
                   "c":{"buffer":"b","byteOffset":96,"byteLength":72}},
    "buffers":{"b":{"uri":"box.bin","byteLength":168,"type":"arraybuffer"}}})";
  for (const char* version : {"\"1.0\"", "1"}) {
    const ImportedMesh imported = ImportHere(Write("box.gltf", before + version + after));
    EXPECT_EQ(imported.report.parts, 2);
    EXPECT_TRUE(core::BoundsOf(*imported.mesh)
                    .sizes()
                    .isApprox(Eigen::Vector3d(10000, 2000, 11000), kSinglePrecision));
  }
  EXPECT_TRUE(Mentions(FormatError("box.gltf", before + "\"0.8\"" + after), "only 1.0 and 2.0"));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string json = before + "\"1.0\"" + after;
    return json.replace(json.find(from), from.size(), to);
  };
  EXPECT_TRUE(
      Mentions(FormatError("a.gltf", with("\"count\":8", "\"count\":9")), "more than its buffer view"));
  EXPECT_TRUE(
      Mentions(FormatError("a.gltf", with("\"buffer\":\"b\"", "\"buffer\":\"x\"")), "names no buffer"));
  EXPECT_TRUE(Mentions(FormatError("a.gltf", with("\"meshes\":[\"m\"]}", "\"children\":[\"top\"]}")),
                       "its own ancestor"));
  EXPECT_TRUE(Mentions(FormatError("a.gltf", with("[10,0,5]", "[10,0]")), "isn't numbers"));
  EXPECT_TRUE(Mentions(FormatError("a.gltf", with("\"low\",", "\"nobody\",")), "doesn't exist"));
}

TEST_F(GltfFile, NodesInACircleAreAnError) {
  const auto circle = testing::Gltf(
      Box({1, 1, 1}), {R"({"mesh":0,"children":[1]})", R"({"mesh":0,"children":[0]})"}, {0}, "");
  EXPECT_TRUE(Mentions(FormatError("circle.glb", testing::Glb(circle)), "its own ancestor"));
  const auto shared = testing::Gltf(
      Box({1, 1, 1}), {R"({"children":[2]})", R"({"children":[2]})", R"({"mesh":0})"}, {0, 1}, "");
  EXPECT_TRUE(Mentions(FormatError("shared.glb", testing::Glb(shared)), "two parents"));
}

}  // namespace
}  // namespace elbowroom::cad_import
