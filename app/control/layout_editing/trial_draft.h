// A new TRIAL.toml for a layout, and what kind of file a TOML file is.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace elbowroom::control {

struct TrialDraft {
  std::filesystem::path layout;
  std::filesystem::path rig;  // RIG.yml
  std::string participant;
  std::string task;
  double estimate_mm = 0.0;            // the participant's guess of the space needed; 0: none
  double required_clearance_mm = 0.0;  // 0: only touches are judged
  std::vector<std::string> tools;
};

// Layout and rig as seen from the trial's folder; what is empty or 0 isn't written.
[[nodiscard]] std::string TrialText(const TrialDraft& draft, const std::filesystem::path& trial_file);

// Writes it whole or not at all. Throws: Error{kRange} for a length below 0; Error{kFile} when layout or rig
// isn't there, or the file can't be written; a file that is there and is no trial isn't replaced.
void WriteTrial(const TrialDraft& draft, const std::filesystem::path& trial_file);

enum class TomlKind { kLayout, kTrial };

// By the keys: what names a rig, a layout or a base is a trial, and what has parts, gaps or rules, or nothing
// at all, is a layout. Throws: Error{kFile} when it can't be read, Error{kFormat} with the line that isn't
// TOML, or naming the file if it is neither.
[[nodiscard]] TomlKind KindOf(const std::filesystem::path& toml_file);

}  // namespace elbowroom::control
