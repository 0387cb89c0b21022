#include "cad_import/mesh_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>

#include "tests/cad_import/error_of.h"
#include "tests/cad_import/mesh_file_fixture.h"
#include "tests/cad_import/sample_files.h"
#include "tests/core/solids.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::cad_import {
namespace {

using core::ErrorKind;
using core::LengthUnit;
using core::TriangleMesh;
using core::testing::Box;
using test_support::WriteText;
using testing::ErrorOf;
using testing::ImportHere;
using testing::kSinglePrecision;
using testing::Mentions;
using MeshFile = testing::MeshFileTest;

void ExpectNothingToMend(const ImportReport& report) {
  EXPECT_TRUE(report.watertight);
  EXPECT_FALSE(report.repaired);
  EXPECT_EQ(report.dropped_triangles, 0);
  EXPECT_TRUE(report.warnings.empty()) << report.warnings.front();
}

void ExpectIsTheBox(const ImportedMesh& imported, const Eigen::Vector3d& size_mm) {
  const double volume_mm3 = size_mm.prod();
  EXPECT_EQ(imported.mesh->vertices_mm.size(), 8U);
  EXPECT_EQ(imported.report.triangles, 12);
  EXPECT_EQ(imported.report.parts, 1);
  ExpectNothingToMend(imported.report);
  EXPECT_NEAR(core::VolumeMm3(*imported.mesh), volume_mm3, volume_mm3 * kSinglePrecision);
  EXPECT_TRUE(imported.report.bounds_mm.sizes().isApprox(size_mm, kSinglePrecision));
}

TEST_F(MeshFile, EveryFormatGivesTheSameClosedBox) {
  const Eigen::Vector3d size_mm(10, 20, 30);
  const TriangleMesh box = Box(size_mm);
  ExpectIsTheBox(Import("text.stl", testing::StlText(box)), size_mm);
  ExpectIsTheBox(Import("binary.STL", testing::StlBinary(box)), size_mm);
  ExpectIsTheBox(Import("box.obj", testing::ObjText(box)), size_mm);
  ExpectIsTheBox(Import("text.ply", testing::PlyText(box)), size_mm);
  ExpectIsTheBox(Import("little.ply", testing::PlyBinary(box)), size_mm);
  ExpectIsTheBox(Import("big.ply", testing::PlyBinary(box, true)), size_mm);
  const TriangleMesh in_metres = Box(size_mm / 1000.0);
  ExpectIsTheBox(
      ImportHere(Write("box.glb", testing::Glb(testing::Gltf(in_metres, {R"({"mesh":0})"}, {0}, "")))),
      size_mm);
  const auto gltf = testing::Gltf(in_metres, {R"({"mesh":0})"}, {0}, "box.bin");
  WriteText(folder_ / "box.bin", gltf.buffer);
  ExpectIsTheBox(ImportHere(Write("box.gltf", gltf.json)), size_mm);
}

TEST_F(MeshFile, ABinaryStlWhoseHeaderSaysSolidIsStillBinary) {
  std::string bytes = testing::StlBinary(Box({1, 2, 3}));
  bytes.replace(0, 12, "solid by CAD");
  ExpectIsTheBox(Import("tricky.stl", bytes), {1, 2, 3});
}

TEST_F(MeshFile, UnitsScaleTheNumbers) {
  const std::string bytes = testing::StlText(Box({1, 2, 3}));
  ExpectIsTheBox(Import("cm.stl", bytes, LengthUnit::kCentimetre), {10, 20, 30});
  ExpectIsTheBox(Import("m.stl", bytes, LengthUnit::kMetre), {1000, 2000, 3000});
  ExpectIsTheBox(Import("in.stl", bytes, LengthUnit::kInch), {25.4, 50.8, 76.2});
  const auto by_default = ImportHere(folder_ / "in.stl", {.unit_if_file_has_none = LengthUnit::kCentimetre});
  EXPECT_EQ(by_default.report.unit, "cm");
  ExpectIsTheBox(by_default, {10, 20, 30});
}

TEST_F(MeshFile, WithoutAUnitTheErrorShowsTheSizeInEach) {
  for (const auto& [name, bytes] : {std::pair{"a.stl", testing::StlText(Box({1, 2, 3}))},
                                    std::pair{"a.obj", testing::ObjText(Box({1, 2, 3}))},
                                    std::pair{"a.ply", testing::PlyText(Box({1, 2, 3}))}}) {
    const auto path = Write(name, bytes);
    const std::string message = ErrorOf(ErrorKind::kCad, [&] { (void)ImportHere(path); });
    for (const char* expected : {name, "carries no unit", "1 x 2 x 3 mm if in mm", "10 x 20 x 30 mm if in cm",
                                 "1000 x 2000 x 3000 mm if in m", "25.4 x 50.8 x 76.2 mm if in in",
                                 "use --unit, FILE:", "or `unit`"}) {
      EXPECT_TRUE(Mentions(message, expected)) << message;
    }
  }
}

TEST_F(MeshFile, TheLikelyUnitIsOneThatCadIsDrawnIn) {
  const std::vector<std::pair<double, std::string>> cases = {{20.0, "mm"}, {70.0, "mm"}, {500.0, "mm"},
                                                             {8.0, "in"},  {0.3, "m"},   {0.02, "m"}};
  for (const auto& [longest, unit] : cases) {
    const auto file = Write("a.stl", testing::StlBinary(Box({longest, 0.9 * longest, 0.8 * longest})));
    const std::string message = ErrorOf(ErrorKind::kCad, [&] { (void)ImportHere(file); });
    EXPECT_TRUE(Mentions(message, "most likely its unit is " + unit + ":")) << message;
  }
}

TEST_F(MeshFile, ImplausibleSizesAreWarnedOf) {
  const auto tiny = Import("tiny.stl", testing::StlText(Box({0.1, 0.2, 0.3})));
  ASSERT_EQ(tiny.report.warnings.size(), 1U);
  EXPECT_TRUE(Mentions(tiny.report.warnings[0], "implausible")) << tiny.report.warnings[0];
  const auto huge = Import("huge.stl", testing::StlText(Box({100, 200, 300})), LengthUnit::kMetre);
  ASSERT_EQ(huge.report.warnings.size(), 1U);
}

TEST_F(MeshFile, NodesAreFlattenedWithTheirTransformsAndKeepTheirNames) {
  // A root shifts; its children are an instance beside it, turned a quarter about z, and a mirrored one.
  const auto sample =
      testing::Gltf(Box({1, 2, 3}),
                    {R"({"name":"shelf","translation":[10,0,0],"children":[1,2]})",
                     R"({"name":"turned","mesh":0,"rotation":[0,0,0.70710678,0.70710678]})",
                     R"({"name":"mirrored","mesh":0,"scale":[-1,1,1],"translation":[0,0,5]})"},
                    {0}, "");
  const ImportedMesh imported = ImportHere(Write("shelf.glb", testing::Glb(sample)));
  ASSERT_EQ(imported.parts.size(), 2U);
  EXPECT_EQ(imported.parts[0].name, "turned");
  EXPECT_EQ(imported.parts[1].name, "mirrored");
  EXPECT_EQ(imported.parts[1].first_triangle, 12);
  EXPECT_EQ(imported.parts[1].triangles, 12);
  EXPECT_TRUE(imported.report.watertight);
  EXPECT_FALSE(imported.report.repaired);  // mirroring turns the winding, which is undone silently
  EXPECT_NEAR(core::VolumeMm3(*imported.mesh), 12e9, 12e9 * kSinglePrecision);
  const Eigen::AlignedBox3d expected(Eigen::Vector3d(8'000, 0, 0), Eigen::Vector3d(10'000, 2'000, 8'000));
  EXPECT_TRUE(imported.report.bounds_mm.isApprox(expected, kSinglePrecision))
      << imported.report.bounds_mm.min().transpose() << " to " << imported.report.bounds_mm.max().transpose();
}

TEST_F(MeshFile, AFileWithoutStructureIsListedByItsConnectedPieces) {
  TriangleMesh two = Box({10, 10, 10});
  core::Append(two,
               core::Transformed(Box({1, 1, 1}), core::FromPositionAndRollPitchYaw({50, 0, 0}, {0, 0, 0})));
  std::swap(two.triangles[1], two.triangles[20]);  // the pieces' triangles needn't follow each other
  const auto imported = Import("two.stl", testing::StlBinary(two));
  ASSERT_EQ(imported.parts.size(), 2U);
  EXPECT_EQ(imported.report.parts, 2);
  EXPECT_EQ(imported.parts[0].name, "two");
  EXPECT_EQ(imported.parts[1].name, "two 2");
  EXPECT_EQ(imported.parts[1].first_triangle, 12);
  EXPECT_TRUE(imported.report.watertight);
  for (std::size_t i = 0; i < 24; ++i) {
    const auto corner = static_cast<std::size_t>(imported.mesh->triangles[i][0]);
    EXPECT_EQ(imported.mesh->vertices_mm[corner].x() >= 50.0, i >= 12) << i;
  }
}

TEST_F(MeshFile, ACavityIsNotTurnedInsideOut) {
  TriangleMesh hollow = Box({10, 10, 10});
  TriangleMesh cavity =
      core::Transformed(Box({2, 2, 2}), core::FromPositionAndRollPitchYaw({4, 4, 4}, {0, 0, 0}));
  for (auto& triangle : cavity.triangles) std::swap(triangle[0], triangle[1]);
  core::Append(hollow, cavity);
  const auto imported = Import("hollow.stl", testing::StlBinary(hollow));
  EXPECT_FALSE(imported.report.repaired);
  EXPECT_NEAR(core::VolumeMm3(*imported.mesh), 992.0, 992.0 * kSinglePrecision);
}

TEST_F(MeshFile, PolygonsBecomeTrianglesAndLinesAreLeftOut) {
  const auto imported = Import("quad.obj", "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3 4\nl 1 3\n");
  EXPECT_EQ(imported.report.triangles, 2);
  EXPECT_NEAR(core::AreaMm2(*imported.mesh), 81.0, 81.0 * kSinglePrecision);
  EXPECT_TRUE(
      Mentions(imported.report.warnings.back(), "1 lines, points and bodies without faces were left out"));
}

TEST_F(MeshFile, AnOpenShellIsWarnedOf) {
  TriangleMesh open = Box({10, 10, 10});
  open.triangles.pop_back();
  const auto imported = Import("open.stl", testing::StlText(open));
  EXPECT_FALSE(imported.report.watertight);
  EXPECT_FALSE(imported.report.repaired);
  ASSERT_EQ(imported.report.warnings.size(), 1U);
  EXPECT_TRUE(Mentions(imported.report.warnings[0], "3 open edges")) << imported.report.warnings[0];
}

TEST_F(MeshFile, ABoxInsideOutIsTurned) {
  TriangleMesh inside_out = Box({10, 10, 10});
  for (auto& triangle : inside_out.triangles) std::swap(triangle[0], triangle[1]);
  const auto imported = Import("inside_out.ply", testing::PlyBinary(inside_out));
  EXPECT_TRUE(imported.report.watertight);
  EXPECT_TRUE(imported.report.repaired);
  EXPECT_NEAR(core::VolumeMm3(*imported.mesh), 1000.0, 1000.0 * kSinglePrecision);
  EXPECT_TRUE(Mentions(imported.report.warnings.at(0), "faced inwards"));
}

TEST_F(MeshFile, TrianglesWithoutAreaAreDroppedAndCounted) {
  TriangleMesh box = Box({10, 10, 10});
  box.vertices_mm.emplace_back(5, 0, 0);  // on the edge from 0 to 1
  box.triangles.push_back({0, 0, 3});
  box.triangles.push_back({7, 7, 7});
  const auto imported = Import("box.obj", testing::ObjText(box));
  EXPECT_EQ(imported.report.dropped_triangles, 2);
  EXPECT_EQ(imported.report.triangles, 12);
  EXPECT_TRUE(imported.report.watertight);
  EXPECT_TRUE(imported.report.repaired);

  TriangleMesh open = Box({10, 10, 10});
  open.triangles.pop_back();
  open.vertices_mm.emplace_back(5, 0, 0);
  open.triangles.push_back({0, 8, 1});
  const auto dropped = Import("open.obj", testing::ObjText(open));
  EXPECT_EQ(dropped.report.dropped_triangles, 1);
  EXPECT_EQ(dropped.report.triangles, 11);
}

TEST_F(MeshFile, FlatTrianglesThatHoldASurfaceTogetherStay) {
  // Triangle {1,0,4} of the box is split at the middle of its edge 0-1; its neighbour is not, and a flat
  // triangle closes the gap.
  TriangleMesh box = Box({10, 10, 10});
  box.vertices_mm.emplace_back(5, 0, 0);
  const auto split =
      std::find(box.triangles.begin(), box.triangles.end(), std::array<std::int32_t, 3>{0, 1, 4});
  ASSERT_NE(split, box.triangles.end());
  *split = {0, 8, 4};
  box.triangles.push_back({8, 1, 4});
  box.triangles.push_back({0, 1, 8});
  const auto imported = Import("held.stl", testing::StlBinary(box));
  EXPECT_TRUE(imported.report.watertight);
  EXPECT_EQ(imported.report.triangles, 14);
  EXPECT_EQ(imported.report.dropped_triangles, 0);
  EXPECT_TRUE(Mentions(imported.report.warnings.at(0), "1 triangles have no area but hold"));
}

TEST_F(MeshFile, ASurfaceCutUpByGroupsIsClosedAgain) {
  std::string text = "o first\n";
  const TriangleMesh box = Box({10, 10, 10});
  for (const auto& v : box.vertices_mm)
    text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) + "\n";
  for (std::size_t i = 0; i < box.triangles.size(); ++i) {
    if (i == 6) text += "o second\n";
    const auto& [a, b, c] = box.triangles[i];
    text += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) + "\n";
  }
  const auto imported = Import("groups.obj", text);
  EXPECT_EQ(imported.report.parts, 2);
  EXPECT_TRUE(imported.report.watertight);
  EXPECT_EQ(imported.mesh->vertices_mm.size(), 8U);
  EXPECT_TRUE(Mentions(imported.report.warnings.at(0), "2 open parts are closed surfaces together"));
}

