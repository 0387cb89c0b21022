#include "cad_import/layout/layout_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cad_import/layout/layout_change.h"
#include "cad_import/layout/layout_fields.h"
#include "cad_import/layout/toml_entry.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

constexpr std::string_view kKind = "section";

LayoutSection ReadSection(const TomlEntry& entry) {
  LayoutSection section;
  section.name = entry.Text("name");
  const std::optional<Eigen::Vector3d> normal = entry.Vector("normal");
  if (!normal) entry.Fail("normal", "is missing; add it, [0, 1, 0] for a plane across y");
  if (normal->norm() < kShortestNormal)
    entry.Fail("normal", "has no direction; give it a length", core::ErrorKind::kRange);
  section.normal = *normal;
  section.offset_mm = entry.Number("offset_mm");
  section.is_on = entry.FlagOr("on", true);
  return section;
}

Fields FieldsOf(const LayoutSection& section) {
  return {{"name", section.name},
          {"normal", section.normal},
          {"offset_mm", section.offset_mm},
          {"on", section.is_on}};
}

std::vector<Fields> FieldsOfEach(const std::vector<LayoutSection>& sections) {
  std::vector<Fields> all;
  for (const LayoutSection& section : sections) all.push_back(FieldsOf(section));
  return all;
}

bool HasName(const std::vector<LayoutSection>& sections, const std::string& name) {
  return std::ranges::find(sections, name, &LayoutSection::name) != sections.end();
}

}  // namespace

std::vector<LayoutSection> SectionsOf(const LayoutText& text) {
  std::vector<LayoutSection> sections;
  if (text.Count(kKind) == 0 && text.text().find(kKind) == std::string::npos) return sections;
  const std::string file = text.file().string();
  const toml::table table = ParseToml(text.text(), file);
  const TomlEntry root(table, file, "", kLayoutKeys);
  for (const TomlEntry& entry : root.Entries(kKind, KeysOf(kKind))) {
    LayoutSection section = ReadSection(entry);
    if (HasName(sections, section.name))
      entry.Fail("name", fmt::format("is there twice: '{}'; choose another", section.name),
                 core::ErrorKind::kRange);
    sections.push_back(std::move(section));
  }
  if (sections.size() > kMostSections)
    root.Fail(kKind, fmt::format("has {} entries; at most {} can be used", sections.size(), kMostSections),
              core::ErrorKind::kRange);
  return sections;
}

void ChangeSections(LayoutText& text, const std::vector<LayoutSection>& sections) {
  LayoutText changed = text;
  std::vector<LayoutSection> are = SectionsOf(text);
  for (std::size_t i = 0; i < std::min(are.size(), sections.size()); ++i) {
    if (HasName(sections, are[i].name) || HasName(are, sections[i].name)) continue;
    are[i].name = sections[i].name;
    changed.Set(kKind, i, {"name", are[i].name});
  }
  ChangeEntries(changed, kKind, FieldsOfEach(are), FieldsOfEach(sections));
  (void)SectionsOf(changed);
  text = std::move(changed);
}

}  // namespace elbowroom::cad_import
