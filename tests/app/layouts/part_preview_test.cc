// What is shown of a CAD file before parts are taken from it.
#include "app/control/layout_editing/part_preview.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/control/layout_editing/layout_document.h"
#include "core/error.h"
#include "tests/app/layouts/box_file.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;
using test_support::WriteBox;

const std::filesystem::path kAssembly =
    test_support::SharedDataFolder() / "cad/step/ap203_ap214/as1-oc-214.stp";

TEST(PreviewPart, ShowsTheTreeOfAnAssembly) {
  const PartPreview preview = PreviewPart(kAssembly);
  EXPECT_FALSE(preview.asks_for_unit());
  EXPECT_EQ(preview.open_edges, 0);
  EXPECT_EQ(preview.report().unit, "mm");
  EXPECT_GT(preview.size_mm.minCoeff(), 10.0);
  ASSERT_GT(preview.nodes.size(), 10U);
  std::int64_t roots = 0;
  for (std::size_t i = 0; i < preview.nodes.size(); ++i) {
    const PreviewNode& node = preview.nodes[i];
    if (!node.parent) roots += node.triangles;
    if (node.parent) {
      ASSERT_LT(*node.parent, i);
      EXPECT_EQ(node.path, preview.nodes[*node.parent].path + "/" + node.name);
    }
    EXPECT_GT(node.triangles, 0);
    EXPECT_LE(node.size_mm.maxCoeff(), preview.size_mm.maxCoeff() + 1e-9);
  }
  EXPECT_EQ(roots, preview.report().triangles);
}

// A node that is taken is the part that a layout reads back by its path.
TEST(PreviewPart, NodesThatAreTakenAreParts) {
  const test_support::TemporaryFolder folder;
  const PartPreview preview = PreviewPart(kAssembly);
  LayoutDocument document(folder.path());
  std::vector<std::string> taken;
  for (const PreviewNode& node : preview.nodes)
    if (node.path.find("plate") != std::string::npos || node.path.find("rod") != std::string::npos)
      taken.push_back(node.path);
  ASSERT_GE(taken.size(), 2U);
  document.AddParts(preview, taken);
  ASSERT_EQ(document.layout().parts.size(), taken.size());
  document.SaveAs(folder / "layout.toml");
  const LayoutDocument read = LayoutDocument::Open(folder / "layout.toml");
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const auto node = std::ranges::find(preview.nodes, taken[i], &PreviewNode::path);
    EXPECT_EQ(read.layout().parts[i].node, taken[i]);
    EXPECT_EQ(static_cast<std::int64_t>(read.layout().parts[i].mesh->triangles.size()), node->triangles);
    EXPECT_LT((core::BoundsOf(*read.layout().parts[i].mesh).sizes() - node->size_mm).norm(), 1e-9);
    EXPECT_EQ(*read.layout().parts[i].mesh, *document.layout().parts[i].mesh);
  }
}

TEST(PreviewPart, AFileWithoutAUnitIsAQuestionWithTheSizeInEach) {
  const test_support::TemporaryFolder folder;
  const std::filesystem::path file = WriteBox(folder / "box.stl", {8.0, 4.0, 2.0});
  const PartPreview preview = PreviewPart(file);
  ASSERT_TRUE(preview.asks_for_unit());
  ASSERT_EQ(preview.sizes.size(), 4U);
  for (const SizeInUnit& size : preview.sizes)
    EXPECT_LT((size.size_mm - core::MillimetresPer(size.unit) * Vector3d(8.0, 4.0, 2.0)).norm(), 1e-3);
  const auto likely = std::ranges::find_if(preview.sizes, &SizeInUnit::is_likely);
  ASSERT_NE(likely, preview.sizes.end());
  EXPECT_EQ(likely->unit, core::LengthUnit::kInch);  // as the importer's error names it
  try {
    LayoutDocument(folder.path()).AddParts(preview, {""});
    FAIL() << "the unit isn't known";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("most likely its unit is in"), std::string::npos)
        << error.what();
  }
}

TEST(PreviewPart, AChosenUnitIsTheOneOfThePart) {
  const test_support::TemporaryFolder folder;
  const std::filesystem::path file = WriteBox(folder / "box.stl", {8.0, 4.0, 2.0});
  const PartPreview preview = PreviewPart(file, core::LengthUnit::kInch);
  EXPECT_FALSE(preview.asks_for_unit());
  LayoutDocument document(folder.path());
  document.AddParts(preview, {""});
  EXPECT_EQ(document.layout().parts[0].unit, core::LengthUnit::kInch);
  EXPECT_NEAR(core::BoundsOf(*document.layout().parts[0].mesh).sizes().x(), 203.2, 1e-3);
}

TEST(PreviewPart, OpenEdgesAreCounted) {
  const test_support::TemporaryFolder folder;
  core::TriangleMesh mesh = test_support::BoxMesh({80.0, 40.0, 20.0});
  mesh.triangles.pop_back();
  cad_import::WriteMeshFile(mesh, folder / "open.glb");
  const PartPreview preview = PreviewPart(folder / "open.glb");
  EXPECT_EQ(preview.open_edges, 3);
  ASSERT_FALSE(preview.nodes.empty());
  EXPECT_FALSE(preview.nodes.front().is_watertight);
}

TEST(PreviewPart, ACancelIsOne) {
  std::stop_source stop;
  stop.request_stop();
  try {
    (void)PreviewPart(kAssembly, {}, {}, stop.get_token());
    FAIL() << "it was cancelled";
  } catch (const core::Error& error) {
    EXPECT_EQ(error.kind(), core::ErrorKind::kCancelled);
  }
}

}  // namespace
}  // namespace elbowroom::control
