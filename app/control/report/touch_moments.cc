#include "app/control/report/touch_moments.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "app/control/recorded_frame.h"
#include "app/control/report/cut_away.h"
#include "core/error.h"
#include "core/units.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "recon/images/png_file.h"

namespace elbowroom::control {
namespace {

constexpr int kSnapshotWidthPx = 320;
constexpr int kSnapshotHeightPx = 220;
// Cubes along the longest side of the hull, to show it; first it is looked for with larger ones.
constexpr double kHullCubes = 64.0;
constexpr double kSearchCubes = 48.0;  // along the longest side of the workspace

core::TriangleMesh ShownHull(const FrameResult& result, const Eigen::AlignedBox3d& workspace_mm) {
  const double search_mm = workspace_mm.sizes().maxCoeff() / kSearchCubes;
  const core::TriangleMesh coarse = recon::MeshHull(*result.hull, search_mm).mesh;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : coarse.vertices_mm) box.extend(x);
  const double edge_mm = box.isEmpty() ? search_mm : box.sizes().maxCoeff() / kHullCubes;
  return recon::MeshHull(*result.hull, std::clamp(edge_mm, search_mm / 16.0, search_mm)).mesh;
}

sessions::ReportModel::Moment MomentOf(const FrameResult& result, const Eigen::AlignedBox3d& workspace_mm) {
  sessions::ReportModel::Moment moment{
      result.record.frame, result.world_from_parts, ShownHull(result, workspace_mm), {}};
  for (const core::PartContact& contact : result.record.contacts)
    for (const core::ContactPoint& point : contact.points)
      moment.contacts_in_world_mm.push_back(point.position_in_world_mm);
  return moment;
}

// The same picture from nearer, with the least field of view that BCF takes.
sessions::TopicCamera TopicCameraOf(recon::OrbitCamera camera) {
  sessions::TopicCamera shown;
  const double fov_rad = core::RadiansFromDegrees(shown.vertical_fov_deg);
  camera.distance_mm *= std::tan(0.5 * camera.vertical_fov_rad) / std::tan(0.5 * fov_rad);
  const core::RigidTransform world_from_cam =
      recon::ViewFrom(camera, kSnapshotWidthPx, kSnapshotHeightPx).cam_from_world.Inverse();
  shown.eye_mm = world_from_cam.translation_mm;
  shown.direction = world_from_cam.rotation.col(2);
  shown.up = -world_from_cam.rotation.col(1);
  return shown;
}

bool HasMoment(const sessions::ReportModel& model, core::FrameIndex frame) {
  return std::ranges::find(model.moments, frame, &sessions::ReportModel::Moment::frame) !=
         model.moments.end();
}

}  // namespace

std::vector<std::size_t> WorstTouches(const sessions::TouchList& list) {
  std::vector<std::size_t> places(list.touches.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::ranges::stable_sort(places, {}, [&](std::size_t place) {
    const sessions::ReportTouch& touch = list.touches[place];
    return std::tuple(touch.is_near_miss, touch.closest ? touch.closest->interval.upper_mm : 0.0,
                      -touch.depth_mm);
  });
  if (places.size() > kMostMoments) places.resize(kMostMoments);
  return places;
}

void AddTouchMoments(const sessions::SessionReader& session, const FrameResult& shown,
                     recon::gl::SceneRenderer& renderer, SceneComposer& composer, std::stop_token stop,
                     sessions::ReportPictures* pictures) {
  const Eigen::AlignedBox3d& workspace_mm = session.header().rig.workspace_mm;
  const sessions::TouchList list = sessions::TouchesOf(session);
  for (const std::size_t place : WorstTouches(list)) {
    core::ThrowIfStopped(stop, "the report");
    const sessions::ReportTouch& touch = list.touches[place];
    const SharedFrameResult frame = RebuildFrame(session, touch.frame);
    const recon::OrbitCamera camera =
        touch.is_near_miss ? OverviewCamera(*frame, kSnapshotWidthPx, kSnapshotHeightPx)
                           : ContactCamera(*frame, touch.part, kSnapshotWidthPx, kSnapshotHeightPx);
    const recon::Image picture = renderer.Render(
        composer.Compose(*frame, recon::ViewFrom(camera, kSnapshotWidthPx, kSnapshotHeightPx)));
    const sessions::TopicCamera topic_camera = TopicCameraOf(camera);
    std::optional<sessions::TopicCut> cut;
    if (touch.at_in_world_mm) cut = CutBefore(*frame, topic_camera.eye_mm, *touch.at_in_world_mm);
    pictures->touches.push_back({place, recon::EncodePng(picture), topic_camera, cut});
    if (!HasMoment(pictures->model, touch.frame))
      pictures->model.moments.push_back(MomentOf(*frame, workspace_mm));
  }
  if (pictures->model.moments.empty()) pictures->model.moments.push_back(MomentOf(shown, workspace_mm));
}

}  // namespace elbowroom::control
