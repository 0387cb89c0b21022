// elbowroom cameras list|check|record|offsets: which live cameras there are, how well those of a rig do, what
// they see, and how late each is.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "app/cli/light_json.h"
#include "app/cli/offsets_command.h"
#include "app/cli/options/command.h"
#include "app/cli/options/value_json.h"
#include "app/control/cameras/camera_check.h"
#include "app/control/cameras/camera_recording.h"
#include "app/control/preflight/preflight.h"
#include "app/control/preflight/preflight_page.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::cli {
namespace {

const char* NameOf(const std::optional<recon::StampSource>& source) {
  if (!source) return "none";
  switch (*source) {
    case recon::StampSource::kDevice:
      return "camera";
    case recon::StampSource::kDriver:
      return "driver";
    case recon::StampSource::kArrival:
      return "arrival";
  }
  return "";
}

nlohmann::json CameraJson(const control::CameraHealth& camera) {
  nlohmann::json losses = nlohmann::json::object();
  for (const auto& [reason, count] : camera.losses) losses[std::string(core::ToString(reason))] = count;
  const recon::DeviceReport& report = camera.state.report;
  return {{"name", camera.name},
          {"device", report.name},
          {"running", camera.state.presence == recon::CameraPresence::kRunning},
          {"frames", camera.frames},
          {"lost", camera.lost()},
          {"losses", losses},
          {"unpaired", camera.unpaired},
          {"rate_hz", OrNull(camera.rate_hz)},
          {"latency_ms", camera.latency_ms ? nlohmann::json(camera.latency_ms->median) : nlohmann::json()},
          {"latency", JsonOf(camera.latency_ms)},
          {"skew_ms", JsonOf(camera.skew_ms)},
          {"stamps", NameOf(camera.stamps)},
          {"exposure_us", OrNull(report.exposure_us)},
          {"gain_db", OrNull(report.gain_db)},
          {"white_balance_k", OrNull(report.white_balance_k)},
          {"mean_level", camera.mean_level},
          {"saturated_share", camera.saturated_share},
          {"sharpness", camera.sharpness},
          {"light", camera.light ? JsonOf(*camera.light) : nlohmann::json()},
          {"advice", camera.advice}};
}

std::string CameraText(const control::CameraHealth& camera) {
  std::string text = fmt::format("{}: {} pictures, {} lost", camera.name, camera.frames, camera.lost());
  if (camera.rate_hz) text += fmt::format(", {:.2f} Hz", *camera.rate_hz);
  if (camera.latency_ms)
    text += fmt::format(", {:.1f} ms from exposure to arrival", camera.latency_ms->median);
  if (camera.skew_ms)
    text += fmt::format(", skew {:.1f} ms (95 %: {:.1f})", camera.skew_ms->median, camera.skew_ms->p95);
  if (camera.state.report.exposure_us)
    text += fmt::format(", exposure {:.0f} us", *camera.state.report.exposure_us);
  if (camera.state.report.gain_db) text += fmt::format(", gain {:.1f} dB", *camera.state.report.gain_db);
  text += fmt::format(", level {:.0f}, sharpness {:.0f}", camera.mean_level, camera.sharpness);
  if (camera.light) {
    text += fmt::format(", light {:.0f} % of the background's", 100.0 * camera.light->gain);
    if (camera.light->pulse)
      text += fmt::format(", flickers by {:.1f} %", 100.0 * camera.light->pulse->amplitude_share);
  }
  text += "\n";
  if (camera.advice.empty()) return text + "  all is well\n";
  for (const std::string& line : camera.advice) text += "  " + line + "\n";
  return text;
}

struct CheckOptions {
  std::filesystem::path rig_file;
  double seconds = 5.0;
  std::filesystem::path out;
};

// The page says of the rig as a whole what can be known without its cameras, too.
std::string WritePage(const CheckOptions& options, const recon::RigFile& rig_file,
                      const control::RigHealth& health) {
  std::vector<control::PreflightRow> rows = control::CameraRows(health);
  std::ranges::move(control::RigRows(rig_file, options.out), std::back_inserter(rows));
  return control::WritePreflightPage(rig_file.rig.name, rows, health, options.out).string();
}

CommandResult Check(const CheckOptions& options, const CommandContext& context) {
  const recon::RigFile rig_file = recon::ReadRigFile(options.rig_file, recon::RigUse::kPictures);
  const control::RigHealth health =
      control::CheckCameras(rig_file, options.seconds, context.progress, context.stop);
  CommandResult result;
  result.json = {{"cameras", nlohmann::json::array()},
                 {"sets", health.sets},
                 {"incomplete_sets", health.incomplete_sets},
                 {"decision_ms", JsonOf(health.decision_ms)},
                 {"seconds", health.seconds},
                 {"warnings", health.warnings},
                 {"well", health.is_well()}};
  for (const control::CameraHealth& camera : health.cameras) {
    result.json["cameras"].push_back(CameraJson(camera));
    result.text += CameraText(camera);
  }
  for (const std::string& warning : health.warnings) result.text += "warning: " + warning + "\n";
  result.text += fmt::format("{} frame sets in {:.1f} s, {} of them lack a camera", health.sets,
                             health.seconds, health.incomplete_sets);
  result.json["out"] = nullptr;
  if (!options.out.empty()) {
    const std::string page = WritePage(options, rig_file, health);
    result.json["out"] = page;
    result.text += "\n" + page;
  }
  return result;
}

struct RecordOptions {
  std::filesystem::path rig_file;
  std::filesystem::path folder;
  std::optional<double> seconds;
};

nlohmann::json RecordingJson(const recon::CameraRecording& camera) {
  nlohmann::json missing = nlohmann::json::array();
  for (const recon::MissingPictures& pictures : camera.missing)
    missing.push_back({{"first", pictures.first}, {"last", pictures.last}, {"reason", pictures.reason}});
  return {{"name", camera.name},           {"frames", camera.frames},       {"lost", camera.lost},
          {"unwritten", camera.unwritten}, {"file", camera.video.string()}, {"missing", missing}};
}

std::string RecordingText(const recon::CameraRecording& camera) {
  std::string text = fmt::format("{}: {} pictures, {} lost, {} not written\n", camera.name, camera.frames,
                                 camera.lost, camera.unwritten);
  constexpr std::size_t kMostShown = 5;
  for (std::size_t i = 0; i < std::min(kMostShown, camera.missing.size()); ++i) {
    const recon::MissingPictures& pictures = camera.missing[i];
    text += pictures.count() == 1
                ? fmt::format("  picture {}: {}\n", pictures.first, pictures.reason)
                : fmt::format("  pictures {} to {}: {}\n", pictures.first, pictures.last, pictures.reason);
  }
  if (camera.missing.size() > kMostShown)
    text += fmt::format("  {} more in losses.csv\n", camera.missing.size() - kMostShown);
  return text;
}

CommandResult Record(const RecordOptions& options, const CommandContext& context) {
  const recon::RigFile rig_file = recon::ReadRigFile(options.rig_file, recon::RigUse::kPictures);
  const control::CamerasRecorded recorded =
      control::RecordCameras(rig_file, options.folder, options.seconds, context.progress, context.stop);
  const recon::FootageRecording& footage = recorded.footage;
  CommandResult result;
  result.json = {{"cameras", nlohmann::json::array()},
                 {"seconds", footage.seconds},
                 {"bytes", footage.bytes},
                 {"rig", footage.rig_file.string()},
                 {"ended_early", recorded.ended_early},
                 {"warnings", recorded.warnings}};
  for (const recon::CameraRecording& camera : footage.cameras) {
    result.json["cameras"].push_back(RecordingJson(camera));
    result.text += RecordingText(camera);
  }
  constexpr double kBytesPerMb = 1e6;
  result.text += fmt::format("{:.1f} s, {:.1f} MB; '{}' plays it", footage.seconds,
                             static_cast<double>(footage.bytes) / kBytesPerMb, footage.rig_file.string());
  for (const std::string& warning : recorded.warnings) result.text += "\nwarning: " + warning;
  if (recorded.ended_early) result.hint = recorded.warnings.front();
  return result;
}

struct ListOptions {
  std::vector<std::string> more;  // locations of cameras that can't be found
  std::filesystem::path out;
  std::vector<int> size_px = {640, 480};
  double rate_hz = 30.0;
};

CommandResult List(const ListOptions& options, const CommandContext& context) {
  CommandResult result;
  std::vector<std::string> cameras = control::ListCameras(context.stop);
  cameras.insert(cameras.end(), options.more.begin(), options.more.end());
  result.json = {{"cameras", cameras}, {"out", nullptr}};
  for (const std::string& camera : cameras) result.text += camera + "\n";
  if (!options.out.empty()) {
    recon::RigFile rig_file =
        control::UncalibratedRig(cameras, options.size_px[0], options.size_px[1], options.rate_hz);
    rig_file.rig.name = options.out.stem().string();
    recon::WriteRigFile(rig_file, options.out);
    result.json["out"] = options.out.string();
    result.text += options.out.string() + "\n";
  } else if (cameras.empty()) {
    result.text = "no camera was found\n";
    result.hint = "a stream (rtsp://...) can't be found; name its address in RIG.yml";
  }
  result.text.pop_back();
  return result;
}

}  // namespace

