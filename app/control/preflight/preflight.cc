#include "app/control/preflight/preflight.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <system_error>

#include "app/control/preflight/background_age.h"
#include "core/system/utc_time.h"
#include "recon/calibration/rig_uncertainty.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;

// The light of a room changes in the course of a day.
constexpr double kFreshBackgroundH = 12.0;
// Tripods and screws settle.
constexpr double kFreshCalibrationDays = 30.0;
constexpr double kBytesPerGb = 1e9;
constexpr double kLeastGb = 1.0, kEnoughGb = 10.0;
constexpr double kMostIncompleteShare = 0.01;

std::string AgeText(double hours) {
  if (hours < 1.0) return fmt::format("{:.0f} min", 60.0 * hours);
  return hours < 48.0 ? fmt::format("{:.0f} h", hours) : fmt::format("{:.0f} days", hours / 24.0);
}

PreflightRow BackgroundRow(const recon::RigFile& rig_file) {
  PreflightRow row{"Background", PreflightState::kWell, "", {}};
  const BackgroundFiles files = FindBackgroundFiles(rig_file);
  if (!files.lacking_camera.empty()) {
    row.state = PreflightState::kFault;
    row.finding = fmt::format("camera '{}' has none", files.lacking_camera);
    row.advice = {"Clear the table and take the background"};
    return row;
  }
  if (!files.written_at) {
    row.finding = "not needed: the cameras bring ready silhouettes";
    return row;
  }
  const std::chrono::duration<double, std::ratio<3600>> age =
      fs::file_time_type::clock::now() - *files.written_at;
  row.finding = fmt::format("taken {} ago", AgeText(std::max(0.0, age.count())));
  if (age.count() > kFreshBackgroundH) {
    row.state = PreflightState::kAttention;
    row.advice = {"Take the background again if the light or anything on the table has changed since"};
  }
  return row;
}

PreflightRow CalibrationRow(const recon::RigFile& rig_file) {
  PreflightRow row{"Calibration", PreflightState::kWell, "", {}};
  if (rig_file.gauge && !rig_file.gauge->passed) {
    row.state = PreflightState::kFault;
    row.finding = fmt::format("the gauge failed: {:.2f} mm off, {:.2f} mm is the bound",
                              rig_file.gauge->error_mm, rig_file.gauge->bound_mm);
    row.advice = {"Calibrate the rig again, and gauge it: until then no part will be near or clear"};
    return row;
  }
  if (!rig_file.is_calibrated) {
    row.state = PreflightState::kFault;
    row.finding = "the cameras aren't calibrated yet";
    row.advice = {"Record the board with 'cameras record', and calibrate"};
    return row;
  }
  if (!rig_file.calibration) {
    row.state = PreflightState::kAttention;
    row.finding = "RIG.yml says nothing of its age and its errors";
    row.advice = {"Calibrate the rig with elbowroom, or let the trial say uncertainty_mm"};
    return row;
  }
  const auto days = DaysSince(rig_file.calibration->made, core::NowUtc());
  row.finding = days ? fmt::format("made {} ago", AgeText(24.0 * *days)) : "made at an unknown time";
  if (const auto errors_mm = PointErrorsMm(rig_file))
    row.finding += fmt::format("; a point is known to ± {:.2f} mm (median)", errors_mm->median);
  if (rig_file.gauge) row.finding += "; gauge passed";
  if (!days || *days > kFreshCalibrationDays) {
    row.state = PreflightState::kAttention;
    row.advice = {"Gauge the rig, or calibrate it again: cameras move a little in a month"};
  }
  return row;
}

PreflightRow DiskRow(const fs::path& session_folder) {
  PreflightRow row{"Disk", PreflightState::kWell, "", {}};
  std::error_code failure;
  fs::path folder = fs::absolute(session_folder, failure);
  while (!fs::exists(folder, failure) && folder.has_relative_path()) folder = folder.parent_path();
  const fs::space_info space = fs::space(folder, failure);
  if (failure) {
    row.state = PreflightState::kFault;
    row.finding = fmt::format("{}: {}", folder.string(), failure.message());
    row.advice = {"Choose another folder for the session"};
    return row;
  }
  const double free_gb = static_cast<double>(space.available) / kBytesPerGb;
  row.finding = fmt::format("{:.{}f} GB free in {}", free_gb, free_gb < kEnoughGb ? 1 : 0, folder.string());
  if (free_gb >= kEnoughGb) return row;
  row.state = free_gb < kLeastGb ? PreflightState::kFault : PreflightState::kAttention;
  row.advice = {"Make room on the disk, or record the session elsewhere"};
  return row;
}

