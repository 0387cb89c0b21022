#include "app/control/keep_out/keep_out_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "cad_import/mesh_file.h"
#include "cad_import/model/vertex_field.h"
#include "sessions/report/chart.h"

namespace elbowroom::control {
namespace {

constexpr std::size_t kShades = 256;

// The report's colours, "#rrggbb", as shares.
std::array<cad_import::ColorRgb, kShades> Shades() {
  std::array<cad_import::ColorRgb, kShades> shades;
  for (std::size_t i = 0; i < kShades; ++i) {
    const std::string hex = sessions::DepthColour(static_cast<double>(i) / (kShades - 1));
    for (std::size_t channel = 0; channel < 3; ++channel) {
      int value = 0;
      const char* digits = hex.data() + 1 + 2 * channel;
      std::from_chars(digits, digits + 2, value, 16);
      shades[i][channel] = static_cast<float>(value) / 255.0F;
    }
  }
  return shades;
}

std::string ErrorText(double bound_mm) {
  return std::isfinite(bound_mm) ? fmt::format("contains every hull; beyond by at most {:.4g} mm", bound_mm)
                                 : "contains every hull; beyond unbounded: a camera is in the workspace";
}

cad_import::VertexField FieldOf(const KeepOutRequest& request, const KeepOut& keep_out) {
  cad_import::VertexField field{"dwell_s", keep_out.swept.dwell_s, {}, {}};
  const auto shades = Shades();
  const double longest_s = std::max(*std::ranges::max_element(field.values), 1e-9);
  for (const double seconds : field.values)
    field.colors.push_back(shades[static_cast<std::size_t>(
        std::lround(std::sqrt(seconds / longest_s) * static_cast<double>(kShades - 1)))]);
  field.notes = {{"error", ErrorText(keep_out.bound_mm)},
                 {"edge_mm", fmt::format("{:.6g}", request.edge_mm)},
                 {"frames", std::to_string(keep_out.frames)}};
  if (request.tool) field.notes.emplace_back("tool", *request.tool);
  for (const auto& session : request.sessions)
    field.notes.emplace_back("session", session.filename().string());
  return field;
}

}  // namespace

void WriteKeepOut(const KeepOutRequest& request, const KeepOut& keep_out, const std::filesystem::path& file) {
  cad_import::WriteFieldFile(keep_out.swept.mesh, FieldOf(request, keep_out), file);
}

}  // namespace elbowroom::control
