#include "cad_import/formats/mesh_writer.h"

#include <assimp/cexport.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cad_import/formats/file_format.h"
#include "cad_import/formats/glb_container.h"
#include "cad_import/formats/gltf_document.h"
#include "cad_import/formats/srgb.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;

// assimp's name for the format that is written, and the length of one of the file's units.
struct Target {
  const char* exporter_id;
  double mm_per_unit;
  bool keeps_instances;
};
Target TargetOf(const std::filesystem::path& path) {
  const std::optional<FileFormat> format = FindFormat(path);
  if (format == FileFormat::kPly) return {"plyb", 1.0, false};
  if (format == FileFormat::kStl) return {"stlb", 1.0, false};
  if (format == FileFormat::kGlb) return {"glb2", 1000.0, true};
  throw Error(ErrorKind::kFormat,
              fmt::format("{}: meshes are written as .ply, .stl or .glb; choose one of these extensions",
                          path.string()));
}

// assimp's scene owns raw arrays and frees them.
std::unique_ptr<aiMesh> ToAssimp(const core::TriangleMesh& source, double mm_per_unit) {
  auto mesh = std::make_unique<aiMesh>();
  mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh->mNumVertices = static_cast<unsigned>(source.vertices_mm.size());
  mesh->mVertices = new aiVector3D[mesh->mNumVertices];
  std::transform(source.vertices_mm.begin(), source.vertices_mm.end(), mesh->mVertices,
                 [&](const Eigen::Vector3d& v) {
                   const Eigen::Vector3f scaled = (v / mm_per_unit).cast<float>();
                   return aiVector3D(scaled.x(), scaled.y(), scaled.z());
                 });
  mesh->mNumFaces = static_cast<unsigned>(source.triangles.size());
  mesh->mFaces = new aiFace[mesh->mNumFaces];
  for (unsigned i = 0; i < mesh->mNumFaces; ++i) {
    mesh->mFaces[i].mNumIndices = 3;
    mesh->mFaces[i].mIndices = new unsigned[3];
    std::copy(source.triangles[i].begin(), source.triangles[i].end(), mesh->mFaces[i].mIndices);
  }
  return mesh;
}

// One shape in one colour: glTF gives a mesh its material, not a node.
using Look = std::pair<std::size_t, std::optional<ColorRgb>>;

std::unique_ptr<aiMaterial> MaterialOf(const std::optional<ColorRgb>& color) {
  auto material = std::make_unique<aiMaterial>();
  if (!color) return material;
  const auto& [red, green, blue] = *color;
  const aiColor4D linear(LinearFromSrgb(red), LinearFromSrgb(green), LinearFromSrgb(blue), 1.0F);
  material->AddProperty(&linear, 1, AI_MATKEY_BASE_COLOR);
  return material;
}

template <typename T>
void HandOver(std::vector<std::unique_ptr<T>> from, T*** to, unsigned* count) {
  *count = static_cast<unsigned>(from.size());
  *to = new T*[from.size()];
  std::ranges::transform(from, *to, [](std::unique_ptr<T>& item) { return item.release(); });
}

aiMatrix4x4 ToAssimp(const core::RigidTransform& b_from_a, double mm_per_unit) {
  const Eigen::Matrix3f r = b_from_a.rotation.cast<float>();
  const Eigen::Vector3f t = (b_from_a.translation_mm / mm_per_unit).cast<float>();
  return {r(0, 0), r(0, 1), r(0, 2), t.x(), r(1, 0), r(1, 1), r(1, 2), t.y(),
          r(2, 0), r(2, 1), r(2, 2), t.z(), 0.0F,    0.0F,    0.0F,    1.0F};
}

