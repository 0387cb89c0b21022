// --part and --revision: other CAD that recorded motion is judged against.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/command.h"
#include "app/control/replay/replay_changes.h"
#include "app/control/sweep/spacing_sweep.h"
#include "core/units.h"

namespace elbowroom::cli {

// NAME=FILE[:UNIT]
struct PartSetting {
  std::string name;
  std::filesystem::path file;
  std::optional<core::LengthUnit> unit;
};
// Nothing for another text.
[[nodiscard]] std::optional<PartSetting> ParsePart(const std::string& text);

// NAME=LAYOUT.toml, or NAME:PART=FILE[:UNIT].
struct RevisionSetting {
  std::string name;
  std::filesystem::path layout;     // empty: the recorded one
  std::optional<PartSetting> part;  // or nothing
};
// May be given several times; settings of one name are one revision.
void AddRevisionOption(CLI::App& command, std::vector<RevisionSetting>* settings);

// Both read the files; what they find odd goes to `warnings`. Throw: what the readers of layouts and CAD
// throw; SweepRevisionsOf also core::Error{kRange} for a revision with two layouts.
[[nodiscard]] control::PartRevision PartRevisionOf(const PartSetting& setting, const CommandContext& context,
                                                   std::vector<std::string>* warnings);
[[nodiscard]] std::vector<control::SweepRevision> SweepRevisionsOf(
    const std::vector<RevisionSetting>& settings, const CommandContext& context,
    std::vector<std::string>* warnings);

}  // namespace elbowroom::cli
