#include "tests/app/overlay/overlay_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <variant>

#include "recon/synthetic/rig_presets.h"

namespace elbowroom::control {
namespace {

using core::DistortionModel;
using Eigen::Vector3d;

constexpr double kTurn = 2.0 * std::numbers::pi;

core::CameraModel LensCamera(const std::string& name, int width_px, int height_px, double focal_px,
                             DistortionModel model, std::vector<double> coefficients,
                             const Vector3d& eye_in_world) {
  core::CameraCalibration c;
  c.name = name;
  c.image_width_px = width_px;
  c.image_height_px = height_px;
  c.camera_matrix << focal_px, 0.0, 0.5 * width_px, 0.0, 1.02 * focal_px, 0.5 * height_px, 0.0, 0.0, 1.0;
  c.distortion_model = model;
  c.distortion_coefficients = std::move(coefficients);
  c.cam_from_world = core::CamFromWorldLookingAt(eye_in_world, {60.0, 0.0, 160.0});
  return core::CameraModel(std::move(c));
}

core::Rig LensRig() {
  core::Rig rig;
  rig.name = "lenses";
  rig.workspace_mm = {Vector3d(-400.0, -400.0, 0.0), Vector3d(500.0, 400.0, 500.0)};
  rig.cameras = {LensCamera("barrel", 640, 360, 380.0, DistortionModel::kPlumbBob,
                            {-0.32, 0.12, 3e-4, 2e-4, -0.02}, {300.0, -700.0, 900.0}),
                 LensCamera("rational", 640, 360, 304.0, DistortionModel::kRationalPolynomial,
                            {0.52, -2.71, 6e-4, -3e-4, 1.55, 0.40, -2.53, 1.47}, {-600.0, 500.0, 700.0}),
                 LensCamera("action", 960, 540, 435.0, DistortionModel::kFisheye, {0.04, 0.015, -0.02, 0.005},
                            {500.0, 500.0, 400.0}),
                 LensCamera("fisheye", 450, 330, 200.0, DistortionModel::kFisheye,
                            {-0.02, 0.003, -0.002, 0.0002}, {-300.0, -300.0, 500.0})};
  return rig;
}

core::SharedMesh Shared(core::TriangleMesh mesh) {
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

Vector3d Round(double radius_mm, double angle_rad, double z_mm) {
  return {radius_mm * std::cos(angle_rad), radius_mm * std::sin(angle_rad), z_mm};
}

using Points = std::vector<Vector3d>;

Points Line(const Vector3d& a, const Vector3d& b, double apart_mm) {
  Points points;
  const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / apart_mm)));
  for (int i = 0; i <= pieces; ++i) points.emplace_back(a + (b - a) * i / pieces);
  return points;
}

// About `axis`, unit.
Points Circle(const Vector3d& center, const Vector3d& axis, double radius_mm, double apart_mm) {
  const Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  const int pieces = std::max(64, static_cast<int>(std::ceil(kTurn * radius_mm / apart_mm)));
  Points points;
  for (int i = 0; i <= pieces; ++i) {
    const double angle = kTurn * i / pieces;
    points.emplace_back(center + radius_mm * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return points;
}

std::vector<Points> EdgesInSolid(const recon::Box& box, const Vector3d& /*eye*/, double apart_mm) {
  std::vector<Points> edges;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double p : {-0.5, 0.5}) {
      for (const double q : {-0.5, 0.5}) {
        Vector3d low = -0.5 * box.size_mm, high = 0.5 * box.size_mm;
        const int other = (axis + 1) % 3, third = (axis + 2) % 3;
        low[other] = high[other] = p * box.size_mm[other];
        low[third] = high[third] = q * box.size_mm[third];
        edges.push_back(Line(low, high, apart_mm));
      }
    }
  }
  return edges;
}

// The points x of the sphere with x . (eye - x) = 0: a circle across the line to the eye.
std::vector<Points> EdgesInSolid(const recon::Sphere& sphere, const Vector3d& eye, double apart_mm) {
  const double r = sphere.radius_mm, far = eye.norm();
  return {Circle(eye * (r * r / (far * far)), eye / far, r * std::sqrt(1.0 - r * r / (far * far)), apart_mm)};
}

// Four rims, and on each wall the two lines whose tangent planes hold the eye: cos(angle) = r / distance.
std::vector<Points> EdgesInSolid(const recon::Tube& tube, const Vector3d& eye, double apart_mm) {
  std::vector<Points> edges;
  for (const double radius : {tube.outer_radius_mm, tube.inner_radius_mm}) {
    if (radius <= 0.0) continue;
    for (const double z : {0.0, tube.length_mm})
      edges.push_back(Circle({0.0, 0.0, z}, Vector3d::UnitZ(), radius, apart_mm));
    const double distance = eye.head<2>().norm(), towards = std::atan2(eye.y(), eye.x());
    if (distance <= radius) continue;
    for (const double side : {-1.0, 1.0}) {
      const double angle = towards + side * std::acos(radius / distance);
      edges.push_back(Line(Round(radius, angle, 0.0), Round(radius, angle, tube.length_mm), apart_mm));
    }
  }
  return edges;
}

std::vector<Points> EdgesInSolid(const recon::Capsule& /*capsule*/, const Vector3d& /*eye*/,
                                 double /*apart_mm*/) {
  return {};
}

}  // namespace

