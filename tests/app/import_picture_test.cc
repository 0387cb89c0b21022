// Defects as pixels: there in their colours where there are some, absent where there are none.
#include "app/control/import_picture.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/core/solids.h"

namespace elbowroom::control {
namespace {

cad_import::CadModel ModelOf(core::TriangleMesh mesh) {
  cad_import::CadModel model;
  model.report.bounds_mm = core::BoundsOf(mesh);
  model.report.unit = "mm";
  model.report.watertight = core::IsWatertight(mesh);
  model.shapes.push_back({"it", std::make_shared<const core::TriangleMesh>(std::move(mesh)), {}, {}});
  model.shapes[0].surface.self_intersections.reset();  // not looked for yet
  model.instances.push_back({"it", 0, {}, std::nullopt});
  return model;
}

int CountPixels(const recon::Image& image, int red, int green, int blue) {
  int count = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    count += image.rgb[i] == red && image.rgb[i + 1] == green && image.rgb[i + 2] == blue ? 1 : 0;
  return count;
}

class ImportPictureTest : public testing::Test {
 protected:
  recon::Image Picture(const cad_import::CadModel& model) {
    return ImportPicture(renderer_, model, cad_import::FindDefects(model));
  }
  recon::gl::SceneRenderer renderer_;
};

TEST_F(ImportPictureTest, ASoundBoxHasNoLines) {
  const recon::Image image = Picture(ModelOf(core::testing::Box({100, 80, 60})));
  EXPECT_EQ(CountPixels(image, 0xd6, 0x27, 0x28), 0);
  EXPECT_EQ(CountPixels(image, 0xff, 0x8c, 0x00), 0);
}

TEST_F(ImportPictureTest, AnOpenBoxHasItsRimInRed) {
  core::TriangleMesh mesh = core::testing::Box({100, 80, 60});
  mesh.triangles.resize(10);
  const cad_import::CadModel model = ModelOf(mesh);
  EXPECT_FALSE(cad_import::FindDefects(model).open_edges.empty());
  EXPECT_GT(CountPixels(Picture(model), 0xd6, 0x27, 0x28), 200);
}

TEST_F(ImportPictureTest, TrianglesThatCrossAreOrange) {
  core::TriangleMesh mesh = core::testing::Box({100, 80, 60});
  core::Append(mesh, core::Transformed(mesh, {Eigen::Matrix3d::Identity(), {50, 40, 30}}));
  const cad_import::CadModel model = ModelOf(mesh);
  EXPECT_FALSE(cad_import::FindDefects(model).crossing.empty());
  EXPECT_GT(CountPixels(Picture(model), 0xff, 0x8c, 0x00), 200);
}

}  // namespace
}  // namespace elbowroom::control
