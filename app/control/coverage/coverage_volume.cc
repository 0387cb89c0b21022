#include "app/control/coverage/coverage_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/control/coverage/coverage_text.h"
#include "sessions/report/chart.h"

namespace elbowroom::control {
namespace {

using cad_import::CadModel;
using cad_import::ColorRgb;
using Eigen::Vector3d;

constexpr int kColours = 12;
constexpr ColorRgb kWorkspaceColour = {0.35F, 0.4F, 0.45F};
constexpr ColorRgb kCameraColour = {0.11F, 0.36F, 0.6F};
constexpr ColorRgb kNextColour = {0.18F, 0.6F, 0.3F};
constexpr ColorRgb kPartColour = {0.7F, 0.72F, 0.75F};

ColorRgb RgbOf(const std::string& hex) {
  const auto level = [&](std::size_t at) {
    return static_cast<float>(std::stoi(hex.substr(at, 2), nullptr, 16)) / 255.0F;
  };
  return {level(1), level(3), level(5)};
}

void AddShape(core::TriangleMesh mesh, const std::string& path, const ColorRgb& colour, CadModel* model) {
  if (mesh.triangles.empty()) return;
  cad_import::CadShape& shape = model->shapes.emplace_back();
  shape.name = path.substr(path.rfind('/') + 1);
  shape.mesh = std::make_shared<const core::TriangleMesh>(std::move(mesh));
  model->instances.push_back({path, model->shapes.size() - 1, {}, colour});
}

// Eight corners by the bits of their number, two triangles a face.
void AppendBox(const Vector3d& center_mm, const Vector3d& half_mm, core::TriangleMesh* mesh) {
  constexpr std::array<std::array<std::int32_t, 3>, 12> kFaces = {{{0, 2, 1},
                                                                   {1, 2, 3},
                                                                   {4, 5, 6},
                                                                   {5, 7, 6},
                                                                   {0, 1, 4},
                                                                   {1, 5, 4},
                                                                   {2, 6, 3},
                                                                   {3, 6, 7},
                                                                   {0, 4, 2},
                                                                   {2, 4, 6},
                                                                   {1, 3, 5},
                                                                   {3, 7, 5}}};
  const auto first = static_cast<std::int32_t>(mesh->vertices_mm.size());
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d sign(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0);
    mesh->vertices_mm.push_back(center_mm + sign.cwiseProduct(half_mm));
  }
  for (const auto& face : kFaces)
    mesh->triangles.push_back({first + face[0], first + face[1], first + face[2]});
}

// From the 5th to the 95th percentile, as in the pictures.
struct ColourRange {
  double low_mm = 0.0;
  double high_mm = 1.0;
};
ColourRange RangeOf(const CoverageOutcome& outcome) {
  std::vector<double> sigmas_mm;
  for (const recon::CoverageNode& node : outcome.nodes)
    if (node.has_sigma) sigmas_mm.push_back(node.sigma_mm);
  std::ranges::sort(sigmas_mm);
  const double low_mm = core::PercentileOf(sigmas_mm, 0.05);
  return {low_mm, std::max(core::PercentileOf(sigmas_mm, 0.95), low_mm * 1.001 + 1e-9)};
}

void AddUncertainty(const CoverageOutcome& outcome, CadModel* model) {
  if (!outcome.figures.uncertainty_mm) return;
  constexpr double kMostCubes = 12000.0, kHalfShare = 0.16;
  const recon::CoverageGrid& grid = outcome.grid;
  const int step = static_cast<int>(std::ceil(std::cbrt(static_cast<double>(grid.size()) / kMostCubes)));
  const ColourRange range = RangeOf(outcome);
  const double step_mm = (range.high_mm - range.low_mm) / kColours;
  std::array<core::TriangleMesh, kColours> meshes;
  for (int z = 0; z < grid.counts.z(); z += step) {
    for (int y = 0; y < grid.counts.y(); y += step) {
      for (int x = 0; x < grid.counts.x(); x += step) {
        const std::size_t node = grid.NodeAt(x, y, z);
        if (!outcome.nodes[node].has_sigma) continue;
        const double place =
            std::clamp((outcome.nodes[node].sigma_mm - range.low_mm) / step_mm, 0.0, kColours - 1.0);
        const auto colour = static_cast<std::size_t>(place);
        AppendBox(grid.PointAt(node), Vector3d::Constant(kHalfShare * grid.edge_mm * step), &meshes[colour]);
      }
    }
  }
  for (int i = 0; i < kColours; ++i) {
    const std::string from = MmText(range.low_mm + i * step_mm),
                      to = MmText(range.low_mm + (i + 1) * step_mm);
    const std::string name = i == 0             ? fmt::format("up to {} mm", to)
                             : i + 1 < kColours ? fmt::format("{} to {} mm", from, to)
                                                : fmt::format("{} mm and more", from);
    AddShape(std::move(meshes[static_cast<std::size_t>(i)]), fmt::format("coverage/uncertainty/{}", name),
             RgbOf(sessions::DepthColour(static_cast<double>(i) / (kColours - 1))), model);
  }
}

void AddWorkspace(const Eigen::AlignedBox3d& box, CadModel* model) {
  core::TriangleMesh edges;
  const double half_mm = 0.001 * box.diagonal().norm();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      const Eigen::Index second = (axis + 1) % 3, third = (axis + 2) % 3;
      Vector3d center = box.center();
      center[second] = corner & 1 ? box.max()[second] : box.min()[second];
      center[third] = corner & 2 ? box.max()[third] : box.min()[third];
      Vector3d half = Vector3d::Constant(half_mm);
      half[axis] = std::max(0.5 * box.sizes()[axis] - 2.0 * half_mm, half_mm);  // short of the corners
      AppendBox(center, half, &edges);
    }
  }
  AddShape(std::move(edges), "coverage/workspace", kWorkspaceColour, model);
}

