#include "cad_import/layout_file.h"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <utility>

#include "cad_import/gives_way_keys.h"
#include "cad_import/mesh_file.h"
#include "cad_import/toml_entry.h"
#include "core/error.h"
#include "core/spelling.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;

// Reads each file once for each unit that it is asked for in.
class MeshShelf {
 public:
  struct Item {
    core::SharedMesh mesh;
    ImportReport report;
  };
  const Item& Get(const std::filesystem::path& path, const ImportOptions& options) {
    const auto key = std::make_tuple(path.lexically_normal(), options.unit);
    const auto found = items_.find(key);
    if (found != items_.end()) return found->second;
    ImportedMesh imported = ImportMeshFile(path, options);
    return items_.emplace(key, Item{std::move(imported.mesh), std::move(imported.report)}).first->second;
  }

 private:
  std::map<std::tuple<std::filesystem::path, std::optional<core::LengthUnit>>, Item> items_;
};

// The first key of the part's constraint that is there, for the line of what is wrong with them together.
std::string_view RecoveryKeyOf(const TomlEntry& entry) {
  for (const std::string_view key : {"recovery", "recovery_axis", "recovery_at_mm"}) {
    if (entry.Find(key) != nullptr) return key;
  }
  return "reference_mm";
}

core::RecoveryRule ReadRecovery(const TomlEntry& entry) {
  core::RecoveryRule rule;
  const auto kind = core::ParseRecoveryKind(entry.TextOr("recovery", std::string(core::ToString(rule.kind))));
  if (!kind) entry.Fail("recovery", "must be \"reference\", \"direction\", \"slider\" or \"hinge\"");
  rule = {*kind, entry.Vector("reference_mm"), entry.Vector("recovery_axis"), entry.Vector("recovery_at_mm")};
  if (const auto broken = rule.BrokenRule())
    entry.Fail(RecoveryKeyOf(entry), fmt::format("({}): {}", core::ToString(rule.kind), *broken));
  return rule;
}

core::Part ReadPart(const TomlEntry& entry, const std::filesystem::path& folder,
                    std::optional<core::LengthUnit> layout_unit, MeshShelf& shelf,
                    std::vector<std::string>& warnings) {
  core::Part part;
  part.name = entry.Text("name");
  part.file = entry.Text("file");
  part.world_from_part = core::FromPositionAndRollPitchYaw(entry.VectorOrZero("position_mm"),
                                                           entry.VectorOrZero("rotation_rpy_deg"));
  part.recovery = ReadRecovery(entry);
  part.gives_way = ReadGivesWay(entry);
  const ImportOptions options{.unit = entry.Unit(), .unit_if_file_has_none = layout_unit};
  try {
    const MeshShelf::Item& item = shelf.Get(folder / part.file, options);
    part.mesh = item.mesh;
    part.unit = options.unit;
    for (const std::string& warning : item.report.warnings) {
      warnings.push_back(fmt::format("part '{}' ({}): {}", part.name, part.file, warning));
    }
  } catch (const Error& error) {
    entry.FailAt(entry.Find("file")->source(), fmt::format("part '{}': {}", part.name, error.what()),
                 error.kind());
  }
  return part;
}

core::Stream ReadStream(const TomlEntry& entry) {
  core::Stream stream;
  stream.name = entry.Text("name");
  stream.position_mm = entry.VectorOrZero("position_mm");
  if (entry.Find("direction")) stream.direction = entry.VectorOrZero("direction");
  stream.rate_per_s = entry.NumberOr("rate_per_s", stream.rate_per_s);
  stream.speed_mm_per_s = entry.NumberOr("speed_mm_per_s", stream.speed_mm_per_s);
  stream.radius_mm = entry.NumberOr("radius_mm", stream.radius_mm);
  return stream;
}

