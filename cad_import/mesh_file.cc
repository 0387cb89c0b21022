#include "cad_import/mesh_file.h"

#include <memory>
#include <utility>

#include "cad_import/cad_file.h"
#include "cad_import/formats/format_modules.h"
#include "core/system/whole_file.h"

namespace elbowroom::cad_import {

ImportedMesh ImportMeshFile(const std::filesystem::path& file, const ImportOptions& options,
                            const core::Progress& progress, const std::stop_token& stop) {
  CadModel model = ImportCadFile(file, options, progress, stop);
  FlatModel flat = Flatten(model);
  return {std::move(flat.mesh), std::move(flat.parts), std::move(model.report)};
}

void WriteMeshFile(const core::TriangleMesh& mesh, const std::filesystem::path& path) {
  WriteModelFile(ModelOf(std::make_shared<const core::TriangleMesh>(mesh), path.stem().string()), path);
}

void WriteModelFile(const CadModel& model, const std::filesystem::path& path) {
  core::WriteWholeFile(path, LoadedMeshFormats().encode(model, path));
}

}  // namespace elbowroom::cad_import
