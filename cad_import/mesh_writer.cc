#include "cad_import/mesh_writer.h"

#include <assimp/cexport.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <exception>
#include <memory>
#include <optional>

#include "cad_import/file_format.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;

// How assimp calls what we write, and the length of one of the file's units.
struct Target {
  const char* exporter_id;
  double mm_per_unit;
};
Target TargetOf(const std::filesystem::path& path) {
  const std::optional<FileFormat> format = FindFormat(path);
  if (format == FileFormat::kPly) return {"plyb", 1.0};
  if (format == FileFormat::kStl) return {"stlb", 1.0};
  if (format == FileFormat::kGlb) return {"glb2", 1000.0};
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

std::unique_ptr<aiScene> SceneOf(const core::TriangleMesh& mesh, double mm_per_unit,
                                 const std::string& name) {
  auto scene = std::make_unique<aiScene>();
  scene->mMaterials = new aiMaterial* [1] { new aiMaterial };
  scene->mNumMaterials = 1;
  scene->mMeshes = new aiMesh* [1] { ToAssimp(mesh, mm_per_unit).release() };
  scene->mNumMeshes = 1;
  scene->mRootNode = new aiNode(name);
  scene->mRootNode->mMeshes = new unsigned[1]{0};
  scene->mRootNode->mNumMeshes = 1;
  return scene;
}

}  // namespace

std::string EncodeMesh(const core::TriangleMesh& mesh, const std::filesystem::path& path) {
  const std::string where = path.string();
  core::ValidateMesh(mesh, where);
  const Target target = TargetOf(path);
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = nullptr;
  try {
    blob = exporter.ExportToBlob(SceneOf(mesh, target.mm_per_unit, path.stem().string()).get(),
                                 target.exporter_id);
  } catch (const std::exception& exception) {
    throw Error(ErrorKind::kFile, fmt::format("{}: can't be written ({})", where, exception.what()));
  }
  if (blob == nullptr) {
    throw Error(ErrorKind::kFile, fmt::format("{}: can't be written ({})", where, exporter.GetErrorString()));
  }
  return {static_cast<const char*>(blob->data), blob->size};
}

}  // namespace elbowroom::cad_import