void RequirePart(const core::Layout& layout, const TomlEntry& entry, std::string_view key,
                 const std::string& name) {
  if (layout.FindPart(name)) return;
  std::vector<std::string_view> known;
  for (const core::Part& part : layout.parts) known.emplace_back(part.name);
  const auto nearest = core::NearestWord(name, known);
  entry.Fail(
      key, fmt::format("names no part: '{}'; {}", name,
                       nearest ? fmt::format("did you mean '{}'?", *nearest) : "use the name of a [[part]]"));
}

core::Spacing ReadSpacing(const TomlEntry& entry, const core::Layout& layout) {
  core::Spacing spacing;
  spacing.name = entry.Text("name");
  spacing.moving = entry.Text("moving");
  spacing.reference = entry.Text("reference");
  RequirePart(layout, entry, "moving", spacing.moving);
  RequirePart(layout, entry, "reference", spacing.reference);
  const auto axis = core::ParseAxis(entry.Text("axis"));
  if (!axis) entry.Fail("axis", "must be \"x\", \"y\" or \"z\"");
  spacing.axis = *axis;
  spacing.min_mm = entry.Number("min_mm");
  spacing.max_mm = entry.Number("max_mm");
  spacing.initial_mm = entry.Number("initial_mm");
  return spacing;
}

core::PairRule ReadPair(const TomlEntry& entry, const core::Layout& layout) {
  core::PairRule rule;
  rule.a = entry.Text("a");
  rule.b = entry.Text("b");
  RequirePart(layout, entry, "a", rule.a);
  RequirePart(layout, entry, "b", rule.b);
  rule.required_clearance_mm = entry.NumberOr("required_clearance_mm", 0.0);
  if (rule.required_clearance_mm < 0.0) entry.Fail("required_clearance_mm", "must not be negative");
  rule.authorised_contact = entry.FlagOr("authorised_contact", false);
  rule.ignore = entry.FlagOr("ignore", false);
  return rule;
}

}  // namespace

ImportedLayout ImportLayoutFile(const std::filesystem::path& path) {
  const std::string file = path.string();
  const toml::table table = ParseTomlFile(path, "layout file");
  const TomlEntry root(table, file, "", {"unit", "part", "spacing", "pair", "stream"});
  ImportedLayout result;
  core::Layout& layout = result.layout;
  const auto unit = root.Unit();
  layout.unit = unit.value_or(layout.unit);
  MeshShelf shelf;
  for (const TomlEntry& entry :
       root.Entries("part", {"name", "file", "unit", "position_mm", "rotation_rpy_deg", "reference_mm",
                             "recovery", "recovery_axis", "recovery_at_mm", "gives_way", "pins",
                             "stretch_stiffness_n_per_m", "bending_stiffness_n_per_m",
                             "mass_per_area_kg_per_m2", "damping_per_s", "friction", "max_speed_mm_per_s"})) {
    layout.parts.push_back(ReadPart(entry, path.parent_path(), unit, shelf, result.warnings));
  }
  if (layout.parts.empty())
    throw Error(ErrorKind::kFormat, fmt::format("{}:1: no [[part]]; add at least one", file));
  for (const TomlEntry& entry :
       root.Entries("spacing", {"name", "moving", "reference", "axis", "min_mm", "max_mm", "initial_mm"})) {
    layout.spacings.push_back(ReadSpacing(entry, layout));
  }
  for (const TomlEntry& entry :
       root.Entries("pair", {"a", "b", "required_clearance_mm", "authorised_contact", "ignore"})) {
    layout.pair_rules.push_back(ReadPair(entry, layout));
  }
  for (const TomlEntry& entry : root.Entries(
           "stream", {"name", "position_mm", "direction", "rate_per_s", "speed_mm_per_s", "radius_mm"})) {
    layout.streams.push_back(ReadStream(entry));
  }
  try {
    layout.Validate();
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}: {}", file, error.what()));
  }
  return result;
}

}  // namespace elbowroom::cad_import