TEST_F(MeshFile, NoiseAroundZeroDoesntTearTheSurface) {
  std::string text = testing::StlText(Box({10, 10, 10}));
  const std::string corner = "vertex 0 0 0";
  text.replace(text.find(corner), corner.size(), "vertex 0 -3e-17 2.8e-33");
  const auto imported = Import("noise.stl", text);
  EXPECT_TRUE(imported.report.watertight);
  EXPECT_EQ(imported.mesh->vertices_mm.size(), 8U);
}

TEST_F(MeshFile, WhatAnObjSaysBesidesItsShapeCostsNoFaces) {
  std::string text = "mtllib gone.mtl\nvn 0 0 1\nusemtl red\n" + testing::ObjText(Box({10, 10, 10}));
  // Texture coordinates and normals that the file doesn't have; a face over two lines; a comment behind one.
  text.replace(text.find("f 1 3 2\n"), 8, "usemtl blue\ns 1\nf 1/9/7 3/9/7 \\\n2/9/7\n");
  text.replace(text.find("f 2 3 4\n"), 8, "f -7//1 -6//1 -5//1 # from the end\r\n");
  const auto imported = Import("dressed.obj", text);
  EXPECT_EQ(imported.report.triangles, 12);
  EXPECT_TRUE(imported.report.watertight);
  EXPECT_TRUE(imported.report.warnings.empty());
}

