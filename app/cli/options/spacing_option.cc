#include "app/cli/options/spacing_option.h"

#include <fmt/format.h>

#include <optional>

#include "app/cli/options/unit_option.h"
#include "core/error.h"

namespace elbowroom::cli {
namespace {

std::optional<SpacingSetting> ParseSetting(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) return std::nullopt;
  const std::optional<double> gap_mm = ParseNumber(text.substr(equals + 1));
  if (!gap_mm) return std::nullopt;
  return SpacingSetting{text.substr(0, equals), *gap_mm};
}

}  // namespace

void AddSpacingOption(CLI::App& command, std::vector<SpacingSetting>* settings) {
  command
      .add_option_function<std::vector<std::string>>(
          "--spacing",
          [settings](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) settings->push_back(*ParseSetting(text));
          },
          "set a gap of the layout, mm (default: initial_mm); may be repeated")
      ->allow_extra_args(false)
      ->check(CLI::Validator(
          [](const std::string& text) -> std::string {
            return ParseSetting(text)
                       ? ""
                       : "must be the name of a [[spacing]], =, and a number of mm, not " + text;
          },
          "NAME=MM"));
}

std::vector<double> SpacingsWith(const core::Layout& layout, const std::vector<SpacingSetting>& settings) {
  std::vector<double> gaps_mm = layout.InitialSpacings();
  for (const auto& [name, gap_mm] : settings) {
    const core::SpacingIndex index = core::RequireSpacing(layout, name);
    const core::Spacing& spacing = layout.spacings[index];
    if (gap_mm < spacing.min_mm || gap_mm > spacing.max_mm) {
      throw core::Error(
          core::ErrorKind::kRange,
          fmt::format("--spacing: '{}' goes from {} to {} mm, not to {}; choose a gap between them", name,
                      spacing.min_mm, spacing.max_mm, gap_mm));
    }
    gaps_mm[index] = gap_mm;
  }
  return gaps_mm;
}

}  // namespace elbowroom::cli
