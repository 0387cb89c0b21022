#include "app/control/layout_editing/trial_draft.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "app/control/layout_editing/layout_edit.h"
#include "cad_import/layout/layout_fields.h"
#include "cad_import/layout/toml_entry.h"
#include "core/error.h"
#include "core/system/whole_file.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;

void RequireFile(const fs::path& file, std::string_view what) {
  if (fs::is_regular_file(file)) return;
  throw core::Error(core::ErrorKind::kFile,
                    file.empty() ? fmt::format("a trial needs a {}; choose one", what)
                                 : fmt::format("{}: no such {}; check the path", file.string(), what));
}

void RequireFromZero(double length_mm, std::string_view what) {
  if (length_mm >= 0.0) return;
  throw core::Error(core::ErrorKind::kRange,
                    fmt::format("the {} is {} mm; it must not be negative", what, length_mm));
}

}  // namespace

std::string TrialText(const TrialDraft& draft, const fs::path& trial_file) {
  std::string text;
  const auto add = [&](std::string_view key, const cad_import::FieldValue& value) {
    text += fmt::format("{} = {}\n", key, cad_import::TomlOf(value));
  };
  add("rig", FileBeside(trial_file, draft.rig));
  add("layout", FileBeside(trial_file, draft.layout));
  if (!draft.participant.empty()) add("participant", draft.participant);
  if (!draft.task.empty()) add("task", draft.task);
  if (draft.estimate_mm > 0.0) add("estimate_mm", draft.estimate_mm);
  if (draft.required_clearance_mm > 0.0) add("required_clearance_mm", draft.required_clearance_mm);
  if (!draft.tools.empty()) add("tools", draft.tools);
  return text;
}

void WriteTrial(const TrialDraft& draft, const fs::path& trial_file) {
  RequireFile(draft.layout, "layout");
  RequireFile(draft.rig, "rig file (RIG.yml)");
  RequireFromZero(draft.estimate_mm, "estimate");
  RequireFromZero(draft.required_clearance_mm, "required clearance");
  if (fs::exists(trial_file) && KindOf(trial_file) != TomlKind::kTrial)
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("{}: is there and is no trial; choose another name", trial_file.string()));
  core::WriteWholeFile(trial_file, TrialText(draft, trial_file));
}

TomlKind KindOf(const fs::path& toml_file) {
  const toml::table table = cad_import::ParseTomlFile(toml_file, "layout or trial file");
  const auto has = [&](std::string_view key) { return table.contains(key); };
  constexpr std::array<std::string_view, 3> kTrial{"rig", "layout", "base"};
  if (std::ranges::any_of(kTrial, has)) return TomlKind::kTrial;
  if (table.empty() || std::ranges::any_of(cad_import::kLayoutKeys, has)) return TomlKind::kLayout;
  throw core::Error(core::ErrorKind::kFormat,
                    fmt::format("{}:1: is neither a trial (no `rig`, no `layout`) nor a layout (no "
                                "[[part]])",
                                toml_file.string()));
}

}  // namespace elbowroom::control
