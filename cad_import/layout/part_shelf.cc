#include "cad_import/layout/part_shelf.h"

#include "cad_import/cad_file.h"

namespace elbowroom::cad_import {

PartShelf::Key PartShelf::KeyOf(const std::filesystem::path& path, const ImportOptions& options) {
  return {std::filesystem::absolute(path).lexically_normal(), options.unit,
          options.unit ? Unit() : options.unit_if_file_has_none};
}

const CadModel& PartShelf::Model(const std::filesystem::path& path, const ImportOptions& options,
                                 const core::Progress& progress, const std::stop_token& stop) {
  SharedModel& model = models_[KeyOf(path, options)];
  if (model == nullptr)
    model = std::make_shared<const CadModel>(ImportCadFile(path, options, progress, stop));
  return *model;
}

const core::SharedMesh& PartShelf::Mesh(const std::filesystem::path& path, const ImportOptions& options,
                                        const std::string& node, const core::Progress& progress,
                                        const std::stop_token& stop) {
  core::SharedMesh& mesh = meshes_[{KeyOf(path, options), node}];
  if (mesh == nullptr) mesh = Flatten(Model(path, options, progress, stop), node).mesh;
  return mesh;
}

void PartShelf::Put(const std::filesystem::path& path, const ImportOptions& options, SharedModel model) {
  SharedModel& kept = models_[KeyOf(path, options)];
  if (kept == nullptr) kept = std::move(model);  // what has it already keeps its meshes
}

}  // namespace elbowroom::cad_import