void AddCamerasCommand(CLI::App& app, Choice* choice) {
  CLI::App* cameras = app.add_subcommand("cameras", "live cameras");
  cameras->require_subcommand(1);
  CLI::App* list = cameras->add_subcommand("list", "what is plugged in or answers on the network");
  auto list_options = std::make_shared<ListOptions>();
  list->add_option(
      "--out", list_options->out,
      "a rig file of these cameras to write, for 'cameras check' and 'cameras record', until they "
      "are calibrated");
  constexpr int kMostPx = 65'535;
  list->add_option("--size", list_options->size_px, "their pictures' size in that file (default: 640x480)")
      ->delimiter('x')
      ->expected(2)
      ->check(CLI::Range(1, kMostPx));
  constexpr double kFastestHz = 1000.0;
  list->add_option("--rate", list_options->rate_hz, "their pictures a second in that file (default: 30)")
      ->check(CLI::Range(0.1, kFastestHz));
  list->add_option("--add", list_options->more,
                   "a camera that can't be found, as rtsp://...; may be given several times")
      ->take_all();
  list->callback([=] {
    choice->action = [list_options](const CommandContext& context) { return List(*list_options, context); };
  });

  CLI::App* check =
      cameras->add_subcommand("check", "rate, losses, skew, latency and picture of every camera");
  auto options = std::make_shared<CheckOptions>();
  check->add_option("RIG", options->rig_file, "the rig (RIG.yml) with live cameras")->required();
  constexpr double kLongestS = 3600.0;
  check->add_option("--seconds", options->seconds, "how long to look (default: 5)")
      ->check(CLI::Range(0.1, kLongestS));
  check->add_option("--out", options->out,
                    "a folder for preflight.html: every camera's picture, well or with what to do");
  check->callback([=] {
    choice->action = [options](const CommandContext& context) { return Check(*options, context); };
  });

  CLI::App* record = cameras->add_subcommand("record", "record footage as it comes, with its stamps");
  auto record_options = std::make_shared<RecordOptions>();
  record->add_option("RIG", record_options->rig_file, "the rig (RIG.yml) with live cameras")->required();
  record->add_option("--out", record_options->folder, "a new folder; its RIG.yml plays the footage")
      ->required();
  constexpr double kLongestRecordingS = 86400.0;
  record->add_option("--seconds", record_options->seconds, "how long to record (default: until Ctrl-C)")
      ->check(CLI::Range(0.1, kLongestRecordingS));
  record->callback([=] {
    choice->action = [record_options](const CommandContext& context) {
      return Record(*record_options, context);
    };
  });
  AddOffsetsCommand(*cameras, choice);
}

}  // namespace elbowroom::cli
