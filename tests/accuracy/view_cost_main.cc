// view_cost: one exact view on one thread, for callgrind to count; prints the pixels that the hull fills.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/view_scene.h"
#include "tests/accuracy/hard/hard_hulls.h"

namespace elbowroom::accuracy {
namespace {

struct CostOptions {
  bool eight = false;           // the rig of eight cameras, 1280 x 720
  std::string shape = "hand";   // in the workspace: "hand", or a hard hull
  double zoom = 1.0;            // of the view's focal length
  int view_size = 1;            // factor on the view's width and height, its focal length unchanged
  int picture_size = 1;         // the same for the rig's cameras
  double workspace_size = 1.0;  // factor on its sides, its centre unchanged
  bool away = false;            // look the other way
  bool blind = false;           // the first camera sees no object
  bool unchanged = false;       // the frame before had the same masks, and was seen from the standard place
  bool moved = false;           // look from 10 mm beside
};

// Throws: PreconditionError for a shape that there isn't.
std::vector<recon::SyntheticObject> ObjectsOf(const std::string& shape, const recon::ViewScene& scene) {
  if (shape == "hand") return scene.objects;
  for (const HardHull hull : kHardHulls)
    if (shape == ToString(hull)) return {ObjectOf(hull)};
  throw core::PreconditionError("a shape is hand, or a hard hull");
}

core::CameraModel WithMorePicture(const core::CameraModel& camera, int factor) {
  core::CameraCalibration c = camera.calibration();
  c.camera_matrix(0, 2) += 0.5 * (factor - 1) * c.image_width_px;
  c.camera_matrix(1, 2) += 0.5 * (factor - 1) * c.image_height_px;
  c.image_width_px *= factor;
  c.image_height_px *= factor;
  return core::CameraModel(std::move(c));
}

core::CameraModel ViewOf(const core::CameraModel& standard, const CostOptions& options) {
  core::CameraCalibration c = WithMorePicture(standard, options.view_size).calibration();
  c.camera_matrix.topLeftCorner<2, 2>() *= options.zoom;
  if (options.away) {
    const Eigen::Vector3d& center_in_world = standard.center_in_world();
    c.cam_from_world.rotation.row(0) *= -1.0;
    c.cam_from_world.rotation.row(2) *= -1.0;
    c.cam_from_world.translation_mm = -(c.cam_from_world.rotation * center_in_world);
  }
  if (options.moved) c.cam_from_world.translation_mm.x() += 10.0;
  return core::CameraModel(std::move(c));
}

// What is counted: masks in memory to depth, after the hull of the frame before, if any.
[[gnu::noinline]] recon::HullView CountedView(const std::shared_ptr<const recon::VisualHull>& last,
                                              const std::shared_ptr<const core::Rig>& rig,
                                              const recon::UndistortedPlanes& planes,
                                              const std::vector<core::SoftMask>& masks,
                                              const recon::ViewRays& view) {
  return recon::ViewHull(*recon::NextHull(last, rig, planes, masks).hull, view,
                         {.surfaces = false, .normals = false});
}

void Run(const CostOptions& options) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  recon::ViewScene scene =
      recon::MakeViewScene(options.eight ? recon::ViewSceneRig::kEight : recon::ViewSceneRig::kThree);
  for (core::CameraModel& camera : scene.rig.cameras) camera = WithMorePicture(camera, options.picture_size);
  std::vector<core::SoftMask> masks = recon::TrueMasks(scene.rig, ObjectsOf(options.shape, scene));
  if (options.blind) masks[0].mask = core::BitMask(masks[0].mask.width_px(), masks[0].mask.height_px());
  const Eigen::Vector3d center = scene.rig.workspace_mm.center();
  const Eigen::Vector3d half = 0.5 * options.workspace_size * scene.rig.workspace_mm.sizes();
  scene.rig.workspace_mm = {center - half, center + half};
  const auto rig = std::make_shared<const core::Rig>(scene.rig);
  const recon::UndistortedPlanes planes = recon::MakeUndistortedPlanes(*rig);
  std::shared_ptr<const recon::VisualHull> last;
  if (options.unchanged) {
    last = recon::NextHull(nullptr, rig, planes, masks).hull;
    (void)recon::ViewHull(*last, recon::ViewRays(scene.view));
  }
  const recon::ViewRays view(ViewOf(scene.view, options));
  fmt::print("{}\n", CountedView(last, rig, planes, masks, view).hit_pixels);
}

}  // namespace
}  // namespace elbowroom::accuracy

int main(int argc, char** argv) {
  CLI::App app{"One exact view of the demo's hand, for callgrind to count."};
  elbowroom::accuracy::CostOptions options;
  app.add_flag("--eight", options.eight, "the rig of eight cameras of 1280 x 720");
  app.add_option("--shape", options.shape, "hand, fist, spread fingers, reaching hand or two people");
  app.add_option("--zoom", options.zoom, "factor on the view's focal length");
  app.add_option("--view-size", options.view_size, "factor on the view's width and height");
  app.add_option("--picture-size", options.picture_size, "factor on the rig's pictures' width and height");
  app.add_option("--workspace-size", options.workspace_size, "factor on the workspace's sides");
  app.add_flag("--away", options.away, "look the other way");
  app.add_flag("--blind", options.blind, "the first camera sees no object");
  app.add_flag("--unchanged", options.unchanged, "the frame before had the same masks");
  app.add_flag("--moved", options.moved, "look from 10 mm beside");
  CLI11_PARSE(app, argc, argv);
  elbowroom::accuracy::Run(options);
  return 0;
}
