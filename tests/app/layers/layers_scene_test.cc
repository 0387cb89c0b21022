// The layers in the picture: heat on the parts, also cut open and moved; the hull's colours; nothing when
// off.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/frame_pipeline.h"
#include "app/control/layers/heat_layer.h"
#include "app/control/layers/hull_colors.h"
#include "app/control/palette/scale_color.h"
#include "app/control/scene_composer.h"
#include "core/bvh.h"
#include "core/part_distance.h"
#include "core/surface_patches.h"
#include "recon/appearance/orbit_camera.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;
using recon::HullAppearance;

class Layers : public testing::Test {
 protected:
  Layers()
      : setup_(MakeDemoTrial(DemoPlay::kOnce)),
        pipeline_(setup_.source->rig(), setup_.layout, setup_.source->ReadBackgrounds({}, {}),
                  setup_.segmentation) {
    look_.knowledge = KnowledgeOf(setup_.source->rig(), {});
  }

  // The demo's hand holds its pipe.
  SharedFrameResult Frame(double gap_mm) {
    return pipeline_.Process(setup_.source->Read(66), std::vector<double>{gap_mm});
  }

  // All of a part's upper side was touched for a second, the rest never.
  SharedHeatLayer HeatOnTopOf(core::PartIndex part) {
    std::vector<core::SharedMesh> meshes;
    for (const core::Part& each : setup_.layout.parts) meshes.push_back(each.mesh);
    HeatLayerMaker maker(meshes);
    const core::SurfacePatches patches(meshes[part], core::kHeatPatchMm);
    core::HeatMap map;
    map.part = part;
    map.dwell_s.assign(patches.size(), 0.0F);
    for (std::size_t t = 0; t < meshes[part]->triangles.size(); ++t) {
      std::size_t patch = patches.FirstOf(t);
      for (const auto& p : patches.CornersOf(t))
        map.dwell_s[patch++] = (p.b - p.a).cross(p.c - p.a).normalized().z() > 0.9 ? 1.0F : 0.0F;
    }
    maker.Take(map);
    return maker.Make();
  }

  static recon::SceneView View() {
    recon::OrbitCamera camera;
    camera.target_in_world = {50.0, 0.0, 210.0};
    camera.distance_mm = 1400.0;
    camera.elevation_rad = 0.6;
    return recon::ViewFrom(camera, 320, 240);
  }

  TrialSetup setup_;
  FramePipeline pipeline_;
  SceneLook look_;
  recon::gl::SceneRenderer renderer_;
};

int PixelsThatDiffer(const recon::Image& a, const recon::Image& b) {
  int differ = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3)
    differ += a.rgb[i] != b.rgb[i] || a.rgb[i + 1] != b.rgb[i + 1] || a.rgb[i + 2] != b.rgb[i + 2] ? 1 : 0;
  return differ;
}

