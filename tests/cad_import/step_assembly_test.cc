// Assemblies, written here by OpenCASCADE's own STEP writer.
#include <gtest/gtest.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Trsf.hxx>
#include <set>
#include <string>

#include "cad_import/cad_file.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::cad_import {
namespace {

constexpr int kBalls = 100;

// A rack of `kBalls` balls of radius 5, 20 apart along x, on a plate.
void WriteRack(const std::filesystem::path& path) {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const TDF_Label rack = shapes->NewShape();
  const TDF_Label ball = shapes->AddShape(BRepPrimAPI_MakeSphere(5.0).Shape(), false);
  const TDF_Label plate =
      shapes->AddShape(BRepPrimAPI_MakeBox(gp_Pnt(-10, -10, -7), 20.0 * kBalls, 20, 2).Shape(), false);
  TDataStd_Name::Set(rack, "rack");
  TDataStd_Name::Set(ball, "ball");
  TDataStd_Name::Set(plate, "plate");
  for (int i = 0; i < kBalls; ++i) {
    gp_Trsf moved;
    moved.SetTranslation(gp_Vec(20.0 * i, 0, 0));
    const TDF_Label component = shapes->AddComponent(rack, ball, TopLoc_Location(moved));
    TDataStd_Name::Set(component, ("ball " + std::to_string(i)).c_str());
  }
  shapes->AddComponent(rack, plate, TopLoc_Location());
  shapes->UpdateAssemblies();
  STEPCAFControl_Writer writer;
  ASSERT_TRUE(writer.Transfer(document));
  ASSERT_EQ(writer.Write(path.c_str()), IFSelect_RetDone);
}

TEST(StepAssembly, AHundredInstancesShareOneMesh) {
  const test_support::TemporaryFolder folder;
  WriteRack(folder / "rack.step");
  const CadModel model = ImportCadFile(folder / "rack.step");
  ASSERT_EQ(model.instances.size(), static_cast<std::size_t>(kBalls) + 1);
  EXPECT_EQ(model.report.parts, kBalls + 1);
  ASSERT_EQ(model.shapes.size(), 2U);
  std::set<const core::TriangleMesh*> meshes;
  std::set<std::string> paths;
  std::int64_t triangles = 0;
  for (const CadInstance& instance : model.instances) {
    const core::SharedMesh& mesh = model.shapes[instance.shape].mesh;
    meshes.insert(mesh.get());
    paths.insert(instance.path);
    triangles += static_cast<std::int64_t>(mesh->triangles.size());
  }
  EXPECT_EQ(meshes.size(), 2U);
  EXPECT_EQ(paths.size(), model.instances.size());
  EXPECT_TRUE(paths.contains("rack/ball 17")) << *paths.begin();
  EXPECT_EQ(model.report.triangles, triangles);
  EXPECT_TRUE(model.report.watertight);
  // A ball's triangles may end short of its poles by the tolerance.
  const Eigen::AlignedBox3d& bounds = model.report.bounds_mm;
  EXPECT_LT((bounds.min() - Eigen::Vector3d(-10, -10, -7)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((bounds.max() - Eigen::Vector3d(1990, 10, 5)).cwiseAbs().maxCoeff(), 0.2);
}

}  // namespace
}  // namespace elbowroom::cad_import
