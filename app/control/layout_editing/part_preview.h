// What is in a CAD file, before parts are taken from it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "cad_import/model/cad_model.h"
#include "core/progress.h"
#include "core/units.h"

namespace elbowroom::control {

// One name in the assembly, with all that hangs under it.
struct PreviewNode {
  std::string path;                     // as `node` of a LAYOUT.toml's part
  std::string name;                     // the last name of the path
  std::optional<std::size_t> parent{};  // index of a node that comes before; nothing: a root
  std::int64_t instances = 0;           // bodies at their places
  std::int64_t triangles = 0;
  std::int64_t open_edges = 0;  // of one triangle; 0: closed, but for edges of three or more
  bool is_watertight = true;
  Eigen::Vector3d size_mm = Eigen::Vector3d::Zero();  // along the file's axes
};

struct SizeInUnit {
  core::LengthUnit unit = core::LengthUnit::kMillimetre;
  Eigen::Vector3d size_mm = Eigen::Vector3d::Zero();
  bool is_likely = false;  // the one of them that fits best what is checked at a table
};

struct PartPreview {
  std::filesystem::path file;
  std::optional<core::LengthUnit> chosen_unit{};  // what the caller said; nothing: the file's own
  std::shared_ptr<const cad_import::CadModel> model;
  std::vector<PreviewNode> nodes;  // parents before children, else by path
  Eigen::Vector3d size_mm = Eigen::Vector3d::Zero();
  std::int64_t open_edges = 0;
  // The size of the whole file for each unit. Empty where the file states its unit, or the caller did: then
  // there is no question. Otherwise all lengths of the preview take its numbers for millimetres.
  std::vector<SizeInUnit> sizes;

  [[nodiscard]] bool asks_for_unit() const { return !sizes.empty(); }
  [[nodiscard]] const cad_import::ImportReport& report() const { return model->report; }
};

// Reads the file in a child process (cad_import/cad_file.h), in `unit` if it is given. A file that carries no
// unit is no error here, but a question. Throws: as cad_import::ImportCadFile. Thread: any.
[[nodiscard]] PartPreview PreviewPart(const std::filesystem::path& file,
                                      std::optional<core::LengthUnit> unit = {},
                                      const core::Progress& progress = {}, const std::stop_token& stop = {});

// The same of a model that was read already. `unit`: what it was read with, if the caller gave one.
[[nodiscard]] PartPreview PreviewOf(std::shared_ptr<const cad_import::CadModel> model,
                                    const std::filesystem::path& file,
                                    std::optional<core::LengthUnit> unit = {});

}  // namespace elbowroom::control