TEST_F(Layers, HeatColoursThePlacesThatWereTouchedAndNoOthers) {
  const SharedFrameResult frame = Frame(240.0);
  look_.heat = std::make_shared<HeatLayer>();
  SceneComposer composer;
  recon::gl::Scene without = composer.Compose(*frame, View(), look_);
  look_.heat = HeatOnTopOf(0);
  recon::gl::Scene with = composer.Compose(*frame, View(), look_);
  EXPECT_TRUE(with.contact_points_in_world.empty());  // they would cover it
  without.hull = with.hull = nullptr;
  for (recon::gl::ScenePart& part : without.parts) part.opacity = 1.0F;
  for (recon::gl::ScenePart& part : with.parts) part.opacity = 1.0F;
  const recon::gl::DepthImage depth = renderer_.RenderDepth(with);
  const recon::Image plain = renderer_.Render(without), heated = renderer_.Render(with);
  EXPECT_EQ(depth.depth_mm, renderer_.RenderDepth(without).depth_mm);  // it has no depth of its own
  const core::RigidTransform part_from_cam =
      frame->world_from_parts[0].Inverse() * with.view.cam_from_world.Inverse();
  const core::SharedMesh mesh = setup_.layout.parts[0].mesh;
  const core::TriangleTree tree(mesh);
  // Which pixels show the upper side: the slow way, by the nearest triangle.
  std::vector<bool> is_upper(depth.depth_mm.size());
  for (std::size_t at = 0; at < is_upper.size(); ++at) {
    if (depth.depth_mm[at] <= 0.0F) continue;
    const auto width = static_cast<std::size_t>(depth.width_px);
    const Eigen::Vector2d pixel(static_cast<double>(at % width), static_cast<double>(at / width));
    const Vector3d place =
        part_from_cam * (with.view.RayInCam(pixel) * static_cast<double>(depth.depth_mm[at]));
    const auto nearest = core::FindNearest(tree, {.center = place});
    const auto& [a, b, c] = mesh->triangles[nearest.triangle];
    const auto corner = [&](std::int32_t i) { return mesh->vertices_mm[static_cast<std::size_t>(i)]; };
    const Vector3d normal = (corner(b) - corner(a)).cross(corner(c) - corner(a)).normalized();
    is_upper[at] = nearest.distance_mm < 1.0 && normal.z() > 0.9;
  }
  int inside = 0, coloured_inside = 0, coloured_outside = 0;
  for (int y = 1; y + 1 < depth.height_px; ++y) {
    for (int x = 1; x + 1 < depth.width_px; ++x) {
      int upper = 0;
      for (int k = 0; k < 9; ++k)
        upper += is_upper[static_cast<std::size_t>((y + k / 3 - 1) * depth.width_px + x + k % 3 - 1)] ? 1 : 0;
      const auto at = static_cast<std::size_t>(y * depth.width_px + x);
      const bool differs = !std::equal(&plain.rgb[3 * at], &plain.rgb[3 * at] + 3, &heated.rgb[3 * at]);
      inside += upper == 9 ? 1 : 0;
      coloured_inside += upper == 9 && differs ? 1 : 0;
      coloured_outside += upper == 0 && differs ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 300);
  EXPECT_EQ(coloured_inside, inside);
  EXPECT_EQ(coloured_outside, 0);
  EXPECT_EQ(renderer_.shadow_count().part_passes, 1);  // nor a shadow
}

TEST_F(Layers, HeatMovesWithItsPartAndIsCutWithIt) {
  look_.heat = HeatOnTopOf(0);
  SceneComposer composer;
  const auto decals = [](const recon::gl::Scene& scene) {
    std::vector<recon::gl::ScenePart> found;
    std::ranges::copy_if(scene.parts, std::back_inserter(found), &recon::gl::ScenePart::is_decal);
    return found;
  };
  for (const double gap_mm : {240.0, 260.0}) {
    const SharedFrameResult frame = Frame(gap_mm);
    for (const recon::gl::ScenePart& decal : decals(composer.Compose(*frame, View(), look_))) {
      EXPECT_TRUE(decal.world_from_part == frame->world_from_parts[0]);
      EXPECT_EQ(decal.mesh, look_.heat->parts[0]->pieces[0].mesh);  // nothing is made anew
    }
  }
  const SharedFrameResult frame = Frame(240.0);
  const Vector3d middle = core::BoundsOf(*setup_.layout.parts[0].mesh, frame->world_from_parts[0]).center();
  look_.cut.kept = {{Vector3d::UnitX(), middle.x()}};
  const auto cut = decals(composer.Compose(*frame, View(), look_));
  ASSERT_EQ(cut.size(), 1U);
  double highest = -1e9;
  for (const Vector3d& vertex : cut[0].mesh->vertices_mm)
    highest = std::max(highest, (frame->world_from_parts[0] * vertex).x());
  EXPECT_NEAR(highest, middle.x(), 1e-6);
  EXPECT_EQ(decals(composer.Compose(*frame, View(), look_))[0].mesh, cut[0].mesh);
  look_.cut.kept = {{Vector3d::UnitX(), -1e4}};
  EXPECT_TRUE(decals(composer.Compose(*frame, View(), look_)).empty());
}

TEST_F(Layers, TheHullHasTheColoursOfItsValues) {
  const SharedFrameResult frame = Frame(240.0);
  for (const HullAppearance appearance : {HullAppearance::kCoverage, HullAppearance::kUncertainty}) {
    look_.hull = appearance;
    SceneComposer composer;
    const recon::gl::Scene scene = composer.Compose(*frame, View(), look_);
    ASSERT_EQ(scene.hull_camera_color.size(), scene.hull->depth_mm.size());
    const recon::ViewRays rays(recon::CameraOf(View()));
    recon::SurfaceCoverage coverage(look_.knowledge->rig);
    coverage.LookAt(*frame->hull);
    const recon::SurfaceUncertainty uncertainty(look_.knowledge->rig, look_.knowledge->errors);
    const bool counts = appearance == HullAppearance::kCoverage;
    const recon::SurfaceValues values = counts ? coverage.Of(*frame->hull, *scene.hull, rays)
                                               : uncertainty.Of(*frame->hull, *scene.hull, rays);
    int coloured = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!values[i]) continue;
      const double share = static_cast<double>(*values[i]) / (counts ? 4.0 : look_.knowledge->most_mm);
      const Color expected = ScaleColor(counts ? 1.0 - share : share);
      const auto& shown = scene.hull_camera_color[i];
      ++coloured;
      // The surface's slope takes up to a quarter of the light, and leaves the colour's shares.
      const float light = static_cast<float>(shown[0]) / (255.0F * expected.x());
      EXPECT_GT(light, 0.74F);
      EXPECT_LT(light, 1.01F);
      EXPECT_NEAR(static_cast<float>(shown[1]), 255.0F * light * expected.y(), 2.5F);
      EXPECT_EQ(shown[3], 255);
    }
    EXPECT_GT(coloured, 500);
    EXPECT_GT(
        PixelsThatDiffer(renderer_.Render(scene), renderer_.Render(SceneComposer().Compose(*frame, View()))),
        coloured / 2);
  }
}

