#include "cad_import/layout/layout_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include "cad_import/layout/gives_way_keys.h"
#include "cad_import/layout/toml_entry.h"
#include "cad_import/model/cad_model.h"
#include "core/error.h"
#include "core/layout_fault.h"
#include "core/spelling.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;
namespace fs = std::filesystem;

// What reads the parts' files, and who is told.
struct PartFiles {
  PartShelf& shelf;
  const core::Progress& progress;
  const std::stop_token& stop;
};

// If `name` is the last name of a node, the advice is its whole path.
std::string NodeAdvice(const std::string& name, const std::vector<std::string>& nodes) {
  constexpr std::size_t kFew = 5;
  for (const std::string& node : nodes)
    if (node.ends_with("/" + name)) return fmt::format("did you mean '{}'?", node);
  const std::span some(nodes.data(), std::min(nodes.size(), kFew));
  return core::SpellingAdvice(
      name, nodes,
      fmt::format("it has '{}'{}", fmt::join(some, "', '"),
                  nodes.size() > kFew ? fmt::format(" and {} more", nodes.size() - kFew) : ""));
}

// The first key of the part's recovery rule that is there: its line is named where the keys don't fit
// together.
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

const CadModel& ReadModel(const TomlEntry& entry, const core::Part& part, const fs::path& path,
                          const ImportOptions& options, const PartFiles& files) {
  try {
    return files.shelf.Model(path, options, files.progress, files.stop);
  } catch (const Error& error) {
    entry.FailAt(entry.Find("file")->source(), fmt::format("part '{}': {}", part.name, error.what()),
                 error.kind());
  }
}

core::Part ReadPart(const TomlEntry& entry, const fs::path& folder,
                    std::optional<core::LengthUnit> layout_unit, const PartFiles& files,
                    std::vector<std::string>& warnings) {
  core::Part part;
  part.name = entry.Text("name");
  part.file = entry.Text("file");
  if (entry.Find("node")) part.node = entry.Text("node");
  part.world_from_part = core::FromPositionAndRollPitchYaw(entry.VectorOrZero("position_mm"),
                                                           entry.VectorOrZero("rotation_rpy_deg"));
  part.recovery = ReadRecovery(entry);
  part.gives_way = ReadGivesWay(entry);
  const fs::path path = folder / part.file;
  const ImportOptions options{.unit = entry.Unit(), .unit_if_file_has_none = layout_unit};
  const CadModel& model = ReadModel(entry, part, path, options, files);
  part.unit = core::ParseLengthUnit(model.report.unit);
  for (const std::string& warning : model.report.warnings)
    warnings.push_back(fmt::format("part '{}' ({}): {}", part.name, part.file, warning));
  const std::vector<std::string> nodes = NodesOf(model);
  if (!part.node.empty() && std::ranges::find(nodes, part.node) == nodes.end())
    entry.Fail("node",
               fmt::format("'{}' is nothing in {}; {}", part.node, part.file, NodeAdvice(part.node, nodes)));
  const auto twins = std::ranges::count(model.instances, part.node, &CadInstance::path);
  if (!part.node.empty() && twins > 1)
    warnings.push_back(fmt::format("part '{}' ({}): {} instances are '{}'; all of them were taken", part.name,
                                   part.file, twins, part.node));
  part.mesh = files.shelf.Mesh(path, options, part.node, files.progress, files.stop);
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
                 const std::string& name, bool may_be_group = true) {
  if (layout.FindPart(name) || (may_be_group && layout.FindGroup(name))) return;
  std::vector<std::string> known;
  for (const core::Part& part : layout.parts) known.push_back(part.name);
  if (may_be_group)
    for (const core::Group& group : layout.groups) known.push_back(group.name);
  entry.Fail(key, fmt::format("names no part: '{}'; {}", name,
                              core::SpellingAdvice(name, known, "use the name of a [[part]]")));
}

core::Group ReadGroup(const TomlEntry& entry, const core::Layout& layout) {
  core::Group group{entry.Text("name"), entry.Texts("parts")};
  if (entry.Find("parts") == nullptr) entry.Fail("parts", "is missing; add it");
  for (const std::string& part : group.parts) RequirePart(layout, entry, "parts", part, false);
  return group;
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

// The file's entries and the layout that grows from them.
class LayoutReader {
 public:
  explicit LayoutReader(const TomlEntry& root) : root_(root) {}

  // Reads every entry of that kind by `read`, which may look at what was read before.
  template <typename Value, typename Read>
  void ReadAll(core::LayoutEntry entry, std::string_view kind, std::vector<Value>& values, Read read) {
    entries_[entry] = root_.Entries(kind, KeysOf(kind));
    for (const TomlEntry& one : entries_[entry]) values.push_back(read(one));
  }

  void RequireNoFault(const core::Layout& layout) const {
    const auto fault = core::FindLayoutFault(layout);
    if (!fault) return;
    const TomlEntry& entry = entries_.at(fault->entry)[fault->index];
    const toml::node* node = entry.Find(fault->key);
    entry.FailAt(node == nullptr ? entry.source() : node->source(), fault->message, ErrorKind::kRange);
  }

 private:
  const TomlEntry& root_;
  std::map<core::LayoutEntry, std::vector<TomlEntry>> entries_;
};

}  // namespace

ImportedLayout ImportLayoutFile(const std::filesystem::path& path, const core::Progress& progress,
                                const std::stop_token& stop) {
  return ImportLayoutText(LayoutText::Read(path), progress, stop);
}

ImportedLayout ImportLayoutText(const LayoutText& text, const core::Progress& progress,
                                const std::stop_token& stop) {
  PartShelf shelf;
  return ImportLayoutText(text, shelf, progress, stop);
}

ImportedLayout ImportLayoutText(const LayoutText& text, PartShelf& shelf, const core::Progress& progress,
                                const std::stop_token& stop) {
  const std::string file = text.file().string();
  const fs::path folder = text.file().parent_path();
  const toml::table table = ParseToml(text.text(), file);
  const TomlEntry root(table, file, "", kLayoutKeys);
  ImportedLayout result;
  core::Layout& layout = result.layout;
  const auto unit = root.Unit();
  layout.unit = unit.value_or(layout.unit);
  const PartFiles files{shelf, progress, stop};
  LayoutReader reader(root);
  using core::LayoutEntry;
  reader.ReadAll(LayoutEntry::kPart, "part", layout.parts, [&](const TomlEntry& entry) {
    return ReadPart(entry, folder, unit, files, result.warnings);
  });
  if (layout.parts.empty())
    throw Error(ErrorKind::kFormat,
                fmt::format("{}:1: no [[part]]; add at least one, as `elbowroom layout add` does", file));
  reader.ReadAll(LayoutEntry::kGroup, "group", layout.groups,
                 [&](const TomlEntry& entry) { return ReadGroup(entry, layout); });
  reader.ReadAll(LayoutEntry::kSpacing, "spacing", layout.spacings,
                 [&](const TomlEntry& entry) { return ReadSpacing(entry, layout); });
  reader.ReadAll(LayoutEntry::kPair, "pair", layout.pair_rules,
                 [&](const TomlEntry& entry) { return ReadPair(entry, layout); });
  reader.ReadAll(LayoutEntry::kStream, "stream", layout.streams, ReadStream);
  reader.RequireNoFault(layout);
  result.sections = SectionsOf(text);
  return result;
}

}  // namespace elbowroom::cad_import