// The node at a path of names. It is made if it isn't in `nodes`, which holds all that there are, and so are
// those above it.
aiNode* NodeAt(const std::string& path, std::map<std::string, aiNode*>& nodes) {
  if (const auto found = nodes.find(path); found != nodes.end()) return found->second;
  const std::size_t slash = path.rfind('/');
  aiNode* parent = NodeAt(slash == std::string::npos ? "" : path.substr(0, slash), nodes);
  auto* node = new aiNode(path.substr(slash == std::string::npos ? 0 : slash + 1));
  parent->addChildren(1, &node);
  return nodes[path] = node;
}

// The first name of all paths, if they have one in common and go on after it.
std::optional<std::string> CommonRoot(const CadModel& model) {
  const std::string& first = model.instances.front().path;
  const std::string root = first.substr(0, first.find('/'));
  const bool is_common = std::ranges::all_of(
      model.instances, [&](const CadInstance& instance) { return instance.path.starts_with(root + '/'); });
  return is_common ? std::optional(root) : std::nullopt;
}

std::unique_ptr<aiScene> SceneOf(const CadModel& model, double mm_per_unit, const std::string& name) {
  auto scene = std::make_unique<aiScene>();
  const std::optional<std::string> root = CommonRoot(model);
  scene->mRootNode = new aiNode(root.value_or(name));
  std::map<std::string, aiNode*> groups{{root.value_or(""), scene->mRootNode}};
  std::map<Look, unsigned> looks;
  std::vector<std::unique_ptr<aiMesh>> meshes;
  std::vector<std::unique_ptr<aiMaterial>> materials;
  for (const CadInstance& instance : model.instances) {
    const auto [look, is_new] = looks.try_emplace({instance.shape, instance.color}, looks.size());
    if (is_new) {
      const CadShape& shape = model.shapes[instance.shape];
      meshes.push_back(ToAssimp(*shape.mesh, mm_per_unit));
      meshes.back()->mName = shape.name;
      meshes.back()->mMaterialIndex = look->second;
      materials.push_back(MaterialOf(instance.color));
    }
    const std::size_t slash = instance.path.rfind('/');
    const bool is_top = slash == std::string::npos;
    auto* node = new aiNode(is_top ? instance.path : instance.path.substr(slash + 1));
    node->mTransformation = ToAssimp(instance.model_from_shape, mm_per_unit);
    node->mMeshes = new unsigned[1]{look->second};
    node->mNumMeshes = 1;
    NodeAt(is_top ? "" : instance.path.substr(0, slash), groups)->addChildren(1, &node);
  }
  HandOver(std::move(meshes), &scene->mMeshes, &scene->mNumMeshes);
  HandOver(std::move(materials), &scene->mMaterials, &scene->mNumMaterials);
  return scene;
}

}  // namespace

std::string EncodeModel(const CadModel& model, const std::filesystem::path& path) {
  const std::string where = path.string();
  const Target target = TargetOf(path);
  for (const CadShape& shape : model.shapes) core::ValidateMesh(*shape.mesh, where);
  if (model.instances.empty()) core::ValidateMesh({}, where);
  std::optional<CadModel> flat;
  if (!target.keeps_instances) flat = ModelOf(Flatten(model).mesh, path.stem().string());
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = nullptr;
  try {
    blob = exporter.ExportToBlob(
        SceneOf(flat ? *flat : model, target.mm_per_unit, path.stem().string()).get(), target.exporter_id);
  } catch (const std::exception& exception) {
    throw Error(ErrorKind::kFile, fmt::format("{}: can't be written ({})", where, exception.what()));
  }
  if (blob == nullptr) {
    throw Error(ErrorKind::kFile, fmt::format("{}: can't be written ({})", where, exporter.GetErrorString()));
  }
  std::string bytes(static_cast<const char*>(blob->data), blob->size);
  double deviation_mm = 0.0;
  for (const CadShape& shape : model.shapes) deviation_mm = std::max(deviation_mm, shape.mesh->deviation_mm);
  if (!target.keeps_instances || deviation_mm == 0.0) return bytes;
  const std::string document = WithDeviation(JsonOf(bytes), deviation_mm);
  return WithJson(std::move(bytes), document);
}

}  // namespace elbowroom::cad_import
