#include "app/control/scene_composer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "app/control/palette/part_colors.h"
#include "core/error.h"
#include "core/units.h"
#include "recon/appearance/camera_texture.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

// A side of the hull's picture from the lamp: about 2.5 mm a pixel in a workspace of a metre.
constexpr int kHullFromLampPx = 512;
constexpr float kSeeThrough = 0.3F;
// A part that stands before more than this share of the hull's pixels is drawn see-through.
constexpr double kHidesShare = 0.35;

// One a part.
std::vector<bool> PartsOfBrokenRules(const FrameResult& result) {
  std::vector<bool> breaks(result.layout->parts.size());
  if (!result.pairs) return breaks;
  for (const review::PairClash& pair : result.pairs->pairs)
    if (IsBroken(pair)) breaks[pair.demand.a] = breaks[pair.demand.b] = true;
  return breaks;
}

// The same picture with fewer pixels.
recon::SceneView Scaled(const recon::SceneView& view, double scale) {
  core::Require(scale > 0.0 && scale <= 1.0, "a hull's share of a picture's side is within (0, 1]");
  recon::SceneView scaled = view;
  scaled.width_px = std::max(1, static_cast<int>(std::lround(scale * view.width_px)));
  scaled.height_px = std::max(1, static_cast<int>(std::lround(scale * view.height_px)));
  scaled.focal_px = view.focal_px * scaled.width_px / view.width_px;
  return scaled;
}

// A cloth as it hangs; null for other parts.
core::SharedMesh MeshInWorld(const FrameResult& result, core::PartIndex part) {
  return result.response ? result.response->meshes_in_world[part] : nullptr;
}

std::vector<bool> PartsThatHang(const FrameResult& result) {
  std::vector<bool> hangs;
  for (core::PartIndex i = 0; i < result.layout->parts.size(); ++i)
    hangs.push_back(MeshInWorld(result, i) != nullptr);
  return hangs;
}

Eigen::AlignedBox3d BoundsInWorld(const FrameResult& result, core::PartIndex part) {
  if (const core::SharedMesh mesh = MeshInWorld(result, part)) return core::BoundsOf(*mesh);
  Eigen::AlignedBox3d bounds;
  for (const Vector3d& vertex : result.layout->parts[part].mesh->vertices_mm) {
    bounds.extend(result.world_from_parts[part] * vertex);
  }
  return bounds;
}

// Share of the hull's pixels that what is kept of the box stands before; every eighth pixel of every eighth
// row is looked at.
double HiddenShare(const recon::HullView& hull, const recon::SceneView& view, const Eigen::AlignedBox3d& box,
                   const SectionCut& cut) {
  const core::RigidTransform world_from_cam = view.cam_from_world.Inverse();
  int seen = 0, hidden = 0;
  for (int y = 0; y < hull.height_px; y += 8) {
    for (int x = 0; x < hull.width_px; x += 8) {
      const float depth_mm = hull.depth_mm[static_cast<std::size_t>(y * hull.width_px + x)];
      if (depth_mm <= 0.0F) continue;
      ++seen;
      const Vector3d point = world_from_cam * (view.RayInCam({x, y}) * static_cast<double>(depth_mm));
      hidden += MeetsKept(cut, box, world_from_cam.translation_mm, point) ? 1 : 0;
    }
  }
  return seen == 0 ? 0.0 : static_cast<double>(hidden) / seen;
}

// The camera with a picture whose view direction is closest to the viewer's.
std::optional<core::CameraIndex> NearestToViewer(const std::vector<core::CameraModel>& cameras,
                                                 const recon::FrameSet& frames,
                                                 const recon::SceneView& view) {
  std::optional<core::CameraIndex> nearest;
  double best_cosine = -2.0;
  for (core::CameraIndex i = 0; i < cameras.size(); ++i) {
    const double cosine =
        cameras[i].cam_from_world().rotation.row(2).dot(view.cam_from_world.rotation.row(2));
    if (frames.cameras[i].image_bgr.empty() || cosine <= best_cosine) continue;
    nearest = i;
    best_cosine = cosine;
  }
  return nearest;
}