TEST_F(MeshFile, ClosedPartsThatTouchStayApart) {
  // Two boxes side by side share four corners and an edge of each: welded together they would be
  // non-manifold.
  const auto sample =
      testing::Gltf(Box({1, 1, 1}), {R"({"mesh":0})", R"({"mesh":0,"translation":[1,0,0]})"}, {0, 1}, "");
  const auto imported = ImportHere(Write("touching.glb", testing::Glb(sample)));
  EXPECT_EQ(imported.report.parts, 2);
  EXPECT_TRUE(imported.report.watertight);
  EXPECT_EQ(imported.mesh->vertices_mm.size(), 16U);
}

// As UTF-16 with its mark.
std::string Utf16(std::string_view text, bool is_big_endian) {
  std::string bytes = is_big_endian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char letter : text) {
    if (is_big_endian) bytes += '\0';
    bytes += letter;
    if (!is_big_endian) bytes += '\0';
  }
  return bytes;
}

// A triangle of 1 x 2 in the file's metres, in its scene only where that `shows` it.
std::string Collada(bool shows) {
  const std::string node = shows ? R"(<instance_geometry url="#g"/>)" : R"(<instance_camera url="#c"/>)";
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="1"/></asset>
<library_cameras><camera id="c"><optics><technique_common><perspective><yfov>50</yfov></perspective>
</technique_common></optics></camera></library_cameras>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 2 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n">)" +
         node + R"(</node><node id="m"><translate>1 1 1</translate>)" + node + R"(</node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_F(MeshFile, TextInUtf16IsReadAsText) {
  const std::string obj = testing::ObjText(Box({10, 20, 30}));
  for (const bool is_big_endian : {false, true}) {
    ExpectIsTheBox(Import("wide.obj", Utf16(obj, is_big_endian)), {10, 20, 30});
    const auto collada = ImportHere(Write("wide.dae", Utf16(Collada(true), is_big_endian)));
    EXPECT_TRUE(collada.report.bounds_mm.sizes().isApprox(Eigen::Vector3d(2000, 3000, 1000)));
    EXPECT_EQ(collada.report.triangles, 2);
  }
}

