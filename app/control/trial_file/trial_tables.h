// A trial file's tables: its own, and those of the file that it names as its base.
#pragma once

#include <filesystem>
#include <optional>

#include "cad_import/layout/toml_entry.h"

namespace elbowroom::control {

struct TrialTables {
  // Of what says rig, layout and all else: the file itself, or its base. Paths in `table` start at its
  // folder.
  std::filesystem::path file;
  toml::table table;
  // Of a file with a `base`: what it says itself, which holds instead of the base's.
  std::filesystem::path planned_file = {};
  std::optional<toml::table> planned = {};

  // With the keys of a trial file (kTrialKeys). Throws: Error{kFormat} for any other. Must not outlive this.
  [[nodiscard]] cad_import::TomlEntry Root() const;
  // With kPlannedTrialKeys; nothing: the file has no base.
  [[nodiscard]] std::optional<cad_import::TomlEntry> Planned() const;
};

// `what` names the kind of file for messages: "trial file". Throws: Error{kFile} for a file, or a base, that
// isn't there; Error{kFormat} with file and line for what isn't TOML, a key that a file with a base can't
// have, or a base that has one itself.
[[nodiscard]] TrialTables ReadTrialTables(const std::filesystem::path& path,
                                          std::string_view what = "trial file");

}  // namespace elbowroom::control
