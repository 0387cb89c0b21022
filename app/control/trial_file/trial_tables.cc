#include "app/control/trial_file/trial_tables.h"

#include <fmt/format.h>

#include <utility>

#include "app/control/trial_file/trial_keys.h"

namespace elbowroom::control {

using cad_import::TomlEntry;

TomlEntry TrialTables::Root() const { return {table, file.string(), "", kTrialKeys}; }

std::optional<TomlEntry> TrialTables::Planned() const {
  if (!planned) return std::nullopt;
  return TomlEntry(*planned, planned_file.string(), "", kPlannedTrialKeys);
}

TrialTables ReadTrialTables(const std::filesystem::path& path, std::string_view what) {
  TrialTables tables{path, cad_import::ParseTomlFile(path, what)};
  if (!tables.table.contains("base")) return tables;
  tables.planned_file = path;
  tables.planned = std::exchange(tables.table, {});
  const TomlEntry entry = *tables.Planned();
  tables.file = path.parent_path() / entry.Text("base");
  if (!std::filesystem::exists(tables.file))
    entry.Fail("base", fmt::format("names '{}', which isn't there", tables.file.string()),
               core::ErrorKind::kFile);
  tables.table = cad_import::ParseTomlFile(tables.file, what);
  if (tables.table.contains("base"))
    entry.Fail("base",
               fmt::format("names '{}', which has a base itself; name that one", tables.file.string()));
  return tables;
}

}  // namespace elbowroom::control
