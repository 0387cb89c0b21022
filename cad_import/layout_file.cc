#include "cad_import/layout_file.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "cad_import/mesh_file.h"
#include "cad_import/spelling.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;

// One table of the file, with everything needed to complain about it.
class Entry {
 public:
  // `title`: what it is called in messages, "[[part]]"; empty for the file itself.
  Entry(const toml::table& table, const std::string& file, std::string title,
        std::initializer_list<std::string_view> known)
      : table_(table), file_(file), title_(std::move(title)) {
    for (const auto& [key, value] : table_) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      const auto nearest = NearestWord(key.str(), {known.begin(), known.size()});
      FailAt(key.source(), fmt::format("unknown key '{}'; {}", key.str(),
                                       nearest ? fmt::format("did you mean '{}'?", *nearest) : "remove it"));
    }
  }

  [[noreturn]] void FailAt(const toml::source_region& at, const std::string& what,
                           ErrorKind kind = ErrorKind::kFormat) const {
    throw Error(kind,
                fmt::format("{}:{}: {}{}{}", file_, at.begin.line, title_, title_.empty() ? "" : ": ", what));
  }
  [[noreturn]] void Fail(std::string_view key, const std::string& what,
                         ErrorKind kind = ErrorKind::kFormat) const {
    const toml::node* node = table_.get(key);
    FailAt(node != nullptr ? node->source() : table_.source(), fmt::format("key '{}' {}", key, what), kind);
  }

  [[nodiscard]] const toml::node* Find(std::string_view key) const { return table_.get(key); }

  [[nodiscard]] std::string Text(std::string_view key) const {
    const toml::node* node = Find(key);
    if (node == nullptr) Fail(key, "is missing; add it");
    const auto text = node->value_exact<std::string>();
    if (!text || text->empty()) Fail(key, "must be a text in quotes");
    return *text;
  }
  [[nodiscard]] double NumberOf(const toml::node& node, std::string_view key) const {
    const auto number = node.is_number() ? node.value<double>() : std::nullopt;
    if (!number || !std::isfinite(*number)) Fail(key, "must be a finite number");
    return *number;
  }
  [[nodiscard]] double Number(std::string_view key) const {
    if (Find(key) == nullptr) Fail(key, "is missing; add it");
    return NumberOf(*Find(key), key);
  }
  [[nodiscard]] Eigen::Vector3d VectorOrZero(std::string_view key) const {
    const toml::node* node = Find(key);
    if (node == nullptr) return Eigen::Vector3d::Zero();
    const toml::array* array = node->as_array();
    if (array == nullptr || array->size() != 3) Fail(key, "must be three numbers, [x, y, z]");
    Eigen::Vector3d result;
    for (std::size_t i = 0; i < 3; ++i) result[static_cast<Eigen::Index>(i)] = NumberOf(*array->get(i), key);
    return result;
  }
  [[nodiscard]] std::optional<core::LengthUnit> Unit() const {
    if (Find("unit") == nullptr) return std::nullopt;
    const auto unit = core::ParseLengthUnit(Text("unit"));
    if (!unit) Fail("unit", "must be \"mm\", \"cm\", \"m\" or \"in\"");
    return unit;
  }

 private:
  const toml::table& table_;
  std::string file_;
  std::string title_;
};

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
    return items_
        .emplace(key, Item{std::make_shared<const core::TriangleMesh>(std::move(imported.mesh)),
                           std::move(imported.report)})
        .first->second;
  }

 private:
  std::map<std::tuple<std::filesystem::path, std::optional<core::LengthUnit>>, Item> items_;
};

core::Part ReadPart(const Entry& entry, const std::filesystem::path& folder,
                    std::optional<core::LengthUnit> layout_unit, MeshShelf& shelf,
                    std::vector<std::string>& warnings) {
  core::Part part;
  part.name = entry.Text("name");
  part.file = entry.Text("file");
  part.world_from_part = core::FromPositionAndRollPitchYaw(entry.VectorOrZero("position_mm"),
                                                           entry.VectorOrZero("rotation_rpy_deg"));
  const ImportOptions options{.unit = entry.Unit(), .unit_if_file_has_none = layout_unit};
  try {
    const MeshShelf::Item& item = shelf.Get(folder / part.file, options);
    part.mesh = item.mesh;
    part.unit = item.report.unit;
    for (const std::string& warning : item.report.warnings) {
      warnings.push_back(fmt::format("part '{}' ({}): {}", part.name, part.file, warning));
    }
  } catch (const Error& error) {
    entry.FailAt(entry.Find("file")->source(), fmt::format("part '{}': {}", part.name, error.what()),
                 error.kind());
  }
  return part;
}

