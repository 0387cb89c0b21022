#include "app/control/gauge/gauge_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "app/control/gauge/gauge_pictures.h"
#include "sessions/report/html_page.h"
#include "sessions/report/html_table.h"
#include "sessions/report/markup.h"
#include "sessions/report/whole_files.h"

namespace elbowroom::control {
namespace {

using sessions::Escaped;
using sessions::HtmlTable;

std::string Header(const core::Rig& rig, const GaugeOutcome& outcome) {
  const std::string length =
      outcome.truth.length_mm ? fmt::format(", {:.6g} mm long", *outcome.truth.length_mm) : std::string();
  return fmt::format(
      "<header><p class='kicker'>Elbowroom gauge</p><h1>{}</h1><p class='facts'>a rod of {:.6g} mm{} "
      "&middot; "
      "{} places &middot; {} cameras</p></header>\n",
      Escaped(rig.name), outcome.truth.diameter_mm, length, outcome.places.size(), rig.cameras.size());
}

std::string Verdict(const GaugeOutcome& outcome) {
  const GaugePlace& worst = outcome.worst_place();
  std::size_t failed = 0;
  for (const GaugePlace& place : outcome.places)
    if (!place.passed()) ++failed;
  const std::string says =
      outcome.passed() ? std::string("The rig passes: at every place each figure is within its bound.")
                       : fmt::format("The rig doesn&rsquo;t pass: {} of {} places are at fault.", failed,
                                     outcome.places.size());
  return fmt::format(
      "<section><div class='verdict{}'><p>{}</p><p>The largest error of the diameter is {:+.3f} mm with a "
      "bound "
      "of {:.3f} mm, in frame {}.</p></div></section>\n",
      outcome.passed() ? "" : " broken", says, worst.error_mm, worst.rod.diameter.bound.total_mm(),
      worst.frame);
}

std::string Listed(const char* title, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string html = fmt::format("<section><h2>{}</h2><ul>", title);
  for (const std::string& line : lines) html += fmt::format("<li>{}</li>", Escaped(line));
  return html + "</ul></section>\n";
}

std::vector<std::string> FaultLines(const GaugeOutcome& outcome) {
  std::vector<std::string> lines = outcome.faults;
  for (const GaugePlace& place : outcome.places)
    for (const std::string& fault : place.faults)
      lines.push_back(fmt::format("frame {}: {}", place.frame, fault));
  constexpr std::size_t kMostLines = 40;
  if (lines.size() > kMostLines) {
    const std::size_t more = lines.size() - kMostLines;
    lines.resize(kMostLines);
    lines.push_back(fmt::format("and {} more", more));
  }
  return lines;
}

std::string OrDash(const std::optional<recon::BoundedMm>& value, int digits) {
  return value ? fmt::format("{:.{}f} &plusmn; {:.{}f}", value->value_mm, digits, value->bound.total_mm(),
                             digits)
               : std::string("-");
}

std::string PlaceTable(const GaugeOutcome& outcome) {
  HtmlTable table({{"frame", true},
                   {"at, mm", true},
                   {"diameter, mm", true},
                   {"error, mm", true},
                   {"bound: silhouettes", true},
                   {"distance", true},
                   {"calibration", true},
                   {"bow, mm", true},
                   {"length, mm", true},
                   {"passes"}});
  for (const GaugePlace& place : outcome.places) {
    const recon::GaugeBound& bound = place.rod.diameter.bound;
    const Eigen::Vector3d& at = place.rod.position_in_world;
    table.Add({fmt::format("{}", place.frame),
               fmt::format("{}, {}, {}", std::lround(at.x()), std::lround(at.y()), std::lround(at.z())),
               OrDash(place.rod.diameter, 3), fmt::format("{:+.3f}", place.error_mm),
               fmt::format("{:.3f}", bound.silhouettes_mm), fmt::format("{:.3f}", bound.distance_mm),
               fmt::format("{:.3f}", bound.calibration_mm), OrDash(place.rod.straightness, 2),
               OrDash(place.rod.length, 1), place.passed() ? "yes" : "no"});
  }
  return "<section><h2>Places</h2>" + table.Html() + "</section>\n";
}

std::string CameraTable(const GaugeOutcome& outcome) {
  HtmlTable table({{"camera"},
                   {"places measured", true},
                   {"largest error alone, mm", true},
                   {"beside the others &plusmn; bound, where worst, mm", true}});
  for (std::size_t c = 0; c < outcome.places.front().rod.cameras.size(); ++c) {
    int measured = 0;
    double error_mm = 0.0, share = 0.0;
    std::optional<recon::BoundedMm> offset;
    for (const GaugePlace& place : outcome.places) {
      const recon::CameraOfGauge& camera = place.rod.cameras[c];
      if (camera.diameter) {
        ++measured;
        const double own_mm = camera.diameter->value_mm - outcome.truth.diameter_mm;
        if (std::abs(own_mm) > std::abs(error_mm)) error_mm = own_mm;
      }
      if (!camera.offset || camera.sight != recon::RodSight::kMeasured) continue;
      const double of_bound = std::abs(camera.offset->value_mm) / camera.offset->bound.total_mm();
      if (of_bound > share) offset = camera.offset;
      share = std::max(share, of_bound);
    }
    table.Add({Escaped(outcome.places.front().rod.cameras[c].name), fmt::format("{}", measured),
               fmt::format("{:+.3f}", error_mm), OrDash(offset, 2)});
  }
  return "<section><h2>Cameras</h2>" + table.Html() + "</section>\n";
}

}  // namespace

std::filesystem::path WriteGaugePage(const core::Rig& rig, const GaugeOutcome& outcome,
                                     const std::filesystem::path& folder) {
  const std::string page = sessions::HtmlPage(
      Escaped(rig.name),
      Header(rig, outcome) + Verdict(outcome) + "<section><h2>Where the rod was</h2>" +
          PlacesPicture(rig, outcome) + "</section>\n<section><h2>Error of the diameter, mm</h2>" +
          ErrorsPicture(outcome) + "</section>\n" + Listed("What is wrong", FaultLines(outcome)) +
          Listed("Warnings", outcome.warnings) + CameraTable(outcome) + PlaceTable(outcome));
  sessions::WriteWholeFiles(folder, {{"gauge.html", page}});
  return folder / "gauge.html";
}

}  // namespace elbowroom::control