// A stream's particles, an octahedron each.
recon::gl::ScenePart StreamPart(const review::StreamState& state, double radius_mm) {
  core::TriangleMesh octahedron;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0})
      octahedron.vertices_mm.push_back(side * radius_mm * Vector3d::Unit(axis));
  octahedron.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                          {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  auto mesh = std::make_shared<core::TriangleMesh>();
  for (const review::Particle& particle : state.particles)
    core::Append(*mesh, core::Transformed(octahedron, {Eigen::Matrix3d::Identity(), particle.x_in_world}));
  recon::gl::ScenePart part;
  part.mesh = std::move(mesh);
  part.color = {0.30F, 0.55F, 0.85F};
  return part;
}

// A box around the hull, to about a fiftieth of the workspace.
Eigen::AlignedBox3d HullBounds(const recon::VisualHull& hull) {
  const double edge_mm = hull.rig().workspace_mm.sizes().maxCoeff() / 50.0;
  return core::BoundsOf(recon::MeshHull(hull, edge_mm).mesh);
}

// How many points an eye can't see well: behind another part's box, or on the far side of their own part's.
std::size_t CountHidden(const std::vector<core::ContactPoint>& points, const Vector3d& eye,
                        const std::vector<Eigen::AlignedBox3d>& part_bounds, core::PartIndex own) {
  return static_cast<std::size_t>(
      std::count_if(points.begin(), points.end(), [&](const core::ContactPoint& point) {
        const Vector3d& at = point.position_in_world_mm;
        if ((eye - at).dot(at - part_bounds[own].center()) < 0.0) return true;
        for (core::PartIndex i = 0; i < part_bounds.size(); ++i) {
          if (i != own && MeetsKept({}, part_bounds[i], eye, at)) return true;
        }
        return false;
      }));
}

}  // namespace

recon::gl::Scene SceneComposer::Compose(const FrameResult& result, const recon::SceneView& view,
                                        const SceneLook& look, double hull_scale) {
  Forget(result.hull, look.cut);
  if (camera_frames_ != result.camera_frames) photos_.clear();
  camera_frames_ = result.camera_frames;
  recon::gl::Scene scene;
  scene.view = view;
  scene.lamp = recon::gl::LampOver(result.hull->rig().workspace_mm);
  scene.hull_appearance = look.hull;
  needs_surfaces_ = look.knowledge != nullptr && ShowsKnowledge(look.hull);
  const recon::SceneView hull_view = Scaled(view, hull_scale);
  scene.hull = HullFrom(hull_view);
  const std::vector<bool> breaks_rule = PartsOfBrokenRules(result);
  for (core::PartIndex i = 0; i < result.layout->parts.size(); ++i) {
    recon::gl::ScenePart part;
    if (const core::SharedMesh in_world = MeshInWorld(result, i)) {
      part.mesh = in_world;
    } else {
      part.mesh = result.layout->parts[i].mesh;
      part.world_from_part = result.world_from_parts[i];
    }
    const bool has_layer = look.heat != nullptr || needs_surfaces_;
    const Color plain = has_layer ? kPartBesideLayerColor : PlainPartColor(i);
    part.color = breaks_rule[i] ? BrokenRuleColor() : plain;
    part.in_contact = !has_layer && result.record.contacts[i].verdict == core::Verdict::kContact;
    if (HiddenShare(*scene.hull, hull_view, BoundsInWorld(result, i), look.cut) > kHidesShare)
      part.opacity = kSeeThrough;
    AddPart(std::move(part), i, look.cut, &scene);
    if (MeshInWorld(result, i)) continue;  // its contacts are on its shape at rest
    if (look.heat != nullptr) continue;    // they would cover the heat below them
    for (const core::ContactPoint& point : result.record.contacts[i].points)
      if (look.cut.Keeps(point.position_in_world_mm))
        scene.contact_points_in_world.push_back(point.position_in_world_mm);
  }
  for (std::size_t i = 0; result.response && i < result.response->streams.size(); ++i) {
    const review::StreamState& stream = result.response->streams[i];
    if (!stream.particles.empty())
      scene.parts.push_back(StreamPart(stream, result.layout->streams[i].radius_mm));
  }
  if (look.heat != nullptr)
    heat_.AddTo(&scene, *look.heat, result.world_from_parts, PartsThatHang(result), look.cut);
  scene.hull_camera_color = PixelColors(look, view, hull_view);
  scene.hull_from_lamp = HullFromLamp(scene.lamp);
  const Eigen::AlignedBox3d& workspace_mm = result.hull->rig().workspace_mm;
  scene.table_in_world = Eigen::AlignedBox2d(workspace_mm.min().head<2>(), workspace_mm.max().head<2>());
  scene.table_grid_mm = workspace_mm.sizes().head<2>().maxCoeff() > 2500.0 ? 500.0 : 100.0;
  return scene;
}

