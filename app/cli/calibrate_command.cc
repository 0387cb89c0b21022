// elbowroom calibrate CALIB.toml --out RIG.yml: from pictures of a board to a rig whose error is known.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/options/command.h"
#include "app/cli/options/value_json.h"
#include "app/control/calibration/calibration_job.h"
#include "app/control/calibration/calibration_report.h"
#include "core/units.h"

namespace elbowroom::cli {
namespace {

struct CalibrateOptions {
  std::filesystem::path calibration;
  std::filesystem::path out;
  std::filesystem::path report;  // empty: none
};

nlohmann::json RowsOf(const Eigen::Matrix3d& matrix) {
  nlohmann::json rows = nlohmann::json::array();
  for (int i = 0; i < 3; ++i) rows.push_back(JsonOf(Eigen::Vector3d(matrix.row(i).transpose())));
  return rows;
}

nlohmann::json CameraJson(const control::CalibrationOutcome& outcome, int number) {
  const auto at = static_cast<std::size_t>(number);
  const recon::CalibratedCamera& camera = outcome.result.cameras[at];
  const core::CameraModel& model = outcome.rig_file.rig.cameras[at];
  return {{"name", model.name()},
          {"distortion_model", core::ToString(camera.calibration.distortion_model)},
          {"views", camera.views_used},
          {"rejected_views", camera.views_rejected},
          {"rms_px", camera.rms_px},
          {"center_mm", JsonOf(model.center_in_world())},
          {"center_sigma_mm", recon::CenterSigmaMm(outcome.result, number)},
          {"center_covariance_mm2", RowsOf(recon::CenterCovariance(outcome.result, number))},
          {"rotation_sigma_deg", core::DegreesFromRadians(recon::RotationSigmaRad(outcome.result, number))},
          {"time_offset_s", camera.time_offset_s},
          {"time_offset_sigma_s", OrNull(camera.time_offset_sigma_s)}};
}

nlohmann::json RejectedJson(const control::CalibrationOutcome& outcome) {
  nlohmann::json rejected = nlohmann::json::array();
  for (std::size_t i = 0; i < outcome.input.views.size(); ++i) {
    const recon::CalibrationView& view = outcome.input.views[i];
    if (outcome.result.views[i].is_used) continue;
    rejected.push_back({{"camera", outcome.input.cameras[static_cast<std::size_t>(view.camera)].name},
                        {"view", view.label},
                        {"reason", outcome.result.views[i].reason}});
  }
  return rejected;
}

nlohmann::json LengthsJson(const control::CalibrationFile& file, const control::CalibrationOutcome& outcome) {
  nlohmann::json lengths = nlohmann::json::array();
  for (std::size_t i = 0; i < outcome.lengths.size(); ++i) {
    lengths.push_back({{"length", file.lengths[i].title},
                       {"true_mm", file.lengths[i].length_mm},
                       {"measured_mm", outcome.lengths[i].measured_mm},
                       {"sigma_mm", outcome.lengths[i].sigma_mm},
                       {"agrees", outcome.lengths[i].verdict == recon::LengthVerdict::kAgrees}});
  }
  return lengths;
}

nlohmann::json OutcomeJson(const control::CalibrationFile& file, const control::CalibrationOutcome& outcome) {
  const recon::CalibrationResult& result = outcome.result;
  nlohmann::json json = {{"cameras", nlohmann::json::array()},
                         {"rms_px", result.rms_px},
                         {"held_out_rms_px", OrNull(result.held_out_rms_px)},
                         {"cross_camera_rms_px", OrNull(result.cross_camera_rms_px)},
                         {"rigidity_rms_mm", OrNull(result.rigidity_rms_mm)},
                         {"uncertainty_scale", result.uncertainty_scale},
                         {"scale_checked", outcome.scale_checked},
                         {"known_lengths", LengthsJson(file, outcome)},
                         {"uncertainty_mm", nullptr},
                         {"seen_share", outcome.seen_share},
                         {"noise_px", result.noise_px},
                         {"flatness_mm", result.flatness.is_found ? nlohmann::json(result.flatness.largest_mm)
                                                                  : nlohmann::json()},
                         {"frames", outcome.footage.sets.size()},
                         {"sets", result.boards.size()},
                         {"points", result.points},
                         {"rejected_points", result.rejected_points},
                         {"rejected_views", RejectedJson(outcome)},
                         {"warnings", outcome.warnings},
                         {"advice", outcome.advice},
                         {"time_ms", outcome.time_ms}};
  if (const auto& spread = outcome.uncertainty_mm)
    json["uncertainty_mm"] = {{"median", spread->median}, {"p95", spread->p95}, {"max", spread->max}};
  for (std::size_t i = 0; i < result.cameras.size(); ++i)
    json["cameras"].push_back(CameraJson(outcome, static_cast<int>(i)));
  return json;
}

std::string CameraText(const control::CalibrationOutcome& outcome, int number) {
  const recon::CalibratedCamera& camera = outcome.result.cameras[static_cast<std::size_t>(number)];
  std::string text = fmt::format("{}: {}, {} views", camera.calibration.name,
                                 core::ToString(camera.calibration.distortion_model), camera.views_used);
  if (camera.views_rejected > 0) text += fmt::format(" ({} left out)", camera.views_rejected);
  text += fmt::format(", {:.2f} px, centre +- {:.2f} mm, rotation +- {:.3f} deg", camera.rms_px,
                      recon::CenterSigmaMm(outcome.result, number),
                      core::DegreesFromRadians(recon::RotationSigmaRad(outcome.result, number)));
  if (camera.time_offset_sigma_s)
    text += fmt::format(", {:.1f} +- {:.1f} ms late", 1e3 * camera.time_offset_s,
                        1e3 * *camera.time_offset_sigma_s);
  return text + "\n";
}

std::string TextOf(const control::CalibrationOutcome& outcome) {
  const recon::CalibrationResult& result = outcome.result;
  std::string text;
  for (std::size_t i = 0; i < result.cameras.size(); ++i) text += CameraText(outcome, static_cast<int>(i));
  text += fmt::format("reprojection: {:.3f} px", result.rms_px);
  if (result.held_out_rms_px)
    text += fmt::format(", {:.3f} px in views kept out of the fit", *result.held_out_rms_px);
  text += "\n";
  if (result.rigidity_rms_mm)
    text += fmt::format("the board's lengths, triangulated: {:.2f} mm RMS\n", *result.rigidity_rms_mm);
  if (const auto& spread = outcome.uncertainty_mm) {
    text += fmt::format(
        "a point in the workspace: +- {:.2f} mm (1 sigma, median), {:.2f} mm for 95 %, {:.2f} mm at worst; "
        "two cameras or more see {:.0f} % of it\n",
        spread->median, spread->p95, spread->max, 100.0 * outcome.seen_share);
  }
  text += outcome.scale_checked
              ? "the scale agrees with the known length\n"
              : "the scale isn't checked: a wrong square_mm doesn't show in these figures\n";
  for (const std::string& warning : outcome.warnings) text += "warning: " + warning + "\n";
  for (const std::string& advice : outcome.advice) text += "advice: " + advice + "\n";
  return text;
}

CommandResult Run(const CalibrateOptions& options, const CommandContext& context) {
  const control::CalibrationFile file = control::ReadCalibrationFile(options.calibration);
  const control::CalibrationOutcome outcome =
      control::CalibrateRig(file, options.out.stem().string(), context.progress, context.stop);
  recon::WriteRigFile(outcome.rig_file, options.out);
  CommandResult result;
  result.json = OutcomeJson(file, outcome);
  result.json["out"] = options.out.string();
  result.text = TextOf(outcome) + options.out.string();
  if (options.report.empty()) return result;
  for (const auto& written : control::WriteCalibrationReport(file, outcome, options.report)) {
    result.json["report"].push_back(written.string());
    result.text += "\n" + written.string();
  }
  return result;
}

}  // namespace

void AddCalibrateCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand(
      "calibrate", "pictures of a board: cameras, poses, and the error in mm over the workspace");
  auto options = std::make_shared<CalibrateOptions>();
  command->add_option("CALIBRATION", options->calibration, "the board and the cameras' pictures (CALIB.toml)")
      ->required();
  command->add_option("--out", options->out, "the rig file to write (RIG.yml)")->required();
  command->add_option("--report", options->report,
                      "folder for report.html and residuals.csv; made if needed");
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