// assimp makes up pyramids for the nodes of a file that holds nothing else.
TEST_F(MeshFile, CamerasAndLightsAreNoParts) {
  EXPECT_TRUE(
      Mentions(ErrorOf(ErrorKind::kGeometry, [&] { (void)ImportHere(Write("cameras.dae", Collada(false))); }),
               "no triangles"));
}

TEST_F(MeshFile, FacesOfVerticesThatDontExistAreTold) {
  TriangleMesh box = Box({1, 2, 3});
  box.triangles[5][1] = 77;
  const auto imported =
      ImportHere(Write("box.glb", testing::Glb(testing::Gltf(box, {R"({"mesh":0})"}, {0}, ""))));
  EXPECT_EQ(imported.report.triangles, 11);
  ASSERT_FALSE(imported.report.warnings.empty());
  EXPECT_TRUE(Mentions(imported.report.warnings[0], "vertices that don't exist were left out"))
      << imported.report.warnings[0];
}

TEST_F(MeshFile, MissingUnreadableAndForeignFilesAreNamed) {
  const auto import = [](const std::filesystem::path& path) { return [path] { (void)ImportHere(path); }; };
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kFile, import(folder_ / "none.stl")), "none.stl: no such file"));
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kFile, import(folder_.path())), "not a readable file"));
  ASSERT_EQ(::mkfifo((folder_ / "pipe.stl").c_str(), 0600), 0);
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kFile, import(folder_ / "pipe.stl")), "not a readable file"));
  for (const char* name : {"part.sldprt", "part", "part.stl.txt"}) {
    const std::string message = FormatError(name, "whatever");
    EXPECT_TRUE(Mentions(message, "export the part as .step, .stl")) << message;
  }
  for (const char* name : {"part.step", "part.3mf", "part.3ds", "part.brep"}) {
    const std::string message = FormatError(name, "whatever");
    EXPECT_TRUE(Mentions(message, "it doesn't begin like it")) << message;
  }
}