void SceneComposer::Foresee(const SharedHull& hull, const recon::SceneView& view, double hull_scale) {
  Forget(hull, cut_);
  (void)HullFrom(Scaled(view, hull_scale));
}

void SceneComposer::AddPart(recon::gl::ScenePart part, core::PartIndex index, const SectionCut& cut,
                            recon::gl::Scene* scene) {
  if (cut.is_none()) return scene->parts.push_back(std::move(part));
  const PartSection& section = sections_.Of(index, part.mesh, part.world_from_part, cut);
  if (section.surface != nullptr) {
    part.mesh = section.surface;
    scene->parts.push_back(part);
  }
  if (section.cut_faces == nullptr) return;
  part.mesh = section.cut_faces;
  part.is_cut_face = true;
  scene->parts.push_back(std::move(part));
}

// Forgets what was made for another hull, or another cut of it.
void SceneComposer::Forget(const SharedHull& hull, const SectionCut& cut) {
  if (hull_ == hull && cut_ == cut) return;
  if (hull_ != hull) photos_.clear();  // they look at the whole hull
  hull_ = hull;
  cut_ = cut;
  SpareView();
  hull_from_lamp_.reset();
}

// Keeps the view's memory for the next one, unless a scene still shows it.
void SceneComposer::SpareView() {
  if (hull_from_view_ != nullptr && hull_from_view_.use_count() == 1) spare_ = std::move(*hull_from_view_);
  hull_from_view_.reset();
}

SceneComposer::SharedView SceneComposer::HullFrom(const recon::SceneView& view) {
  const bool lacks_surfaces =
      needs_surfaces_ && hull_from_view_ != nullptr && hull_from_view_->surface.empty();
  if (hull_from_view_ == nullptr || lacks_surfaces || !(view_ == view)) {
    SpareView();
    const recon::ViewRays rays = recon::ViewRays(CameraOf(view)).Within(cut_.kept);
    hull_from_view_ = std::make_shared<recon::HullView>(
        needs_surfaces_ ? recon::ViewHull(*hull_, rays, {}, std::exchange(spare_, {}))
                        : make_view_(*hull_, rays, std::exchange(spare_, {})));
    view_ = view;
    ++hull_views_;
  }
  return hull_from_view_;
}

SceneComposer::SharedView SceneComposer::HullFromLamp(const recon::gl::SceneLamp& lamp) {
  if (hull_from_lamp_ == nullptr) {
    const recon::SceneView from_lamp = lamp.ShadowView(kHullFromLampPx);
    hull_from_lamp_ = std::make_shared<const recon::HullView>(
        recon::ViewHull(*hull_, recon::ViewRays(recon::CameraOf(from_lamp)).Within(cut_.kept),
                        {.surfaces = false, .normals = false}));
    ++extra_hull_views_;
  }
  return hull_from_lamp_;
}

std::vector<recon::CameraColor> SceneComposer::PixelColors(const SceneLook& look,
                                                           const recon::SceneView& view,
                                                           const recon::SceneView& hull_view) {
  if (needs_surfaces_)
    return hull_colors_.Of(look.hull, look.knowledge, hull_, *hull_, *hull_from_view_,
                           recon::ViewRays(CameraOf(hull_view)));
  const std::vector<SharedPhoto> photos = PhotosFor(look, view);
  if (photos.empty()) return {};
  return recon::ColorHull(*hull_from_view_, hull_view, photos);
}