std::string FindingOf(const CameraHealth& camera) {
  std::string text = camera.rate_hz ? fmt::format("{:.1f} Hz", *camera.rate_hz) : std::string("no rate yet");
  text += fmt::format(", {} lost", camera.lost());
  if (camera.latency_ms) text += fmt::format(", {:.0f} ms late", camera.latency_ms->median);
  if (camera.skew_ms) text += fmt::format(", skew {:.1f} ms", camera.skew_ms->median);
  if (camera.light) text += fmt::format(", light {:.0f} %", 100.0 * camera.light->gain);
  return text;
}

PreflightRow RowOf(const CameraHealth& camera) {
  PreflightRow row{camera.name, PreflightState::kWell, FindingOf(camera), camera.advice};
  if (!row.advice.empty()) row.state = PreflightState::kAttention;
  if (camera.frames == 0 || camera.state.presence == recon::CameraPresence::kGone)
    row.state = PreflightState::kFault;
  if (camera.frames == 0) row.finding = "no picture came";
  if (row.state == PreflightState::kFault && row.advice.empty())
    row.advice = {"Check its cable and its power"};
  return row;
}

PreflightRow FramesRow(const RigHealth& health) {
  PreflightRow row{"Frames", PreflightState::kWell,
                   fmt::format("{} of {} have the pictures of all cameras",
                               health.sets - health.incomplete_sets, health.sets),
                   health.warnings};
  if (static_cast<double>(health.incomplete_sets) > kMostIncompleteShare * static_cast<double>(health.sets))
    row.advice.emplace_back("See to the cameras above: what only some of them see is undecided");
  if (!row.advice.empty()) row.state = PreflightState::kAttention;
  if (health.sets == 0) row.state = PreflightState::kFault;
  return row;
}

}  // namespace

std::optional<core::Spread> PointErrorsMm(const recon::RigFile& rig_file) {
  if (!rig_file.calibration || rig_file.calibration->covariance.size() == 0 ||
      !(rig_file.calibration->noise_px > 0.0))
    return std::nullopt;
  // A median needs no fine grid.
  constexpr double kMostNodes = 2000.0;
  const recon::RigUncertainty uncertainty(rig_file.rig.cameras, rig_file.calibration->covariance,
                                          rig_file.calibration->noise_px);
  const Eigen::AlignedBox3d& box_mm = rig_file.rig.workspace_mm;
  const recon::UncertaintyMap map =
      recon::MapUncertainty(uncertainty, box_mm, recon::MapEdgeMm(box_mm, recon::kMapEdgeMm, kMostNodes));
  std::vector<double> sigmas_mm;
  for (const auto& node : map.values)
    if (node.is_known) sigmas_mm.push_back(static_cast<double>(node.sigma_mm));
  return core::SpreadOf(std::move(sigmas_mm));
}

std::optional<double> DaysSince(const std::string& made_utc, const std::string& now_utc) {
  const auto parse = [](const std::string& text) -> std::optional<std::chrono::sys_seconds> {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
    if (std::sscanf(text.c_str(), "%d-%d-%dT%d:%d:%dZ", &year, &month, &day, &hour, &minute, &second) != 6)
      return std::nullopt;
    const std::chrono::year_month_day date{std::chrono::year(year),
                                           std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (!date.ok()) return std::nullopt;
    return std::chrono::sys_days(date) + std::chrono::hours(hour) + std::chrono::minutes(minute) +
           std::chrono::seconds(second);
  };
  const auto made = parse(made_utc), now = parse(now_utc);
  if (!made || !now) return std::nullopt;
  return std::chrono::duration<double, std::ratio<86400>>(*now - *made).count();
}

std::vector<PreflightRow> RigRows(const recon::RigFile& rig_file, const fs::path& session_folder) {
  return {BackgroundRow(rig_file), CalibrationRow(rig_file), DiskRow(session_folder)};
}

std::vector<PreflightRow> CameraRows(const RigHealth& health) {
  std::vector<PreflightRow> rows;
  for (const CameraHealth& camera : health.cameras) rows.push_back(RowOf(camera));
  rows.push_back(FramesRow(health));
  return rows;
}

}  // namespace elbowroom::control
