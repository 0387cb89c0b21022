#include "sessions/charts/ink.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace elbowroom::sessions {
namespace {

struct NamedInk {
  Ink ink;
  const char* name;
  const char* light;
  const char* dark;
};

constexpr std::array<NamedInk, 10> kInks = {{
    {Ink::kText, "--ink", "#1d2733", "#e3e8ee"},
    {Ink::kQuiet, "--quiet", "#5c6b7a", "#9aa8b5"},
    {Ink::kGrid, "--grid", "#e6eaee", "#313a44"},
    {Ink::kLane, "--lane", "#f0f3f5", "#262e37"},
    {Ink::kSpacing, "--spacing", "#1c5d99", "#6db0ec"},
    {Ink::kTool, "--tool", "#2a7f78", "#4fbdb3"},
    {Ink::kTouched, "--touched", "#c2311f", "#f0705d"},
    {Ink::kFree, "--free", "#2e7d4f", "#5dbd85"},
    {Ink::kCaution, "--caution", "#9a6412", "#dda94a"},
    {Ink::kContact, "--contact-band", "#f6cdbd", "#5a3026"},
}};

std::string Declarations(const char* NamedInk::*color) {
  std::string text;
  for (const NamedInk& ink : kInks) text += fmt::format("{}: {}; ", ink.name, ink.*color);
  return text;
}

}  // namespace

std::string ColorOf(Ink ink) {
  return fmt::format("var({})", std::ranges::find(kInks, ink, &NamedInk::ink)->name);
}

std::string LightInks() { return Declarations(&NamedInk::light); }
std::string DarkInks() { return Declarations(&NamedInk::dark); }

std::vector<std::pair<std::string, std::string>> InksOnPaper() {
  std::vector<std::pair<std::string, std::string>> inks;
  for (const NamedInk& ink : kInks) inks.emplace_back(ColorOf(ink.ink), ink.light);
  return inks;
}

std::string DepthColour(double fraction) {
  using Colour = std::array<double, 3>;
  constexpr std::array<Colour, 4> kStops = {{{253, 212, 158}, {252, 141, 89}, {215, 48, 31}, {115, 0, 0}}};
  const double position = std::clamp(fraction, 0.0, 1.0) * (kStops.size() - 1);
  const auto stop = std::min(static_cast<std::size_t>(position), kStops.size() - 2);
  const double share = position - static_cast<double>(stop);
  std::string colour = "#";
  for (std::size_t i = 0; i < 3; ++i) {
    const double level = kStops[stop][i] + share * (kStops[stop + 1][i] - kStops[stop][i]);
    colour += fmt::format("{:02x}", static_cast<int>(std::lround(level)));
  }
  return colour;
}

}  // namespace elbowroom::sessions