std::vector<NamedRig> RigsOfEveryLens() {
  return {{"paper", recon::PaperRig()},
          {"four_modern", recon::FourCameraRig()},
          {"eight_modern", recon::EightCameraRig()},
          {"lenses", LensRig()}};
}

core::TriangleMesh BoxMesh(const Vector3d& size_mm) {
  core::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices_mm.push_back(
        size_mm.cwiseProduct(Vector3d((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2 & 1) - 0.5)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

core::TriangleMesh BallMesh(double radius_mm, int segments) {
  core::TriangleMesh mesh;
  const int rings = segments / 2;
  for (int j = 1; j < rings; ++j) {
    const double polar = std::numbers::pi * j / rings;
    for (int i = 0; i < segments; ++i)
      mesh.vertices_mm.push_back(
          Round(radius_mm * std::sin(polar), kTurn * i / segments, radius_mm * std::cos(polar)));
  }
  const auto at = [&](int ring, int i) { return (ring - 1) * segments + i % segments; };
  const auto top = static_cast<std::int32_t>(mesh.vertices_mm.size());
  mesh.vertices_mm.emplace_back(0.0, 0.0, radius_mm);
  mesh.vertices_mm.emplace_back(0.0, 0.0, -radius_mm);
  for (int i = 0; i < segments; ++i) {
    mesh.triangles.push_back({top, at(1, i), at(1, i + 1)});
    for (int j = 1; j + 1 < rings; ++j) {
      mesh.triangles.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1)});
      mesh.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j, i + 1)});
    }
    mesh.triangles.push_back({top + 1, at(rings - 1, i + 1), at(rings - 1, i)});
  }
  return mesh;
}

core::TriangleMesh TubeMesh(const recon::Tube& tube, int segments) {
  core::TriangleMesh mesh;
  for (int i = 0; i < segments; ++i) {
    const double angle = kTurn * i / segments;
    mesh.vertices_mm.push_back(Round(tube.outer_radius_mm, angle, 0.0));
    mesh.vertices_mm.push_back(Round(tube.outer_radius_mm, angle, tube.length_mm));
    mesh.vertices_mm.push_back(Round(tube.inner_radius_mm, angle, tube.length_mm));
    mesh.vertices_mm.push_back(Round(tube.inner_radius_mm, angle, 0.0));
  }
  for (int i = 0; i < segments; ++i) {
    for (int ring = 0; ring < 4; ++ring) {
      const int a = 4 * i + ring, b = 4 * i + (ring + 1) % 4, c = 4 * ((i + 1) % segments) + ring,
                d = 4 * ((i + 1) % segments) + (ring + 1) % 4;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  }
  return mesh;
}

std::vector<SolidPart> PartsOfEveryKind(const core::CameraModel& camera) {
  const recon::Tube tube{70.0, 55.0, 180.0};
  // Fine enough that facets are a few micrometres off the round surface.
  static const core::SharedMesh kBall = Shared(BallMesh(90.0, 480)), kTube = Shared(TubeMesh(tube, 720));
  const auto part = [](std::string name, auto shape, core::SharedMesh mesh,
                       const core::RigidTransform& world_from_solid) {
    SolidPart made{std::move(name), {}, std::move(mesh)};
    made.solid.shape = shape;
    made.solid.world_from_solid = world_from_solid;
    return made;
  };
  const auto box = [&](std::string name, const Vector3d& size_mm, const core::RigidTransform& at) {
    return part(std::move(name), recon::Box{size_mm}, Shared(BoxMesh(size_mm)), at);
  };
  const auto at = [](const Vector3d& position_mm, const Vector3d& rotation_deg) {
    return core::FromPositionAndRollPitchYaw(position_mm, rotation_deg);
  };
  return {box("flat", {320.0, 240.0, 4.0}, at({40.0, -30.0, 120.0}, {10.0, -5.0, 30.0})),
          part("curved", recon::Sphere{90.0}, kBall, at({90.0, 60.0, 150.0}, {0.0, 20.0, 0.0})),
          part("hollow", tube, kTube, at({-40.0, 20.0, 60.0}, {25.0, 15.0, 0.0})),
          box("huge", {9000.0, 7000.0, 30.0}, at({0.0, 0.0, -400.0}, {3.0, -2.0, 10.0})),
          box("tiny", {2.0, 2.0, 2.0}, at({80.0, 10.0, 200.0}, {20.0, 30.0, 40.0})),
          box("behind", {50.0, 30.0, 1300.0},
              camera.cam_from_world().Inverse() * at({70.0, 45.0, 150.0}, {2.0, -3.0, 20.0}))};
}

std::vector<SolidEdge> EdgesOf(const recon::Solid& solid, const Vector3d& eye_in_world, double apart_mm) {
  const Vector3d eye = solid.world_from_solid.Inverse() * eye_in_world;
  std::vector<SolidEdge> edges;
  for (const Points& points :
       std::visit([&](const auto& shape) { return EdgesInSolid(shape, eye, apart_mm); }, solid.shape)) {
    SolidEdge edge;
    for (const Vector3d& x : points) edge.points_in_world.push_back(solid.world_from_solid * x);
    edges.push_back(std::move(edge));
  }
  return edges;
}

}  // namespace elbowroom::control