TEST_F(Layers, TheRigLooksAtAHullOnceAndAtAllOfItThoughItIsCut) {
  const SharedFrameResult frame = Frame(240.0);
  look_.hull = HullAppearance::kCoverage;
  SceneComposer composer;
  (void)composer.Compose(*frame, View(), look_);
  recon::SceneView turned = View();
  turned.cam_from_world.translation_mm.x() += 30.0;
  (void)composer.Compose(*frame, turned, look_);
  EXPECT_EQ(composer.coverage_looks(), 1);
  look_.cut.kept = {{-Vector3d::UnitY(), -5.0}};
  const recon::gl::Scene cut = composer.Compose(*frame, View(), look_);
  EXPECT_EQ(composer.coverage_looks(), 1);
  int faces = 0;
  for (std::size_t i = 0; i < cut.hull->depth_mm.size(); ++i) {
    if (!cut.hull->surface[i].is_hit() || cut.hull->surface[i].camera()) continue;
    ++faces;
    EXPECT_EQ(cut.hull_camera_color[i][0], cut.hull_camera_color[i][2]) << "the cut's face isn't grey";
  }
  EXPECT_GT(faces, 20);
}

TEST_F(Layers, PicturesWithoutLayersAreAsTheyWereAndCostNothing) {
  const SharedFrameResult frame = Frame(240.0);
  SceneComposer plain, with_knowledge;
  const recon::Image without = renderer_.Render(plain.Compose(*frame, View(), SceneLook{}));
  const recon::gl::Scene scene = with_knowledge.Compose(*frame, View(), look_);
  EXPECT_TRUE(scene.hull_camera_color.empty());
  EXPECT_TRUE(std::ranges::none_of(scene.parts, &recon::gl::ScenePart::is_decal));
  EXPECT_EQ(with_knowledge.coverage_looks(), 0);
  EXPECT_EQ(with_knowledge.extra_hull_views(), plain.extra_hull_views());
  EXPECT_EQ(renderer_.Render(scene).rgb, without.rgb);
  // On, and off again.
  look_.hull = HullAppearance::kCoverage;
  look_.heat = HeatOnTopOf(0);
  (void)with_knowledge.Compose(*frame, View(), look_);
  look_.hull = HullAppearance::kByNormal;
  look_.heat = nullptr;
  EXPECT_EQ(renderer_.Render(with_knowledge.Compose(*frame, View(), look_)).rgb, without.rgb);
}

}  // namespace
}  // namespace elbowroom::control
