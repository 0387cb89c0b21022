#include "app/control/layout_editing/layout_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/spelling.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;
using cad_import::Field;
using cad_import::Fields;
using cad_import::LayoutText;

template <typename Value>
void Add(Fields& fields, const char* key, const std::optional<Value>& value) {
  if (value) fields.push_back({key, *value});
}

std::string NameOf(const LayoutText& text, std::string_view kind, std::size_t index) {
  const std::vector<std::string> names = text.TextsOf(kind, index, "name");
  return names.empty() ? "" : names.front();
}

std::optional<std::size_t> Find(const LayoutText& text, std::string_view kind, const std::string& name) {
  for (std::size_t i = 0; i < text.Count(kind); ++i)
    if (NameOf(text, kind, i) == name) return i;
  return std::nullopt;
}

std::optional<std::size_t> FindPair(const LayoutText& text, const PairEdit& edit) {
  const auto names = std::minmax(edit.a, edit.b);
  for (std::size_t i = 0; i < text.Count("pair"); ++i) {
    const std::vector<std::string> a = text.TextsOf("pair", i, "a"), b = text.TextsOf("pair", i, "b");
    if (!a.empty() && !b.empty() && std::minmax(a.front(), b.front()) == names) return i;
  }
  return std::nullopt;
}

// Throws, and names the entry of these kinds whose name is nearest.
[[noreturn]] void FailUnknown(const LayoutText& text, const std::vector<std::string_view>& kinds,
                              const std::string& name) {
  std::vector<std::string> names;
  for (const std::string_view kind : kinds)
    for (std::size_t i = 0; i < text.Count(kind); ++i) names.push_back(NameOf(text, kind, i));
  throw core::Error(
      core::ErrorKind::kRange,
      fmt::format("{}: nothing is named '{}'; {}", text.file().string(), name,
                  core::SpellingAdvice(name, names, "`elbowroom layout show` lists the names")));
}

// Where a rule names a part.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kRules = {
    {{"spacing", "moving"}, {"spacing", "reference"}, {"pair", "a"}, {"pair", "b"}}};

void SetAll(LayoutText& text, std::string_view kind, std::size_t index, const Fields& fields) {
  for (const Field& field : fields) text.Set(kind, index, field);
}

// The entries that name it: "the [[spacing]] in line 12", ...
std::vector<std::string> UsersOf(const LayoutText& text, const std::string& name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kNaming = {
      {{"group", "parts"}, {"spacing", "moving"}, {"spacing", "reference"}, {"pair", "a"}, {"pair", "b"}}};
  std::vector<std::string> users;
  for (const auto& [kind, key] : kNaming) {
    for (std::size_t i = 0; i < text.Count(kind); ++i) {
      if (std::ranges::count(text.TextsOf(kind, i, key), name) == 0) continue;
      std::string user = fmt::format("the [[{}]] in line {}", kind, text.LineOf(kind, i));
      if (std::ranges::count(users, user) == 0) users.push_back(std::move(user));
    }
  }
  return users;
}

// The first entry whose key is `name`, or that has it in its list.
std::optional<std::size_t> FindUser(const LayoutText& text, std::string_view kind, std::string_view key,
                                    const std::string& name) {
  for (std::size_t i = 0; i < text.Count(kind); ++i)
    if (std::ranges::count(text.TextsOf(kind, i, key), name) > 0) return i;
  return std::nullopt;
}

}  // namespace

std::string FreePartName(const LayoutText& text, const std::string& wanted) {
  std::string name = wanted;
  for (int i = 2; Find(text, "part", name) || Find(text, "group", name); ++i)
    name = fmt::format("{}_{}", wanted, i);
  return name;
}

std::string FileBeside(const fs::path& layout, const fs::path& file) {
  const fs::path folder = fs::absolute(layout).parent_path();
  return fs::proximate(fs::absolute(file), folder).generic_string();
}

std::string AddPart(LayoutText& text, const PartEdit& edit) {
  std::string name = edit.name.empty() ? FreePartName(text, edit.file.stem().string()) : edit.name;
  Fields fields{{"name", name}, {"file", FileBeside(text.file(), edit.file)}};
  if (!edit.node.empty()) fields.push_back({"node", edit.node});
  if (edit.unit) fields.push_back({"unit", std::string(core::ToString(*edit.unit))});
  Add(fields, "position_mm", edit.position_mm);
  Add(fields, "rotation_rpy_deg", edit.rotation_rpy_deg);
  text.Append("part", fields);
  return name;
}

