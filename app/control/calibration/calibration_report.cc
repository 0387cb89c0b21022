#include "app/control/calibration/calibration_report.h"

#include <fmt/format.h>

#include "app/control/calibration/calibration_pictures.h"
#include "core/units.h"
#include "sessions/report/html_page.h"
#include "sessions/report/html_table.h"
#include "sessions/report/markup.h"
#include "sessions/report/whole_files.h"
#include "sessions/tables/csv_text.h"

namespace elbowroom::control {
namespace {

using sessions::Escaped;
using sessions::HtmlTable;

std::string Header(const CalibrationFile& file, const CalibrationOutcome& outcome) {
  const std::string board = fmt::format("{} of {} x {}, {} mm", recon::ToString(file.board.kind),
                                        file.board.columns, file.board.rows, file.board.square_mm);
  return fmt::format(
      "<header><p class='kicker'>Elbowroom calibration report</p><h1>{}</h1><p class='facts'>{} cameras "
      "&middot; board: "
      "{} &middot; {} instants &middot; {} points</p></header>\n",
      Escaped(outcome.rig_file.rig.name), outcome.result.cameras.size(), Escaped(board),
      outcome.result.boards.size(), outcome.result.points);
}

std::string Summary(const CalibrationOutcome& outcome) {
  const auto& spread = outcome.uncertainty_mm;
  const std::string error =
      spread
          ? fmt::format(
                "A point in the workspace is known to &plusmn; {:.2f} mm (1&sigma;, median), {:.2f} mm for "
                "95&nbsp;% of the workspace",
                spread->median, spread->p95)
          : std::string("No part of the workspace is seen by two cameras");
  const std::string scale =
      outcome.scale_checked
          ? "The scale agrees with the known length."
          : "The scale isn&rsquo;t checked: a wrong square_mm shows in none of these figures.";
  return fmt::format(
      "<section><div class='verdict{}'><p>{}.</p><p>Two cameras or more see {:.0f}&nbsp;% of it. {}</p>"
      "</div></section>\n",
      outcome.scale_checked && outcome.warnings.empty() ? "" : " broken", error, 100.0 * outcome.seen_share,
      scale);
}

std::string Tile(const std::string& title, const std::string& value, const std::string& remark) {
  return fmt::format("<div><dt>{}</dt><dd>{}<small>{}</small></dd></div>", title, value, remark);
}

std::string Tiles(const CalibrationOutcome& outcome) {
  const recon::CalibrationResult& result = outcome.result;
  const auto or_none = [](const std::optional<double>& value, const char* unit) {
    return value ? fmt::format("{:.2f} {}", *value, unit) : std::string("-");
  };
  return "<section><dl class='tiles'>" +
         Tile("reprojection", fmt::format("{:.2f} px", result.rms_px), "RMS, in the fit") +
         Tile("kept out", or_none(result.held_out_rms_px, "px"), "RMS in views kept out of the fit") +
         Tile("rigidity", or_none(result.rigidity_rms_mm, "mm"),
              "RMS of the board&rsquo;s lengths, triangulated") +
         Tile("left out", fmt::format("{}", result.rejected_points), "points") + "</dl></section>\n";
}

std::string Listed(const std::string& title, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string html = fmt::format("<section><h2>{}</h2><ul>", title);
  for (const std::string& line : lines) html += fmt::format("<li>{}</li>", Escaped(line));
  return html + "</ul></section>\n";
}

std::string CameraTable(const CalibrationOutcome& outcome) {
  HtmlTable table({{"camera"},
                   {"lens"},
                   {"views", true},
                   {"left out", true},
                   {"RMS, px", true},
                   {"centre &plusmn;, mm", true},
                   {"rotation &plusmn;, deg", true},
                   {"late by, ms", true}});
  for (std::size_t i = 0; i < outcome.result.cameras.size(); ++i) {
    const recon::CalibratedCamera& camera = outcome.result.cameras[i];
    const int number = static_cast<int>(i);
    table.Add(
        {Escaped(camera.calibration.name), std::string(core::ToString(camera.calibration.distortion_model)),
         fmt::format("{}", camera.views_used), fmt::format("{}", camera.views_rejected),
         fmt::format("{:.3f}", camera.rms_px),
         fmt::format("{:.2f}", recon::CenterSigmaMm(outcome.result, number)),
         fmt::format("{:.3f}", core::DegreesFromRadians(recon::RotationSigmaRad(outcome.result, number))),
         camera.time_offset_sigma_s ? fmt::format("{:.1f} &plusmn; {:.1f}", 1e3 * camera.time_offset_s,
                                                  1e3 * *camera.time_offset_sigma_s)
                                    : std::string("-")});
  }
  return "<section><h2>Cameras</h2>" + table.Html() + "</section>\n";
}

std::string LengthTable(const CalibrationFile& file, const CalibrationOutcome& outcome) {
  if (outcome.lengths.empty()) return "";
  HtmlTable table(
      {{"known length"}, {"true, mm", true}, {"measured, mm", true}, {"&plusmn;, mm", true}, {"says"}});
  for (std::size_t i = 0; i < outcome.lengths.size(); ++i) {
    const recon::LengthCheck& check = outcome.lengths[i];
    table.Add({Escaped(file.lengths[i].title), fmt::format("{:.1f}", file.lengths[i].length_mm),
               fmt::format("{:.1f}", check.measured_mm), fmt::format("{:.1f}", check.sigma_mm),
               Escaped(check.message)});
  }
  return "<section><h2>Known lengths</h2>" + table.Html() + "</section>\n";
}

std::string MapSection(const CalibrationOutcome& outcome) {
  return "<section><h2>Error over the workspace</h2><p class='lead'>How far a point, found by all cameras "
         "that see it, is off "
         "by the calibration and by the noise in the pictures: one standard deviation, in mm. Seen from "
         "above.</p>" +
         UncertaintyPicture(outcome) + "</section>\n";
}

std::string ResidualSection(const CalibrationOutcome& outcome) {
  std::string html =
      "<section><h2>Residuals</h2><p class='lead'>From where a point was seen to where the calibrated camera "
      "expects it. "
      "Lines that all point one way in a part of the picture tell that the lens model doesn&rsquo;t fit "
      "there; empty parts "
      "have no say.</p>";
  for (std::size_t i = 0; i < outcome.result.cameras.size(); ++i)
    html += fmt::format("<h3>{}</h3>", Escaped(outcome.result.cameras[i].calibration.name)) +
            ResidualPicture(outcome, static_cast<int>(i));
  return html + "</section>\n";
}

std::string RejectedSection(const CalibrationOutcome& outcome) {
  HtmlTable table({{"camera"}, {"view"}, {"left out because"}, {"RMS, px", true}});
  for (std::size_t i = 0; i < outcome.input.views.size(); ++i) {
    const recon::CalibrationView& view = outcome.input.views[i];
    const recon::ViewOutcome& found = outcome.result.views[i];
    if (found.is_used) continue;
    table.Add({Escaped(outcome.input.cameras[static_cast<std::size_t>(view.camera)].name),
               Escaped(view.label), Escaped(found.reason), fmt::format("{:.2f}", found.rms_px)});
  }
  if (table.empty()) return "";
  return "<section><h2>Views left out</h2>" + table.Html() + "</section>\n";
}

std::string ResidualsCsv(const CalibrationOutcome& outcome) {
  std::string csv = "camera,view,point,x_px,y_px,residual_x_px,residual_y_px,used\n";
  for (std::size_t i = 0; i < outcome.input.views.size(); ++i) {
    const recon::CalibrationView& view = outcome.input.views[i];
    const recon::ViewOutcome& found = outcome.result.views[i];
    for (const recon::PointResidual& point : found.residuals) {
      csv +=
          fmt::format("{},{},{},{:.3f},{:.3f},{:.4f},{:.4f},{}\n",
                      sessions::Quoted(outcome.input.cameras[static_cast<std::size_t>(view.camera)].name),
                      sessions::Quoted(view.label), point.point, point.pixel.x(), point.pixel.y(),
                      point.residual_px.x(), point.residual_px.y(), found.is_used && point.is_used ? 1 : 0);
    }
  }
  return csv;
}

}  // namespace

std::vector<std::filesystem::path> WriteCalibrationReport(const CalibrationFile& file,
                                                          const CalibrationOutcome& outcome,
                                                          const std::filesystem::path& folder) {
  const std::string page = sessions::HtmlPage(
      Escaped(outcome.rig_file.rig.name),
      Header(file, outcome) + Summary(outcome) + Tiles(outcome) + Listed("Warnings", outcome.warnings) +
          Listed("What to do next", outcome.advice) + CameraTable(outcome) + LengthTable(file, outcome) +
          MapSection(outcome) + ResidualSection(outcome) + RejectedSection(outcome));
  sessions::WriteWholeFiles(folder, {{"report.html", page}, {"residuals.csv", ResidualsCsv(outcome)}});
  return {folder / "report.html", folder / "residuals.csv"};
}

}  // namespace elbowroom::control
