#include "cad_import/model/cad_model.h"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <set>
#include <utility>

#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

bool IsAtHome(const core::RigidTransform& b_from_a) {
  return b_from_a.rotation == Eigen::Matrix3d::Identity() &&
         b_from_a.translation_mm == Eigen::Vector3d::Zero();
}

// The last name of its path.
std::string NameOf(const CadInstance& instance) { return instance.path.substr(instance.path.rfind('/') + 1); }

bool HangsUnder(const CadInstance& instance, std::string_view node) {
  const std::string_view path = instance.path;
  return path.starts_with(node) && (path.size() == node.size() || path[node.size()] == '/');
}

// Numbers names that recur: the second "a" becomes "a 2", or "a 3" where some part is called "a 2" already.
void NumberTwins(std::vector<ImportedPart>& parts) {
  std::set<std::string> given;
  for (const ImportedPart& part : parts) given.insert(part.name);
  std::map<std::string, int> uses;
  for (ImportedPart& part : parts) {
    int& use = uses[part.name];
    if (++use == 1) continue;
    std::string numbered = fmt::format("{} {}", part.name, use);
    while (!given.insert(numbered).second) numbered = fmt::format("{} {}", part.name, ++use);
    part.name = numbered;
  }
}

}  // namespace

CadModel ModelOf(core::SharedMesh mesh, const std::string& name) {
  CadModel model;
  model.shapes.push_back({name, std::move(mesh), {}, {}});
  model.instances.push_back({name, 0, {}, std::nullopt});
  return model;
}

FlatModel Flatten(const CadModel& model, std::string_view node) {
  std::vector<const CadInstance*> taken;
  for (const CadInstance& instance : model.instances)
    if (node.empty() || HangsUnder(instance, node)) taken.push_back(&instance);
  core::Require(!taken.empty(), "a node that the model has");
  FlatModel flat;
  core::TriangleMesh all;
  for (const CadInstance* instance : taken) {
    const CadShape& shape = model.shapes[instance->shape];
    const auto first = static_cast<std::int64_t>(all.triangles.size());
    for (const ImportedPart& piece : shape.pieces) {
      const std::string& name = shape.pieces.size() == 1 ? NameOf(*instance) : piece.name;
      flat.parts.push_back({name, first + piece.first_triangle, piece.triangles});
    }
    const bool is_all = taken.size() == 1 && IsAtHome(instance->model_from_shape);
    if (is_all) {
      flat.mesh = shape.mesh;
    } else {
      core::Append(all, core::Transformed(*shape.mesh, instance->model_from_shape));
    }
  }
  if (flat.mesh == nullptr) flat.mesh = std::make_shared<const core::TriangleMesh>(std::move(all));
  NumberTwins(flat.parts);
  return flat;
}

std::vector<std::string> NodesOf(const CadModel& model) {
  std::set<std::string> nodes;
  for (const CadInstance& instance : model.instances) {
    for (std::size_t slash = instance.path.find('/'); slash != std::string::npos;
         slash = instance.path.find('/', slash + 1))
      nodes.insert(instance.path.substr(0, slash));
    nodes.insert(instance.path);
  }
  return {nodes.begin(), nodes.end()};
}

}  // namespace elbowroom::cad_import
