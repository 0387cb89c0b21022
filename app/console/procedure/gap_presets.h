// Gaps that are kept under a name, for trials with the same spacings.
#pragma once

#include <QString>
#include <string>
#include <vector>

namespace elbowroom::console {

struct GapPreset {
  QString name;
  std::vector<double> gap_mm;  // in the layout's order of spacings

  [[nodiscard]] bool operator==(const GapPreset&) const = default;
};

// Those that were kept for these spacings, in the order in which they were saved. What doesn't fit isn't
// there. Thread: UI.
[[nodiscard]] std::vector<GapPreset> PresetsFor(const std::vector<std::string>& spacings);
// Over the program's runs.
void KeepPresets(const std::vector<std::string>& spacings, const std::vector<GapPreset>& presets);

}  // namespace elbowroom::console
