#include "cad_import/file_reader.h"

#include <optional>
#include <string>
#include <utility>

#include "cad_import/formats/file_format.h"
#include "cad_import/formats/format_modules.h"
#include "cad_import/normalisation/model_normalisation.h"

namespace elbowroom::cad_import {

namespace fs = std::filesystem;

void PrepareToRead(const fs::path& file) {
  const std::optional<FileFormat> format = FindFormat(file);
  if (!format) return;
  if (IsBoundaryRepresentation(*format)) {
    (void)LoadedBrepReader();
  } else {
    (void)LoadedMeshFormats();
  }
}

PackedModel ReadCadFile(const fs::path& file, const ImportOptions& options, const core::Progress& progress) {
  progress.Report(0, 0, "reading");
  auto [format, bytes] = ReadCheckedFile(file);
  RawScene scene;
  if (IsBoundaryRepresentation(format)) {
    scene = LoadedBrepReader()(file, format, options, progress);
  } else if (format == FileFormat::k3mf) {
    scene = LoadedMeshFormats().read_three_mf(file);
  } else {
    scene = LoadedMeshFormats().read_scene(file, format, std::move(bytes));
  }
  const fs::path folder = fs::weakly_canonical(file).parent_path();
  std::vector<ReferredFile> referred;
  for (const fs::path& other : scene.referred)
    referred.push_back({other.lexically_relative(folder).string(), HashOfFile(other)});
  return {NormaliseModel(std::move(scene), format, options, file, progress), std::move(referred)};
}

}  // namespace elbowroom::cad_import