// Its tip is the camera's centre, its base a small picture before it.
void AddCamera(const core::CameraModel& camera, double length_mm, const std::string& path,
               const ColorRgb& colour, CadModel* model) {
  const core::RigidTransform world_from_cam = camera.cam_from_world().Inverse();
  const Eigen::Matrix3d& k = camera.calibration().camera_matrix;
  core::TriangleMesh mesh;
  mesh.vertices_mm.push_back(world_from_cam * Vector3d::Zero());
  for (const auto& [x, y] :
       {std::pair(0.0, 0.0), std::pair(1.0, 0.0), std::pair(1.0, 1.0), std::pair(0.0, 1.0)}) {
    const Vector3d pixel(x * camera.width_px() - 0.5, y * camera.height_px() - 0.5, 1.0);
    mesh.vertices_mm.push_back(world_from_cam * (length_mm * (k.inverse() * pixel)));
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {1, 3, 2}, {1, 4, 3}};
  if (core::VolumeMm3(mesh) < 0.0)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  AddShape(std::move(mesh), path, colour, model);
}

}  // namespace

CadModel CoverageVolume(const CoverageOutcome& outcome) {
  CadModel model;
  const core::Rig& rig = outcome.rig.rig;
  AddUncertainty(outcome, &model);
  AddWorkspace(rig.workspace_mm, &model);
  const double length_mm = 0.06 * rig.workspace_mm.diagonal().norm();
  for (const core::CameraModel& camera : rig.cameras)
    AddCamera(camera, length_mm, fmt::format("coverage/cameras/{}", camera.name()), kCameraColour, &model);
  if (outcome.next && !outcome.next->best.empty()) {
    core::CameraCalibration next = rig.cameras[outcome.next->lens_of].calibration();
    next.cam_from_world = outcome.next->best.front().cam_from_world;
    AddCamera(core::CameraModel(next), length_mm, "coverage/next camera", kNextColour, &model);
  }
  for (std::size_t i = 0; i < outcome.layout.parts.size(); ++i) {
    const core::Part& part = outcome.layout.parts[i];
    model.shapes.push_back({part.name, part.mesh, {}, {}});
    model.instances.push_back({fmt::format("coverage/parts/{}", part.name), model.shapes.size() - 1,
                               outcome.world_from_parts[i], kPartColour});
  }
  return model;
}

}  // namespace elbowroom::control