void PutSpacing(LayoutText& text, const SpacingEdit& edit) {
  Fields fields{{"name", edit.name}};
  Add(fields, "moving", edit.moving);
  Add(fields, "reference", edit.reference);
  Add(fields, "axis", edit.axis);
  Add(fields, "min_mm", edit.min_mm);
  Add(fields, "max_mm", edit.max_mm);
  Add(fields, "initial_mm", edit.initial_mm);
  if (const auto index = Find(text, "spacing", edit.name)) {
    SetAll(text, "spacing", *index, fields);
    return;
  }
  for (const std::string_view key : cad_import::KeysOf("spacing")) {
    if (FindField(fields, key) != nullptr) continue;
    const std::string option(key.substr(0, key.find("_mm")));
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("{}: no spacing is named '{}', and a new one needs --{}; give it too",
                                  text.file().string(), edit.name, option));
  }
  text.Append("spacing", fields);
}

void PutGroup(LayoutText& text, const core::Group& group) {
  const Fields fields{{"name", group.name}, {"parts", group.parts}};
  if (const auto index = Find(text, "group", group.name)) {
    SetAll(text, "group", *index, fields);
  } else {
    text.Append("group", fields);
  }
}

void PutPair(LayoutText& text, const PairEdit& edit) {
  Fields fields;
  Add(fields, "required_clearance_mm", edit.required_clearance_mm);
  Add(fields, "authorised_contact", edit.authorised_contact);
  Add(fields, "ignore", edit.ignore);
  if (const auto index = FindPair(text, edit)) {
    SetAll(text, "pair", *index, fields);
    return;
  }
  fields.insert(fields.begin(), {{"a", edit.a}, {"b", edit.b}});
  text.Append("pair", fields);
}

void MovePart(LayoutText& text, const PartEdit& edit) {
  const auto index = Find(text, "part", edit.name);
  if (!index) FailUnknown(text, {"part"}, edit.name);
  Fields fields;
  Add(fields, "position_mm", edit.position_mm);
  Add(fields, "rotation_rpy_deg", edit.rotation_rpy_deg);
  SetAll(text, "part", *index, fields);
}

void RemoveNamed(LayoutText& text, const std::string& name) {
  const std::vector<std::string_view> kinds{"part", "group", "spacing", "stream"};
  for (const std::string_view kind : kinds) {
    const auto index = Find(text, kind, name);
    if (!index) continue;
    const std::vector<std::string> users =
        kind == "part" || kind == "group" ? UsersOf(text, name) : std::vector<std::string>();
    if (!users.empty()) {
      throw core::Error(core::ErrorKind::kRange,
                        fmt::format("{}: '{}' is named by {}; remove that first, or name another part there",
                                    text.file().string(), name, fmt::join(users, " and ")));
    }
    text.Remove(kind, *index);
    return;
  }
  FailUnknown(text, kinds, name);
}

void RenamePart(LayoutText& text, const std::string& from, const std::string& to) {
  const auto index = Find(text, "part", from);
  if (!index) FailUnknown(text, {"part"}, from);
  if (FreePartName(text, to) != to)
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format("{}: a part or group is named '{}'; choose another name", text.file().string(), to));
  text.Set("part", *index, {"name", to});
  for (const auto& [kind, key] : kRules)
    while (const auto user = FindUser(text, kind, key, from)) text.Set(kind, *user, {std::string(key), to});
  while (const auto group = FindUser(text, "group", "parts", from)) {
    std::vector<std::string> parts = text.TextsOf("group", *group, "parts");
    std::ranges::replace(parts, from, to);
    text.Set("group", *group, {"parts", parts});
  }
}

void RemoveWithUsers(LayoutText& text, const std::string& name) {
  for (const auto& [kind, key] : kRules)
    while (const auto index = FindUser(text, kind, key, name)) text.Remove(kind, *index);
  while (const auto index = FindUser(text, "group", "parts", name)) {
    std::vector<std::string> parts = text.TextsOf("group", *index, "parts");
    std::erase(parts, name);
    if (parts.empty()) {
      RemoveWithUsers(text, NameOf(text, "group", *index));
    } else {
      text.Set("group", *index, {"parts", parts});
    }
  }
  RemoveNamed(text, name);
}

void RemovePair(LayoutText& text, const PairEdit& edit) {
  const auto index = FindPair(text, edit);
  if (!index) {
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("{}: no [[pair]] is of '{}' and '{}'; `elbowroom layout show` lists them",
                                  text.file().string(), edit.a, edit.b));
  }
  text.Remove("pair", *index);
}

}  // namespace elbowroom::control