TEST_F(MeshFile, EmptyFilesAndMeshesAreErrors) {
  for (const char* name : {"a.stl", "a.obj", "a.ply", "a.gltf", "a.glb"}) {
    EXPECT_TRUE(Mentions(FormatError(name, ""), "the file is empty"));
  }
  EXPECT_TRUE(Mentions(FormatError("none.stl", "solid x\nendsolid x\n"), "holds no facets"));
  EXPECT_TRUE(Mentions(FormatError("none.obj", "v 0 0 0\nv 1 0 0\n"), "holds no faces"));
  const auto all_flat = Write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n");
  EXPECT_TRUE(Mentions(
      ErrorOf(ErrorKind::kGeometry, [&] { (void)ImportHere(all_flat, {.unit = LengthUnit::kMetre}); }),
      "no triangles"));
}

TEST_F(MeshFile, VerticesThatAreNotFiniteAreErrors) {
  TriangleMesh broken = Box({1, 1, 1});
  for (const double bad : {std::nan(""), static_cast<double>(INFINITY)}) {
    broken.vertices_mm[2].y() = bad;
    const auto path = Write("broken.stl", testing::StlBinary(broken));
    const std::string message =
        ErrorOf(ErrorKind::kGeometry, [&] { (void)ImportHere(path, {.unit = LengthUnit::kMillimetre}); });
    EXPECT_TRUE(Mentions(message, "not a finite point")) << message;
  }
}

