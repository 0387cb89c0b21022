#include "cad_import/mesh_file.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cad_import/cad_file.h"
#include "cad_import/formats/file_format.h"
#include "cad_import/formats/format_modules.h"
#include "cad_import/formats/vertex_field_writer.h"
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

void WriteFieldFile(const core::TriangleMesh& mesh, const VertexField& field,
                    const std::filesystem::path& path) {
  const std::optional<FileFormat> format = FindFormat(path);
  if (format == FileFormat::kPly || format == FileFormat::kGlb)
    return core::WriteWholeFile(path, EncodeField(mesh, field, path));
  std::string bytes = LoadedMeshFormats().encode(
      ModelOf(std::make_shared<const core::TriangleMesh>(mesh), path.stem().string()), path);
  const std::string header = StlHeader(field);
  bytes.replace(0, header.size(), header);
  core::WriteWholeFile(path, bytes);
}

void WriteModelFile(const CadModel& model, const std::filesystem::path& path) {
  core::WriteWholeFile(path, LoadedMeshFormats().encode(model, path));
}

}  // namespace elbowroom::cad_import
