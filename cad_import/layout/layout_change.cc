#include "cad_import/layout/layout_change.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace elbowroom::cad_import {
namespace {

// The names that an entry is matched by, and how many earlier entries have the same.
using Identity = std::pair<std::vector<FieldValue>, int>;

std::vector<Identity> IdentitiesOf(const std::vector<Fields>& entries) {
  std::vector<Identity> identities;
  for (const Fields& fields : entries) {
    std::vector<FieldValue> names;
    for (const char* key : {"name", "a", "b"})
      if (const FieldValue* name = FindField(fields, key)) names.push_back(*name);
    const auto twins = std::ranges::count(identities, names, &Identity::first);
    identities.emplace_back(std::move(names), static_cast<int>(twins));
  }
  return identities;
}

void ChangeEntry(LayoutText& text, std::string_view kind, std::size_t index, const Fields& before,
                 const Fields& after) {
  for (const auto& [key, value] : before)
    if (FindField(after, key) == nullptr) text.Unset(kind, index, key);
  for (const Field& field : after) {
    const FieldValue* was = FindField(before, field.key);
    if (was != nullptr && *was == field.value) continue;
    text.Set(kind, index, field);
    // A new file may state a unit of its own; the text then needs the part's unit.
    if (field.key != "file") continue;
    if (const FieldValue* unit = FindField(after, "unit")) text.Set(kind, index, {"unit", *unit});
  }
}

}  // namespace

void ChangeEntries(LayoutText& text, std::string_view kind, std::vector<Fields> before,
                   const std::vector<Fields>& after) {
  std::vector<Identity> are = IdentitiesOf(before);
  const std::vector<Identity> shall_be = IdentitiesOf(after);
  for (std::size_t i = are.size(); i-- > 0;) {
    if (std::ranges::find(shall_be, are[i]) != shall_be.end()) continue;
    text.Remove(kind, i);
    are.erase(are.begin() + static_cast<std::ptrdiff_t>(i));
    before.erase(before.begin() + static_cast<std::ptrdiff_t>(i));
  }
  for (std::size_t i = 0; i < after.size(); ++i) {
    const auto here = are.begin() + static_cast<std::ptrdiff_t>(i);
    const auto found = std::find(here, are.end(), shall_be[i]);
    if (found == are.end()) {
      text.Insert(kind, i, after[i]);
      before.insert(before.begin() + static_cast<std::ptrdiff_t>(i), after[i]);
      are.insert(here, shall_be[i]);
      continue;
    }
    const auto from = found - are.begin();
    if (found != here) text.Move(kind, static_cast<std::size_t>(from), i);
    std::rotate(here, found, found + 1);
    std::rotate(before.begin() + static_cast<std::ptrdiff_t>(i), before.begin() + from,
                before.begin() + from + 1);
    ChangeEntry(text, kind, i, before[i], after[i]);
  }
}

void ChangeInto(LayoutText& text, const core::Layout& before, const core::Layout& after) {
  if (before.unit != after.unit) {
    // Parts that relied on the layout's old unit must state it now.
    for (std::size_t i = 0; i < before.parts.size(); ++i) {
      const std::optional<core::LengthUnit> unit = before.parts[i].unit;
      if (unit && !text.Has("part", i, "unit"))
        text.Set("part", i, {"unit", std::string(core::ToString(*unit))});
    }
    text.SetUnit(after.unit);
  }
  for (const std::string_view kind : kEntryKinds)
    ChangeEntries(text, kind, FieldsOf(before, kind), FieldsOf(after, kind));
}

}  // namespace elbowroom::cad_import
