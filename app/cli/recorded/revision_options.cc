#include "app/cli/recorded/revision_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cad_import/layout/layout_file.h"
#include "cad_import/mesh_file.h"
#include "core/error.h"

namespace elbowroom::cli {
namespace {

std::optional<RevisionSetting> ParseRevision(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) return std::nullopt;
  const std::size_t colon = text.substr(0, equals).find(':');
  if (colon == std::string::npos) return RevisionSetting{text.substr(0, equals), text.substr(equals + 1), {}};
  RevisionSetting setting{text.substr(0, colon), {}, ParsePart(text.substr(colon + 1))};
  if (setting.name.empty() || !setting.part) return std::nullopt;
  return setting;
}

// The setting as an option of a process in another folder.
std::string TextOf(const RevisionSetting& setting) {
  if (!setting.part) return fmt::format("{}={}", setting.name, absolute(setting.layout).string());
  const PartSetting& part = *setting.part;
  std::string text = fmt::format("{}:{}={}", setting.name, part.name, absolute(part.file).string());
  if (part.unit) text += fmt::format(":{}", core::ToString(*part.unit));
  return text;
}

void Add(const RevisionSetting& setting, const CommandContext& context, control::SweepRevision* revision,
         std::vector<std::string>* warnings) {
  revision->arguments.push_back(TextOf(setting));
  if (setting.part) {
    const std::vector<control::PartRevision>& parts = revision->changes.parts;
    if (std::ranges::find(parts, setting.part->name, &control::PartRevision::part) != parts.end())
      throw core::Error(core::ErrorKind::kRange,
                        fmt::format("--revision: '{}' has two files for the part '{}'; give the second "
                                    "another name",
                                    setting.name, setting.part->name));
    revision->changes.parts.push_back(PartRevisionOf(*setting.part, context, warnings));
    return;
  }
  if (revision->changes.layout)
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format("--revision: '{}' has two layouts; give the second another name", setting.name));
  cad_import::ImportedLayout imported =
      cad_import::ImportLayoutFile(setting.layout, context.progress, context.stop);
  revision->changes.layout = std::move(imported.layout);
  for (const std::string& warning : imported.warnings)
    warnings->push_back(fmt::format("revision '{}': {}", setting.name, warning));
}

}  // namespace

std::optional<PartSetting> ParsePart(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) return std::nullopt;
  PartSetting part{text.substr(0, equals), text.substr(equals + 1), std::nullopt};
  const std::string file = part.file.string();
  const std::size_t colon = file.rfind(':');
  if (colon == std::string::npos || colon == 0) return part;
  // A colon belongs to the file's name unless a unit follows it.
  part.unit = core::ParseLengthUnit(file.substr(colon + 1));
  if (part.unit) part.file = file.substr(0, colon);
  return part;
}

void AddRevisionOption(CLI::App& command, std::vector<RevisionSetting>* settings) {
  command
      .add_option_function<std::vector<std::string>>(
          "--revision",
          [settings](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) settings->push_back(*ParseRevision(text));
          },
          "judge the motion against this revision, too: another layout, or other CAD of a part; may be given "
          "several times")
      ->type_name("NAME=LAYOUT.toml|NAME:PART=FILE[:UNIT]")
      ->check([](const std::string& text) {
        return ParseRevision(text) ? std::string()
                                   : "must be NAME=LAYOUT.toml or NAME:PART=FILE[:UNIT], not " + text;
      });
}

control::PartRevision PartRevisionOf(const PartSetting& setting, const CommandContext& context,
                                     std::vector<std::string>* warnings) {
  cad_import::ImportedMesh imported =
      cad_import::ImportMeshFile(setting.file, {.unit = setting.unit}, context.progress, context.stop);
  for (const std::string& warning : imported.report.warnings)
    warnings->push_back(fmt::format("part '{}': {}", setting.name, warning));
  return {setting.name, setting.file.string(), std::move(imported.mesh)};
}

std::vector<control::SweepRevision> SweepRevisionsOf(const std::vector<RevisionSetting>& settings,
                                                     const CommandContext& context,
                                                     std::vector<std::string>* warnings) {
  std::vector<control::SweepRevision> revisions;
  for (const RevisionSetting& setting : settings) {
    auto revision = std::ranges::find(revisions, setting.name, &control::SweepRevision::name);
    if (revision == revisions.end()) revision = revisions.insert(revisions.end(), {setting.name, {}, {}});
    Add(setting, context, &*revision, warnings);
  }
  return revisions;
}

}  // namespace elbowroom::cli
