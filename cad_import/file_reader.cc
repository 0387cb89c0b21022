#include "cad_import/file_reader.h"

#include <string>
#include <utility>

#include "cad_import/brep_reader.h"
#include "cad_import/file_format.h"
#include "cad_import/scene_reader.h"
#include "cad_import/settling.h"
#include "cad_import/three_mf_reader.h"

namespace elbowroom::cad_import {

namespace fs = std::filesystem;

PackedModel ReadCadFile(const fs::path& file, const ImportOptions& options, const core::Progress& progress) {
  progress.Report(0, 0, "reading");
  auto [format, bytes] = ReadCheckedFile(file);
  RawScene scene;
  if (IsBoundaryRepresentation(format)) {
    scene = ReadBrep(file, format, options, progress);
  } else if (format == FileFormat::k3mf) {
    scene = ReadThreeMf(file);
  } else {
    scene = ReadScene(file, format, std::move(bytes));
  }
  const fs::path folder = fs::weakly_canonical(file).parent_path();
  std::vector<ReferredFile> referred;
  for (const fs::path& other : scene.referred)
    referred.push_back({other.lexically_relative(folder).string(), HashOfFile(other)});
  return {Settle(std::move(scene), format, options, file, progress), std::move(referred)};
}

}  // namespace elbowroom::cad_import
