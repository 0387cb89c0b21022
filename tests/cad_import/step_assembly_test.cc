// Assemblies, written by OpenCASCADE's own STEP writer.
#include <gtest/gtest.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <set>
#include <string>
#include <vector>

#include "cad_import/cad_file.h"
#include "tests/support/step_assembly.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::cad_import {
namespace {

constexpr int kBalls = 100;

// A rack of `kBalls` balls of radius 5, 20 apart along x, on a plate.
void WriteRack(const std::filesystem::path& path) {
  const std::vector<test_support::StepBody> bodies = {
      {"ball", BRepPrimAPI_MakeSphere(5.0).Shape()},
      {"plate", BRepPrimAPI_MakeBox(gp_Pnt(-10, -10, -7), 20.0 * kBalls, 20, 2).Shape()}};
  std::vector<test_support::StepInstance> instances;
  for (int i = 0; i < kBalls; ++i)
    instances.push_back(
        {"ball " + std::to_string(i), 0, {Eigen::Matrix3d::Identity(), {20.0 * i, 0.0, 0.0}}});
  instances.push_back({"plate", 1, {}});
  test_support::WriteStepAssembly(path, "rack", bodies, instances);
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