void RequirePart(const core::Layout& layout, const Entry& entry, std::string_view key,
                 const std::string& name) {
  if (layout.FindPart(name)) return;
  std::vector<std::string_view> known;
  for (const core::Part& part : layout.parts) known.emplace_back(part.name);
  const auto nearest = NearestWord(name, known);
  entry.Fail(
      key, fmt::format("names no part: '{}'; {}", name,
                       nearest ? fmt::format("did you mean '{}'?", *nearest) : "use the name of a [[part]]"));
}

core::Spacing ReadSpacing(const Entry& entry, const core::Layout& layout) {
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

core::PairRule ReadPair(const Entry& entry, const core::Layout& layout) {
  core::PairRule rule;
  rule.a = entry.Text("a");
  rule.b = entry.Text("b");
  RequirePart(layout, entry, "a", rule.a);
  RequirePart(layout, entry, "b", rule.b);
  if (entry.Find("required_clearance_mm") != nullptr) {
    rule.required_clearance_mm = entry.Number("required_clearance_mm");
    if (rule.required_clearance_mm < 0.0) entry.Fail("required_clearance_mm", "must not be negative");
  }
  if (const toml::node* node = entry.Find("authorised_contact")) {
    const auto value = node->value_exact<bool>();
    if (!value) entry.Fail("authorised_contact", "must be true or false");
    rule.authorised_contact = *value;
  }
  return rule;
}

// Calls `read` with each table of [[key]].
template <typename Read>
void ForEachEntry(const Entry& root, const std::string& file, const char* key,
                  std::initializer_list<std::string_view> known, Read read) {
  const toml::node* node = root.Find(key);
  if (node == nullptr) return;
  const toml::array* entries = node->as_array();
  if (entries == nullptr) root.Fail(key, fmt::format("must be written as [[{}]]", key));
  for (const toml::node& element : *entries) {
    if (!element.is_table()) root.Fail(key, fmt::format("must be written as [[{}]]", key));
    read(Entry(*element.as_table(), file, fmt::format("[[{}]]", key), known));
  }
}

toml::table Parse(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw Error(ErrorKind::kFile, fmt::format("{}: no such layout file; check the path", path.string()));
  }
  try {
    return toml::parse_file(path.string());
  } catch (const toml::parse_error& parse_error) {
    throw Error(ErrorKind::kFormat, fmt::format("{}:{}: not TOML: {}; correct this line", path.string(),
                                                parse_error.source().begin.line, parse_error.description()));
  }
}

}  // namespace

ImportedLayout ImportLayoutFile(const std::filesystem::path& path) {
  const std::string file = path.string();
  const toml::table table = Parse(path);
  const Entry root(table, file, "", {"unit", "part", "spacing", "pair"});
  ImportedLayout result;
  core::Layout& layout = result.layout;
  const auto unit = root.Unit();
  layout.unit = unit.value_or(layout.unit);
  MeshShelf shelf;
  ForEachEntry(root, file, "part", {"name", "file", "unit", "position_mm", "rotation_rpy_deg"},
               [&](const Entry& entry) {
                 layout.parts.push_back(ReadPart(entry, path.parent_path(), unit, shelf, result.warnings));
               });
  if (layout.parts.empty())
    throw Error(ErrorKind::kFormat, fmt::format("{}:1: no [[part]]; add at least one", file));
  ForEachEntry(root, file, "spacing",
               {"name", "moving", "reference", "axis", "min_mm", "max_mm", "initial_mm"},
               [&](const Entry& entry) { layout.spacings.push_back(ReadSpacing(entry, layout)); });
  ForEachEntry(root, file, "pair", {"a", "b", "required_clearance_mm", "authorised_contact"},
               [&](const Entry& entry) { layout.pair_rules.push_back(ReadPair(entry, layout)); });
  try {
    layout.Validate();
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}: {}", file, error.what()));
  }
  return result;
}

core::Layout ReadLayoutFile(const std::filesystem::path& path) { return ImportLayoutFile(path).layout; }

}  // namespace elbowroom::cad_import
