// Cameras with every lens model and parts of every awkward kind, for the tests of the overlay.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "core/rig.h"
#include "core/triangle_mesh.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::control {

// The rig presets, and one rig whose cameras have a plumb_bob, a rational and two fisheye lenses.
struct NamedRig {
  std::string name;
  core::Rig rig;
};
[[nodiscard]] std::vector<NamedRig> RigsOfEveryLens();

// Closed meshes in the solids' own frames, oriented outwards. A ball and a tube have `segments` round them.
[[nodiscard]] core::TriangleMesh BoxMesh(const Eigen::Vector3d& size_mm);
[[nodiscard]] core::TriangleMesh BallMesh(double radius_mm, int segments);
[[nodiscard]] core::TriangleMesh TubeMesh(const recon::Tube& tube, int segments);

// A part and the solid that it is, in one place.
struct SolidPart {
  std::string name;
  recon::Solid solid;
  core::SharedMesh mesh;
};
// Flat, curved, hollow, huge, tiny, about the origin's table, and one from behind the camera past it. The
// same meshes at each call.
[[nodiscard]] std::vector<SolidPart> PartsOfEveryKind(const core::CameraModel& camera);

// The curves on the solid that an eye sees as its edges: box edges, rims, and where the line of sight grazes
// the surface, as points at most `apart_mm` apart. In world.
struct SolidEdge {
  std::vector<Eigen::Vector3d> points_in_world;
};
[[nodiscard]] std::vector<SolidEdge> EdgesOf(const recon::Solid& solid, const Eigen::Vector3d& eye_in_world,
                                             double apart_mm);

}  // namespace elbowroom::control
