// Files as programs write them, beside what their formats' specifications say.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cctype>
#include <cstdint>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "cad_import/layout/layout_file.h"
#include "tests/cad_import/mesh_file_fixture.h"
#include "tests/cad_import/sample_files.h"
#include "tests/core/solids.h"

namespace elbowroom::cad_import {
namespace {

using core::ErrorKind;
using core::LengthUnit;
using core::testing::Box;
using testing::ErrorOf;
using testing::ImportHere;
using testing::Mentions;
using Dialect = testing::MeshFileTest;

void ExpectTheBox(const ImportedMesh& imported, std::size_t warnings = 0) {
  EXPECT_EQ(imported.report.triangles, 12);
  EXPECT_TRUE(imported.report.watertight);
  EXPECT_EQ(imported.report.bounds_mm.sizes(), Eigen::Vector3d(10, 20, 30));
  EXPECT_EQ(imported.report.warnings.size(), warnings);
}

TEST_F(Dialect, TextStlMayShoutAndBeginLate) {
  const std::string text = testing::StlText(Box({10, 20, 30}), "geh\u00e4use");
  ExpectTheBox(Import("plain.stl", text));
  ExpectTheBox(Import("mark.stl", "\xEF\xBB\xBF" + text));
  ExpectTheBox(Import("blank.stl", "\n \t\n" + text));
  std::string loud = text;
  std::ranges::transform(loud, loud.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  ExpectTheBox(Import("loud.stl", loud));
}

TEST_F(Dialect, BytesAfterABinaryStlAreToldAndTrianglesThereRefused) {
  const std::string bytes = testing::StlBinary(Box({10, 20, 30}));
  const auto padded = Import("padded.stl", bytes + std::string(21, '\0'));
  ExpectTheBox(padded, 1);
  EXPECT_TRUE(Mentions(padded.report.warnings.at(0), "21 bytes after its last triangle"));
  std::string few = bytes;
  few[80] = 5;
  EXPECT_TRUE(Mentions(FormatError("few.stl", few), "claims 5 triangles but the file has room for 12"));
}

std::string Collada(const std::string& unit) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>)" +
         unit + R"(<up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="9">0 0 0 10 0 0 0 20 30</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="w"><node id="n"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>)";
}

TEST_F(Dialect, AColladaUnitThatIsNoLengthIsNone) {
  for (const std::string meter : {"-1", "0", "abc", "", "nan", "inf", "1e400"}) {
    SCOPED_TRACE(meter);
    const auto path = Write("bad.dae", Collada("<unit name=\"x\" meter=\"" + meter + "\"/>"));
    EXPECT_TRUE(
        Mentions(ErrorOf(ErrorKind::kCad, [&] { (void)ImportHere(path); }), "10 x 20 x 30 mm if in mm"));
    const auto asked = ImportHere(path, {.unit = LengthUnit::kCentimetre});
    EXPECT_EQ(asked.report.bounds_mm.sizes(), Eigen::Vector3d(100, 200, 300));
    EXPECT_TRUE(Mentions(asked.report.warnings.at(0), "isn't a length"));
  }
  for (const std::string unit : {"<unit meter=\"0.01\"/>", "<unit name='cm'\n meter = ' 0,01 '></unit>"}) {
    SCOPED_TRACE(unit);
    const auto good = ImportHere(Write("good.dae", Collada(unit)));
    EXPECT_TRUE(
        good.report.bounds_mm.sizes().isApprox(Eigen::Vector3d(100, 200, 300), testing::kSinglePrecision));
  }
  EXPECT_EQ(ImportHere(Write("silent.dae", Collada(""))).report.unit, "m");
}

void AppendNumber(std::string& bytes, std::uint32_t number, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>((number >> (8 * i)) & 0xFFU);
}

// A ZIP archive whose files aren't compressed.
std::string Zip(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string bytes, directory;
  for (const auto& [name, text] : files) {
    boost::crc_32_type checksum;
    checksum.process_bytes(text.data(), text.size());
    const auto size = static_cast<std::uint32_t>(text.size());
    std::string facts;  // what both headers say: version, flags, method, time, date, checksum, sizes
    for (const std::uint32_t number : {10U, 0U, 0U, 0U, 0x21U}) AppendNumber(facts, number, 2);
    for (const std::uint32_t number : {checksum.checksum(), size, size}) AppendNumber(facts, number, 4);
    AppendNumber(facts, static_cast<std::uint32_t>(name.size()), 2);
    AppendNumber(facts, 0, 2);
    directory += "PK\x01\x02\x0a" + std::string(1, '\0') + facts + std::string(10, '\0');
    AppendNumber(directory, static_cast<std::uint32_t>(bytes.size()), 4);
    directory += name;
    bytes += "PK\x03\x04" + facts + name + text;
  }
  const auto begin = static_cast<std::uint32_t>(bytes.size()),
             count = static_cast<std::uint32_t>(files.size());
  bytes += directory + "PK\x05\x06";
  for (const std::uint32_t number : {0U, 0U, count, count}) AppendNumber(bytes, number, 2);
  for (const auto number : {static_cast<std::uint32_t>(directory.size()), begin})
    AppendNumber(bytes, number, 4);
  AppendNumber(bytes, 0, 2);
  return bytes;
}

std::string ThreeMf(const std::string& unit) {
  const std::string types = "application/vnd.openxmlformats-package.relationships+xml";
  return Zip(
      {{"[Content_Types].xml",
        R"(<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType=")" +
            types + R"("/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)"},
       {"_rels/.rels",
        R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>)"},
       {"3D/3dmodel.model",
        R"(<?xml version="1.0"?><model unit=")" + unit +
            R"(" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>
<object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="10" y="0" z="0"/>
<vertex x="0" y="20" z="0"/><vertex x="0" y="0" z="30"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>
<triangle v1="0" v2="1" v3="3"/><triangle v1="1" v2="2" v3="3"/><triangle v1="2" v2="0" v3="3"/></triangles></mesh>
</object></resources><build><item objectid="1"/></build></model>)"}});
}

TEST_F(Dialect, AThreeMfUnitThatIsNoneOfItsOwnIsNone) {
  EXPECT_EQ(ImportHere(Write("good.3mf", ThreeMf("inch"))).report.bounds_mm.sizes(),
            25.4 * Eigen::Vector3d(10, 20, 30));
  const auto path = Write("bad.3mf", ThreeMf("furlong"));
  EXPECT_TRUE(
      Mentions(ErrorOf(ErrorKind::kCad, [&] { (void)ImportHere(path); }), "10 x 20 x 30 mm if in mm"));
  const auto asked = ImportHere(path, {.unit = LengthUnit::kCentimetre});
  EXPECT_EQ(asked.report.bounds_mm.sizes(), Eigen::Vector3d(100, 200, 300));
  EXPECT_TRUE(Mentions(asked.report.warnings.at(0), "isn't one of 3MF's"));
}

// Two plates with a common edge.
TEST_F(Dialect, OpenPartsThatAreNoClosedSurfaceTogetherStayApart) {
  const std::string obj =
      "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nv 9 0 9\nv 0 0 9\n"
      "o floor\nf 1 2 3 4\no wall\nf 1 2 5 6\n";
  const auto imported = Import("plates.obj", obj);
  ASSERT_EQ(imported.parts.size(), 2U);
  EXPECT_EQ(imported.parts[0].name, "floor");
  EXPECT_EQ(imported.parts[1].name, "wall");
  const CadModel model = ReadCadFile(folder_ / "plates.obj", {.unit = LengthUnit::kMillimetre}).model;
  EXPECT_EQ(core::BoundsOf(*Flatten(model, "floor").mesh).sizes(), Eigen::Vector3d(9, 9, 0));
  EXPECT_EQ(core::BoundsOf(*Flatten(model, "wall").mesh).sizes(), Eigen::Vector3d(9, 0, 9));
}

TEST_F(Dialect, NamesOfPartsAreOnOneLine) {
  auto sample = testing::Gltf(Box({1, 2, 3}), {R"({"mesh":0,"name":"two\nlines"})"}, {0}, "");
  const auto imported = ImportHere(Write("box.glb", testing::Glb(sample)));
  ASSERT_EQ(imported.parts.size(), 1U);
  EXPECT_EQ(imported.parts[0].name, "two lines");
}

TEST_F(Dialect, ALayoutWhosePartsAreBeingReadCanBeCancelled) {
  Write("box.stl", testing::StlText(Box({10, 20, 30})));
  const auto layout = Write("layout.toml", "unit = \"mm\"\n[[part]]\nname = \"a\"\nfile = \"box.stl\"\n");
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(
      Mentions(ErrorOf(ErrorKind::kCancelled, [&] { (void)ImportLayoutFile(layout, {}, stop.get_token()); }),
               "cancelled"));
}

}  // namespace
}  // namespace elbowroom::cad_import
