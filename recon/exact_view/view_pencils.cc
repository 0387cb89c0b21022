#include "recon/exact_view/view_pencils.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// A view's centre nearer to a face than this many mm counts as on it, and orthographic rays that climb less
// than this in a mm count as parallel to it. Quotients by a smaller number wouldn't fit in float32.
constexpr double kLeastDivisor = 1e-20;

constexpr double kFaceRounding = 1e-5;

double HighestOf(const AffineForm& form, const Eigen::AlignedBox2d& box) {
  return form.at_origin + std::max(form.du * box.min().x(), form.du * box.max().x()) +
         std::max(form.dv * box.min().y(), form.dv * box.max().y());
}
double LowestOf(const AffineForm& form, const Eigen::AlignedBox2d& box) {
  return -HighestOf({-form.du, -form.dv, -form.at_origin}, box);
}

}  // namespace

ViewPencils::Face ViewPencils::FaceOf(const HalfSpace& half_space, const ViewRays& rays,
                                      const core::RigidTransform& world_from_view) {
  // Inside: outward . x <= height, x in view.
  const Vector3d outward = world_from_view.rotation.transpose() * half_space.outward;
  const double height = -half_space.BeyondMm(world_from_view.translation_mm);
  if (rays.projection() == Projection::kPerspective) {
    // outward . d <= height / depth = -height * key.
    if (std::abs(height) < kLeastDivisor)
      return {Face::Kind::kBeside, {-outward.x(), -outward.y(), -outward.z()}};
    return {height > 0.0 ? Face::Kind::kNotAfter : Face::Kind::kNotBefore,
            {-outward.x() / height, -outward.y() / height, -outward.z() / height}};
  }
  if (std::abs(outward.z()) < kLeastDivisor)
    return {Face::Kind::kBeside, {-outward.x(), -outward.y(), height}};
  return {outward.z() > 0.0 ? Face::Kind::kNotAfter : Face::Kind::kNotBefore,
          {-outward.x() / outward.z(), -outward.y() / outward.z(), height / outward.z()}};
}

std::vector<ViewPencils::Face> ViewPencils::FacesOf(const Eigen::AlignedBox3d& box, const ViewRays& rays) {
  const core::RigidTransform world_from_view = rays.view_from_world().Inverse();
  std::vector<Face> faces;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    faces.push_back(FaceOf({-Vector3d::Unit(axis), -box.min()[axis]}, rays, world_from_view));
    faces.push_back(FaceOf({Vector3d::Unit(axis), box.max()[axis]}, rays, world_from_view));
  }
  for (const HalfSpace& half_space : rays.half_spaces())
    faces.push_back(FaceOf(half_space, rays, world_from_view));
  return faces;
}

ViewPencils::ViewPencils(const VisualHull& hull, const ViewRays& rays)
    : hull_(hull), rays_(rays), faces_(FacesOf(hull.rig().workspace_mm, rays)) {
  for (const Face& face : faces_) {
    (face.kind == Face::Kind::kNotBefore  ? box_.not_before
     : face.kind == Face::Kind::kNotAfter ? box_.not_after
                                          : box_.beside)
        .push_back(face.bound.Narrow());
  }
  // If no ray meets the workspace, the cameras aren't needed.
  if (KeysInWorkspace(rays.BoundsOf(0, 0, rays.width_px(), rays.height_px())).is_empty()) return;
  const std::size_t cameras = hull.silhouettes().size();
  cameras_.resize(cameras);
  if (ExteriorIsObject(hull.rig())) visibility_outlines_.resize(cameras);
  tbb::parallel_for(std::size_t{0}, cameras, [&](std::size_t i) {
    const Silhouette& silhouette = *hull.silhouettes()[i];
    const double focal_px = silhouette.plane().focal_px();
    const core::CameraModel& camera = hull.rig().cameras[i];
    cameras_[i] = std::make_unique<const EpipolarEdges>(silhouette.labels(), focal_px, camera, rays);
    if (!visibility_outlines_.empty())
      visibility_outlines_[i] =
          std::make_unique<const EpipolarEdges>(silhouette.plane().outline(), focal_px, camera, rays);
  });
}

float ViewPencils::key_end() const {
  return rays_.projection() == Projection::kPerspective ? 0.0F : std::numeric_limits<float>::infinity();
}

std::int64_t ViewPencils::edges() const {
  std::int64_t edges = 0;
  if (cameras_.empty()) return edges;
  for (const auto& silhouette : hull_.silhouettes())
    edges += static_cast<std::int64_t>(silhouette->labels().contour().edges.size());
  return edges;
}

std::vector<PixelBox> ViewPencils::Squares() const {
  std::vector<PixelBox> squares;
  for (int y = 0; y < rays_.height_px(); y += kLargestSquarePx)
    for (int x = 0; x < rays_.width_px(); x += kLargestSquarePx) Divide(x, y, kLargestSquarePx, &squares);
  return squares;
}

void ViewPencils::Divide(int x, int y, int size, std::vector<PixelBox>* squares) const {
  const int right = std::min(x + size, rays_.width_px()), bottom = std::min(y + size, rays_.height_px());
  const Eigen::AlignedBox2d box = rays_.BoundsOf(x, y, right, bottom);
  if (box.isEmpty() || MissesHull(box)) return;
  if (size == kSquarePx) return squares->push_back({x, y, right, bottom});
  const int half = size / 2;
  for (const int part_y : {y, y + half})
    for (const int part_x : {x, x + half})
      if (part_x < right && part_y < bottom) Divide(part_x, part_y, half, squares);
}

EpipolarEdges::KeyRange ViewPencils::KeysInWorkspace(const Eigen::AlignedBox2d& box) const {
  EpipolarEdges::KeyRange keys;
  keys.most = key_end();
  for (const Face& face : faces_) {
    if (face.kind == Face::Kind::kBeside && HighestOf(face.bound, box) < 0.0) return EpipolarEdges::kNoKeys;
    if (face.kind == Face::Kind::kNotBefore) keys.least = std::max(keys.least, LowestOf(face.bound, box));
    if (face.kind == Face::Kind::kNotAfter) keys.most = std::min(keys.most, HighestOf(face.bound, box));
  }
  // Faces are rounded to float32 where rays are cast.
  if (std::isfinite(keys.least)) keys.least -= kFaceRounding * std::abs(keys.least);
  if (std::isfinite(keys.most)) keys.most += kFaceRounding * std::abs(keys.most);
  return keys;
}

// True if no ray of the box is in the workspace and in all cameras' objects at one place.
bool ViewPencils::MissesHull(const Eigen::AlignedBox2d& box) const {
  EpipolarEdges::KeyRange keys = KeysInWorkspace(box);
  for (const auto& pencil : cameras_) {
    if (keys.is_empty()) return true;
    const EpipolarEdges::KeyRange object = pencil->ObjectKeys(box);
    keys = {std::max(keys.least, object.least), std::min(keys.most, object.most)};
  }
  return keys.is_empty();
}

HullSurface SurfaceOf(const VisualHull& hull, std::int32_t caster, std::uint32_t edge) {
  if (caster == TileHits::kNoCamera) return HullSurface::Workspace();
  const auto number = static_cast<std::size_t>(caster);
  const std::size_t cameras = hull.silhouettes().size();
  if (number < cameras) return {number, edge};
  const Contour& contour = hull.silhouettes()[number - cameras]->labels().contour();
  return {number - cameras, edge + static_cast<std::uint32_t>(contour.edges.size())};
}

}  // namespace elbowroom::recon
