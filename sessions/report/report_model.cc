#include "sessions/report/report_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "sessions/report/markup.h"
#include "sessions/report/page_json.h"

namespace elbowroom::sessions {
namespace {

using Json = nlohmann::json;
using Steps = std::array<std::uint16_t, 3>;

constexpr int kFinestSteps = 65535;
// Triangles fall together where a step is about as long as their sides.
constexpr int kFinestThatJoins = 1023;
constexpr int kCoarsest = 15;

struct PackedMesh {
  std::vector<Steps> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// Corners on the same step are one; triangles of which two corners are one are left out.
PackedMesh RoundedTo(const core::TriangleMesh& mesh, const Eigen::AlignedBox3d& box, int steps) {
  PackedMesh packed;
  std::unordered_map<std::uint64_t, std::uint32_t> place;
  place.reserve(mesh.vertices_mm.size());
  std::vector<std::uint32_t> vertex_at;
  for (const Eigen::Vector3d& x : mesh.vertices_mm) {
    Steps at = {};
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double size_mm = box.sizes()[i];
      const double share = size_mm > 0.0 ? (x[i] - box.min()[i]) / size_mm : 0.0;
      at[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(std::lround(share * steps));
    }
    const auto [it, is_new] =
        place.try_emplace(std::uint64_t{at[0]} << 32U | std::uint64_t{at[1]} << 16U | at[2],
                          static_cast<std::uint32_t>(packed.vertices.size()));
    if (is_new) packed.vertices.push_back(at);
    vertex_at.push_back(it->second);
  }
  for (const auto& corners : mesh.triangles) {
    std::array<std::uint32_t, 3> t = {};
    for (std::size_t i = 0; i < 3; ++i) t[i] = vertex_at[static_cast<std::size_t>(corners[i])];
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) packed.triangles.push_back(t);
  }
  return packed;
}

template <typename Number>
void AppendBytes(Number number, std::vector<unsigned char>* bytes) {
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    bytes->push_back(static_cast<unsigned char>(static_cast<std::uint64_t>(number) >> (8 * i) & 0xFFU));
}

Json Vector(const Eigen::Vector3d& x) { return {x.x(), x.y(), x.z()}; }

Json PackedMeshOf(const core::TriangleMesh& mesh, std::size_t most_triangles) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : mesh.vertices_mm) box.extend(x);
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
  int steps = kFinestSteps;
  PackedMesh packed = RoundedTo(mesh, box, steps);
  for (int coarser = kFinestThatJoins; packed.triangles.size() > most_triangles && coarser >= kCoarsest;
       coarser /= 2) {
    steps = coarser;
    packed = RoundedTo(mesh, box, steps);
  }
  std::vector<unsigned char> vertices, triangles;
  for (const Steps& at : packed.vertices)
    for (const std::uint16_t step : at) AppendBytes(step, &vertices);
  const bool is_wide = packed.vertices.size() > std::numeric_limits<std::uint16_t>::max();
  for (const auto& corners : packed.triangles) {
    for (const std::uint32_t corner : corners)
      is_wide ? AppendBytes(corner, &triangles) : AppendBytes(static_cast<std::uint16_t>(corner), &triangles);
  }
  return {{"low", Vector(box.min())},
          {"step", Vector(box.sizes() / steps)},
          {"vertices", Base64(vertices)},
          {"triangles", Base64(triangles)},
          {"wide", is_wide}};
}

Json MomentJson(const ReportModel::Moment& moment, std::size_t hull) {
  Json poses = Json::array(), points = Json::array();
  for (const core::RigidTransform& pose : moment.world_from_parts) {
    Json numbers = Json::array();
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = 0; column < 3; ++column) numbers.push_back(pose.rotation(row, column));
      numbers.push_back(pose.translation_mm[row]);
    }
    poses.push_back(std::move(numbers));
  }
  for (const Eigen::Vector3d& x : moment.contacts_in_world_mm) points.push_back(Vector(x));
  return {{"frame", moment.frame}, {"poses", poses}, {"points", points}, {"hull", hull}};
}

}  // namespace

std::string PackedMeshJson(const core::TriangleMesh& mesh, std::size_t most_triangles) {
  return PackedMeshOf(mesh, most_triangles).dump();
}

std::string ModelJson(const core::Layout& layout, const Eigen::AlignedBox3d& workspace_mm,
                      const ReportModel& model) {
  Json meshes = Json::array(), parts = Json::array(), volumes = Json::array(), moments = Json::array();
  std::map<const core::TriangleMesh*, std::size_t> place;  // parts may share one
  for (const core::Part& part : layout.parts) {
    const auto [it, is_new] = place.try_emplace(part.mesh.get(), meshes.size());
    if (is_new) meshes.push_back(PackedMeshOf(*part.mesh, kMostModelTriangles));
    parts.push_back({{"name", part.name}, {"mesh", it->second}});
  }
  for (const ReportModel::Moment& moment : model.moments) {
    moments.push_back(MomentJson(moment, meshes.size()));
    meshes.push_back(PackedMeshOf(moment.hull, kMostModelTriangles));
  }
  if (model.keep_out) {
    volumes.push_back({{"name", "keep-out volume"}, {"mesh", meshes.size()}});
    meshes.push_back(PackedMeshOf(*model.keep_out, kMostVolumeTriangles));
  }
  const Json json = {{"meshes", meshes},
                     {"parts", parts},
                     {"volumes", volumes},
                     {"moments", moments},
                     {"low", Vector(workspace_mm.min())},
                     {"high", Vector(workspace_mm.max())}};
  return WithoutTags(json.dump(-1, ' ', true, Json::error_handler_t::replace));
}

}  // namespace elbowroom::sessions