std::vector<SceneComposer::SharedPhoto> SceneComposer::PhotosFor(const SceneLook& look,
                                                                 const recon::SceneView& view) {
  const bool wants_one = look.hull == recon::HullAppearance::kOneCamera;
  if (camera_frames_ == nullptr || !(wants_one || look.hull == recon::HullAppearance::kRigCameras)) return {};
  const std::vector<core::CameraModel>& cameras = hull_->rig().cameras;
  photos_.resize(cameras.size() + 1);
  if (const auto& viewer = camera_frames_->viewer; viewer && wants_one)
    return {PhotoOf(cameras.size(), *viewer->camera, viewer->image_bgr)};
  std::optional<core::CameraIndex> chosen;
  if (wants_one) chosen = NearestToViewer(cameras, *camera_frames_, view);
  std::vector<SharedPhoto> wanted;
  for (core::CameraIndex i = 0; i < cameras.size(); ++i) {
    const cv::Mat& image_bgr = camera_frames_->cameras[i].image_bgr;
    if (image_bgr.empty() || (wants_one && chosen != i)) continue;
    wanted.push_back(PhotoOf(i, cameras[i], image_bgr));
  }
  return wanted;
}

const SceneComposer::SharedPhoto& SceneComposer::PhotoOf(std::size_t place, const core::CameraModel& camera,
                                                         const cv::Mat& image_bgr) {
  if (photos_[place] == nullptr) {
    photos_[place] = std::make_shared<const recon::CameraTexture>(*hull_, camera, image_bgr);
    ++extra_hull_views_;
  }
  return photos_[place];
}

recon::OrbitCamera OverviewCamera(const FrameResult& result, int width_px, int height_px) {
  Eigen::AlignedBox3d box = HullBounds(*result.hull);
  for (core::PartIndex i = 0; i < result.layout->parts.size(); ++i) box.extend(BoundsInWorld(result, i));
  if (box.isEmpty()) box = result.hull->rig().workspace_mm;
  recon::OrbitCamera camera;
  camera.azimuth_rad = core::RadiansFromDegrees(-60.0);
  camera.elevation_rad = core::RadiansFromDegrees(9.0);
  return recon::FittedTo(camera, box, width_px, height_px);
}

recon::OrbitCamera ContactCamera(const FrameResult& result, core::PartIndex part, int width_px,
                                 int height_px) {
  const std::vector<core::ContactPoint>& points = result.record.contacts[part].points;
  if (points.empty()) return OverviewCamera(result, width_px, height_px);
  Eigen::AlignedBox3d box;
  for (const core::ContactPoint& point : points) box.extend(point.position_in_world_mm);
  // Room around the contact, to see what touches what.
  constexpr double kAroundMm = 150.0;
  const Eigen::AlignedBox3d around(box.min().array() - kAroundMm, box.max().array() + kAroundMm);

  std::vector<Eigen::AlignedBox3d> part_bounds;
  for (core::PartIndex i = 0; i < result.layout->parts.size(); ++i)
    part_bounds.push_back(BoundsInWorld(result, i));
  std::optional<recon::OrbitCamera> best;
  std::size_t fewest_hidden = 0;
  for (const double elevation_deg : {20.0, 4.0, -12.0, 45.0}) {
    for (int step = 0; step < 12; ++step) {
      recon::OrbitCamera camera;
      camera.azimuth_rad = core::RadiansFromDegrees(-60.0 + 30.0 * step);
      camera.elevation_rad = core::RadiansFromDegrees(elevation_deg);
      camera = recon::FittedTo(camera, around, width_px, height_px);
      const Vector3d eye = recon::ViewFrom(camera, width_px, height_px).EyeInWorld();
      const std::size_t hidden = CountHidden(points, eye, part_bounds, part);
      if (!best || hidden < fewest_hidden) {
        best = camera;
        fewest_hidden = hidden;
      }
    }
  }
  return *best;
}

}  // namespace elbowroom::control