// Whatever length a file is cut to: an error, never a crash, never half a mesh (texts may lose their last
// blanks).
TEST_F(MeshFile, FilesCutOffAnywhereAreErrors) {
  const TriangleMesh box = Box({10, 20, 30});
  const auto glb = testing::Glb(testing::Gltf(box, {R"({"mesh":0})"}, {0}, ""));
  const std::pair<const char*, std::string> kFiles[] = {{"cut_binary.stl", testing::StlBinary(box)},
                                                        {"cut_text.stl", testing::StlText(box, "")},
                                                        {"cut_binary.ply", testing::PlyBinary(box)},
                                                        {"cut_big.ply", testing::PlyBinary(box, true)},
                                                        {"cut.glb", glb}};
  for (const auto& [name, bytes] : kFiles) {
    const std::size_t last = bytes.find_last_not_of(" \n");
    for (std::size_t size = 0; size < last; size += 7) {
      const auto path = Write(name, bytes.substr(0, size));
      EXPECT_THROW((void)ImportHere(path, {.unit = LengthUnit::kMillimetre}), core::Error)
          << name << " cut to " << size;
    }
  }
}

TEST_F(MeshFile, HeadersThatClaimMoreThanTheFileHoldsAreErrors) {
  const TriangleMesh box = Box({1, 2, 3});
  std::string stl = testing::StlBinary(box);
  stl[82] = '\x7f';  // 8 million triangles
  EXPECT_TRUE(Mentions(FormatError("claims.stl", stl), "triangles but the file holds 12"));
  std::string ply = testing::PlyText(box);
  ply.replace(ply.find("face 12"), 7, "face 2000000000");
  EXPECT_TRUE(Mentions(FormatError("claims.ply", ply), "claims 2000000000 of element 'face'"));
  std::string list = testing::PlyText(box);
  list.replace(list.find("3 0 2 1"), 7, "1000000000 0 2 1");
  EXPECT_TRUE(Mentions(FormatError("list.ply", list), "cut off"));
  auto gltf = testing::Gltf(box, {R"({"mesh":0})"}, {0}, "");
  gltf.json.replace(gltf.json.find("\"count\":8"), 9, "\"count\":900000000");
  EXPECT_TRUE(Mentions(FormatError("claims.glb", testing::Glb(gltf)), "more than its buffer view holds"));
}

TEST_F(MeshFile, ASurfaceThatRunsThroughItselfIsTold) {
  TriangleMesh boxes = Box({10, 10, 10});
  core::Append(boxes, core::Transformed(boxes, {Eigen::Matrix3d::Identity(), {5, 5, 5}}));
  WriteMeshFile(boxes, folder_ / "boxes.stl");
  const ImportReport report = ImportHere(folder_ / "boxes.stl", {.unit = LengthUnit::kMillimetre}).report;
  EXPECT_TRUE(report.watertight);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_TRUE(Mentions(report.warnings[0], "pairs of triangles cross or lie on each other"))
      << report.warnings[0];
}

TEST_F(MeshFile, GarbageIsAnErrorAndSaysNothingOnTheTerminal) {
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  for (const char* extension : {".stl", ".obj", ".ply", ".gltf", ".glb"}) {
    (void)FormatError(std::string("text") + extension, "This is not a mesh.\n");
    (void)FormatError(std::string("bytes") + extension,
                      std::string("\x01\x00\xff\x7f", 4).append(200, '\xee'));
  }
  (void)FormatError("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99\n");
  (void)FormatError("nobuffer.gltf", testing::Gltf(Box({1, 1, 1}), {R"({"mesh":0})"}, {0}, "gone.bin").json);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace elbowroom::cad_import
