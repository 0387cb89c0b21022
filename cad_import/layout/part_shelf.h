// The CAD files that layouts name, each read once.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <tuple>
#include <utility>

#include "cad_import/model/cad_model.h"
#include "cad_import/model/import_options.h"
#include "core/progress.h"
#include "core/triangle_mesh.h"

namespace elbowroom::cad_import {

// Reads each file once for each unit that it is asked for in, and makes each mesh once: whoever edits a
// layout keeps a shelf, so that a part that only moves isn't read again, and its mesh stays the same object.
// A file that changes on the disk stays what it was here. Thread: one at a time.
class PartShelf {
 public:
  using SharedModel = std::shared_ptr<const CadModel>;

  // Throws: as ImportCadFile, if the file isn't on the shelf.
  const CadModel& Model(const std::filesystem::path& path, const ImportOptions& options,
                        const core::Progress& progress = {}, const std::stop_token& stop = {});
  // Of that node, or of the whole file where it is empty. Throws: likewise; PreconditionError for a node that
  // the file doesn't have.
  const core::SharedMesh& Mesh(const std::filesystem::path& path, const ImportOptions& options,
                               const std::string& node, const core::Progress& progress = {},
                               const std::stop_token& stop = {});
  // What the caller has read of the file with these options.
  void Put(const std::filesystem::path& path, const ImportOptions& options, SharedModel model);

 private:
  using Unit = std::optional<core::LengthUnit>;
  using Key = std::tuple<std::filesystem::path, Unit, Unit>;  // the unit asked for; else the second choice

  static Key KeyOf(const std::filesystem::path& path, const ImportOptions& options);

  std::map<Key, SharedModel> models_;
  std::map<std::pair<Key, std::string>, core::SharedMesh> meshes_;
};

}  // namespace elbowroom::cad_import
