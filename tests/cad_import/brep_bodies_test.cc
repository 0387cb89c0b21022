// Which bodies come out of boundary representations, made here by OpenCASCADE.
#include <gtest/gtest.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Ax1.hxx>
#include <gp_Trsf.hxx>
#include <numbers>

#include "cad_import/cad_file.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::cad_import {
namespace {

class BrepBodies : public ::testing::Test {
 protected:
  BrepBodies() { builder_.MakeCompound(compound_); }
  void Add(const TopoDS_Shape& shape) { builder_.Add(compound_, shape); }
  CadModel Import() {
    BRepTools::Write(compound_, (folder_ / "bodies.brep").c_str());
    return ImportCadFile(folder_ / "bodies.brep", {.unit = core::LengthUnit::kMillimetre});
  }

  test_support::TemporaryFolder folder_;
  BRep_Builder builder_;
  TopoDS_Compound compound_;
};

// Welded, the four triangles where they meet would be the edges' third and fourth.
TEST_F(BrepBodies, SolidsThatTouchAreBodiesOfTheirOwn) {
  Add(BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 10, 20, 30).Shape());
  Add(BRepPrimAPI_MakeBox(gp_Pnt(10, 0, 0), 10, 20, 30).Shape());
  const CadModel model = Import();
  EXPECT_EQ(model.report.parts, 2);
  EXPECT_TRUE(model.report.watertight);
  EXPECT_EQ(model.report.triangles, 24);
  EXPECT_TRUE(model.report.bounds_mm.sizes().isApprox(Eigen::Vector3d(20, 20, 30)));
  EXPECT_NE(model.instances[0].path, model.instances[1].path);
}

TEST_F(BrepBodies, ASolidThatStandsTurnedStandsThere) {
  gp_Trsf turned, moved;
  turned.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 0.5 * std::numbers::pi);
  moved.SetTranslation(gp_Vec(100, 0, 0));
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 10, 20, 30).Shape();
  Add(box);
  Add(box.Located(TopLoc_Location(moved * turned)));
  const CadModel model = Import();
  EXPECT_EQ(model.report.parts, 2);
  // It reaches from x = 80 to 100 now, and from y = 0 to 10.
  EXPECT_TRUE(model.report.bounds_mm.max().isApprox(Eigen::Vector3d(100, 20, 30)))
      << model.report.bounds_mm.max().transpose();
  EXPECT_TRUE(model.report.bounds_mm.min().isZero(1e-9));
}

TEST_F(BrepBodies, FacesOfNoSolidComeBesideTheSolids) {
  Add(BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 10, 20, 30).Shape());
  Add(TopExp_Explorer(BRepPrimAPI_MakeBox(gp_Pnt(40, 0, 0), 10, 20, 30).Shape(), TopAbs_FACE).Current());
  const CadModel model = Import();
  EXPECT_EQ(model.report.parts, 2);
  EXPECT_FALSE(model.report.watertight);
  EXPECT_EQ(model.report.triangles, 14);
}

}  // namespace
}  // namespace elbowroom::cad_import
