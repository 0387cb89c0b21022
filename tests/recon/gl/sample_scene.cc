#include "tests/recon/gl/sample_scene.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "recon/appearance/orbit_camera.h"

namespace elbowroom::recon::gl {
namespace {

constexpr int kLampLayerPx = 512;

struct Ray {
  Eigen::Vector3d origin_in_world;
  Eigen::Vector3d direction_in_world;  // z = 1 in camera axes, so that its parameter is the depth
};

Ray RayThrough(const SceneView& view, const Eigen::Vector2d& pixel) {
  return {view.EyeInWorld(), view.cam_from_world.rotation.transpose() * view.RayInCam(pixel)};
}

// Smallest positive root of the sphere's equation.
std::optional<double> SphereDepth(const Ray& ray, const Eigen::Vector3d& center, double radius_mm) {
  const Eigen::Vector3d to_eye = ray.origin_in_world - center;
  const double a = ray.direction_in_world.squaredNorm();
  const double b = ray.direction_in_world.dot(to_eye);
  const double c = to_eye.squaredNorm() - radius_mm * radius_mm;
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return std::nullopt;
  const double depth_mm = (-b - std::sqrt(discriminant)) / a;
  return depth_mm > 0.0 ? std::optional(depth_mm) : std::nullopt;
}

// Of the round side, between the end spheres' centres.
std::optional<double> SideDepth(const Ray& ray, const Capsule& capsule) {
  const Eigen::Vector3d axis = (capsule.b_in_world - capsule.a_in_world).normalized();
  const Eigen::Vector3d to_eye = ray.origin_in_world - capsule.a_in_world;
  const Eigen::Vector3d across = ray.direction_in_world - ray.direction_in_world.dot(axis) * axis;
  const Eigen::Vector3d offset = to_eye - to_eye.dot(axis) * axis;
  const double a = across.squaredNorm();
  const double b = across.dot(offset);
  const double discriminant = b * b - a * (offset.squaredNorm() - capsule.radius_mm * capsule.radius_mm);
  if (a < 1e-12 || discriminant < 0.0) return std::nullopt;
  const double depth_mm = (-b - std::sqrt(discriminant)) / a;
  const double along_mm = (to_eye + depth_mm * ray.direction_in_world).dot(axis);
  const bool on_side = along_mm >= 0.0 && along_mm <= (capsule.b_in_world - capsule.a_in_world).norm();
  return depth_mm > 0.0 && on_side ? std::optional(depth_mm) : std::nullopt;
}

std::optional<RayHit> CapsuleHit(const Ray& ray, const Capsule& capsule) {
  double depth_mm = std::numeric_limits<double>::infinity();
  for (const auto& candidate :
       {SideDepth(ray, capsule), SphereDepth(ray, capsule.a_in_world, capsule.radius_mm),
        SphereDepth(ray, capsule.b_in_world, capsule.radius_mm)}) {
    if (candidate) depth_mm = std::min(depth_mm, *candidate);
  }
  if (!std::isfinite(depth_mm)) return std::nullopt;
  const Eigen::Vector3d hit = ray.origin_in_world + depth_mm * ray.direction_in_world;
  const Eigen::Vector3d along = capsule.b_in_world - capsule.a_in_world;
  const double share = std::clamp((hit - capsule.a_in_world).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return RayHit{depth_mm, (hit - capsule.a_in_world - share * along).normalized()};
}

void AppendQuad(core::TriangleMesh& mesh, const std::array<Eigen::Vector3d, 4>& corners) {
  const auto first = static_cast<std::int32_t>(mesh.vertices_mm.size());
  mesh.vertices_mm.insert(mesh.vertices_mm.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

}  // namespace

core::SharedMesh BoxMesh(const Eigen::Vector3d& low_mm, const Eigen::Vector3d& high_mm) {
  core::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices_mm.emplace_back((i & 1) != 0 ? high_mm.x() : low_mm.x(),
                                  (i & 2) != 0 ? high_mm.y() : low_mm.y(),
                                  (i & 4) != 0 ? high_mm.z() : low_mm.z());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

core::SharedMesh TubeMesh(double outer_radius_mm, double inner_radius_mm, double height_mm, int sides) {
  core::TriangleMesh mesh;
  const auto at = [&](int side, double radius_mm, double z_mm) {
    const double angle_rad = 2.0 * std::numbers::pi * (side % sides) / sides;
    return Eigen::Vector3d(radius_mm * std::cos(angle_rad), radius_mm * std::sin(angle_rad), z_mm);
  };
  for (int i = 0; i < sides; ++i) {
    const double out = outer_radius_mm, in = inner_radius_mm, top = height_mm;
    AppendQuad(mesh, {at(i, out, 0), at(i + 1, out, 0), at(i + 1, out, top), at(i, out, top)});
    AppendQuad(mesh, {at(i + 1, in, 0), at(i, in, 0), at(i, in, top), at(i + 1, in, top)});
    AppendQuad(mesh, {at(i, out, top), at(i + 1, out, top), at(i + 1, in, top), at(i, in, top)});
    AppendQuad(mesh, {at(i + 1, out, 0), at(i, out, 0), at(i, in, 0), at(i + 1, in, 0)});
  }
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

std::optional<RayHit> CastRay(const SceneView& view, const Eigen::Vector2d& pixel,
                              const std::vector<Capsule>& capsules) {
  const Ray ray = RayThrough(view, pixel);
  std::optional<RayHit> first;
  for (const Capsule& capsule : capsules) {
    const std::optional<RayHit> hit = CapsuleHit(ray, capsule);
    if (hit && (!first || hit->depth_mm < first->depth_mm)) first = hit;
  }
  return first;
}

std::optional<double> BoxDepth(const SceneView& view, const Eigen::Vector2d& pixel,
                               const Eigen::AlignedBox3d& box_in_world) {
  const Ray ray = RayThrough(view, pixel);
  const Eigen::Array3d to_low =
      (box_in_world.min() - ray.origin_in_world).array() / ray.direction_in_world.array();
  const Eigen::Array3d to_high =
      (box_in_world.max() - ray.origin_in_world).array() / ray.direction_in_world.array();
  const double enter_mm = to_low.min(to_high).maxCoeff();
  const double leave_mm = to_low.max(to_high).minCoeff();
  return enter_mm > 0.0 && enter_mm < leave_mm ? std::optional(enter_mm) : std::nullopt;
}

std::shared_ptr<const HullView> CastLayer(const SceneView& view, int width_px, int height_px,
                                          const std::vector<Capsule>& capsules) {
  HullView layer;
  layer.width_px = width_px, layer.height_px = height_px;
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const Eigen::Vector2d pixel((x + 0.5) * view.width_px / width_px - 0.5,
                                  (y + 0.5) * view.height_px / height_px - 0.5);
      const std::optional<RayHit> hit = CastRay(view, pixel, capsules);
      layer.depth_mm.push_back(hit ? static_cast<float>(hit->depth_mm) : 0.0F);
      layer.normal_in_world.push_back(hit ? Eigen::Vector3f(hit->normal_in_world.cast<float>())
                                          : Eigen::Vector3f::Zero());
    }
  }
  return std::make_shared<const HullView>(std::move(layer));
}

std::vector<Capsule> Hand(const Eigen::Vector3d& palm_in_world) {
  const auto at = [&](double x, double y, double z) {
    return Eigen::Vector3d(palm_in_world + Eigen::Vector3d(x, y, z));
  };
  std::vector<Capsule> capsules{{at(70, 0, 5), at(330, 30, 60), 36}};  // forearm
  for (const double y : {-27.0, -9.0, 9.0, 27.0}) {
    capsules.push_back({at(60, 0.5 * y, 0), at(-10, y, 4), 15});      // palm
    capsules.push_back({at(-10, y, 4), at(-52, 1.15 * y, 12), 9.5});  // near finger bones
    capsules.push_back({at(-52, 1.15 * y, 12), at(-82, 1.1 * y, -6), 8.5});
  }
  capsules.push_back({at(45, -32, -4), at(0, -62, -10), 12});  // thumb
  capsules.push_back({at(0, -62, -10), at(-36, -60, -14), 10});
  return capsules;
}

Scene TrialScene(int width_px, int height_px) {
  Scene scene;
  OrbitCamera camera;
  camera.target_in_world = {20, 0, 150};
  camera.distance_mm = 1150.0;
  camera.azimuth_rad = -0.95;
  camera.elevation_rad = 0.36;
  scene.view = ViewFrom(camera, width_px, height_px);
  ScenePart box{BoxMesh({-150, -130, 0}, {150, 130, 110}), {}};
  ScenePart receptacle{
      TubeMesh(28, 20, 22, 48), {Eigen::Matrix3d::Identity(), {-40, 0, 110}}, {0.78F, 0.70F, 0.45F}};
  ScenePart pipe{
      TubeMesh(16, 12, 140, 40), {Eigen::Matrix3d::Identity(), {-40, 0, 125}}, {0.72F, 0.74F, 0.76F}};
  ScenePart payload{BoxMesh({-170, -140, 290}, {170, 140, 380}), {}, {0.40F, 0.55F, 0.75F}};
  ScenePart fin{BoxMesh({30, -140, 225}, {45, 40, 290}), {}, {0.40F, 0.55F, 0.75F}};
  fin.in_contact = true;
  scene.parts = {box, receptacle, pipe, payload, fin};
  const std::vector<Capsule> hand = Hand({55, 0, 225});
  scene.hull = CastLayer(scene.view, width_px, height_px, hand);
  scene.lamp = LampOver({Eigen::Vector3d(-300, -300, 0), Eigen::Vector3d(400, 300, 500)});
  scene.hull_from_lamp = CastLayer(scene.lamp.ShadowView(kLampLayerPx), kLampLayerPx, kLampLayerPx, hand);
  for (const double y : {-31.0, -26.0, -13.0, 2.0}) scene.contact_points_in_world.emplace_back(45, y, 233);
  scene.table_in_world = Eigen::AlignedBox2d(Eigen::Vector2d(-400, -350), Eigen::Vector2d(450, 350));
  scene.workspace_in_world =
      Eigen::AlignedBox3d(Eigen::Vector3d(-300, -300, 0), Eigen::Vector3d(400, 300, 500));
  for (const Eigen::Vector3d& eye : {Eigen::Vector3d(-350, 250, 430), Eigen::Vector3d(300, 280, 460)}) {
    CameraFrustum frustum{eye, {}};
    const core::RigidTransform world_from_cam = core::CamFromWorldLookingAt(eye, {0, 0, 150}).Inverse();
    for (std::size_t i = 0; i < 4; ++i) {
      frustum.corners_in_world[i] =
          world_from_cam * Eigen::Vector3d(i == 0 || i == 3 ? -40.0 : 40.0, i < 2 ? -30.0 : 30.0, 80.0);
    }
    scene.cameras.push_back(frustum);
  }
  return scene;
}

}  // namespace elbowroom::recon::gl
