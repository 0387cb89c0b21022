// elbowroom head: what a head tracker gives, for setting up the participant's view without a window.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "app/cli/options/command.h"
#include "app/cli/options/value_json.h"
#include "app/control/head/head_report.h"
#include "app/control/head/head_settings.h"
#include "core/error.h"
#include "core/system/whole_file.h"
#include "core/units.h"
#include "recon/capture/rig_source.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::cli {
namespace {

using recon::HeadSource;

struct HeadOptions {
  std::filesystem::path head_file, cap_file, rig_file, write_cap;
  std::string source;
  int port = 0;  // 0: the file's, or the protocol's own
  double seconds = 10.0;
};

nlohmann::json PoseJson(const recon::HeadPose& pose) {
  const control::TrackerReading reading = control::ReadingOf(pose.world_from_head);
  return {{"position_mm", JsonOf(reading.position_mm)},
          {"yaw_deg", reading.yaw_deg},
          {"pitch_deg", reading.pitch_deg},
          {"roll_deg", reading.roll_deg}};
}

nlohmann::json ReportJson(const control::HeadReport& report, HeadSource source) {
  nlohmann::json json = {{"source", recon::ToString(source)},
                         {"seconds", report.seconds},
                         {"accepted", report.counts.accepted},
                         {"refused", report.counts.all_refused()},
                         {"refused_by_reason", nlohmann::json::object()},
                         {"poses_per_s", report.poses_per_s()},
                         {"spread_mm", OrNull(report.spread_mm)},
                         {"sigma_mm", OrNull(report.sigma_mm)},
                         {"sigma_deg", nullptr},
                         {"cameras", OrNull(report.cameras)},
                         {"not_seen", report.not_seen},
                         {"last", report.last ? PoseJson(*report.last) : nlohmann::json()}};
  if (report.headset)
    json["headset"] = {{"name", report.headset->name},
                       {"state", recon::ToString(report.headset->phase)},
                       {"why", report.headset->text}};
  if (report.sigma_rad) json["sigma_deg"] = core::DegreesFromRadians(*report.sigma_rad);
  for (std::size_t i = 0; i < control::kPoseFaults; ++i)
    if (report.counts.refused[i] > 0)
      json["refused_by_reason"][std::string(control::ToString(static_cast<control::PoseFault>(i)))] =
          report.counts.refused[i];
  return json;
}

std::string RefusedText(const control::HeadReport& report) {
  std::string text = fmt::format("{} refused", report.counts.all_refused());
  for (std::size_t i = 0; i < control::kPoseFaults; ++i)
    if (report.counts.refused[i] > 0)
      text += fmt::format(", {} {}", report.counts.refused[i],
                          control::ToString(static_cast<control::PoseFault>(i)));
  return text;
}

// "Monado 21.0.0, ...: focused"; empty for other sources.
std::string HeadsetText(const control::HeadReport& report) {
  if (!report.headset) return {};
  const control::HeadsetStatus& its = *report.headset;
  return fmt::format("{}{}{}{}", its.name, its.name.empty() ? "" : ": ", recon::ToString(its.phase),
                     its.text.empty() ? "" : "; " + its.text);
}

std::string LineOf(const control::HeadReport& report) {
  return fmt::format("{:.0f} s: {} poses, {}{}", report.seconds, report.counts.accepted, RefusedText(report),
                     report.last ? "; " + control::HeadText(report.last->world_from_head) : "");
}

std::string TextOf(const control::HeadReport& report) {
  std::string text = fmt::format("{} poses in {:.1f} s ({:.1f} a second); {}", report.counts.accepted,
                                 report.seconds, report.poses_per_s(), RefusedText(report));
  for (const auto& [why, count] : report.not_seen) text += fmt::format("\n  {}: {} times", why, count);
  if (report.headset) text += "\nheadset: " + HeadsetText(report);
  if (report.last) text += "\nlast: " + control::HeadText(report.last->world_from_head);
  if (report.spread_mm)
    text += fmt::format("\nspread of the eyes' place: {:.2f} mm (the noise, if the head held still)",
                        *report.spread_mm);
  if (report.sigma_mm)
    text += fmt::format(
        "\nmedian of what the markers say of themselves: {:.2f} mm, {:.2f} degrees, by {:.0f} cameras",
        *report.sigma_mm, core::DegreesFromRadians(*report.sigma_rad), *report.cameras);
  return text;
}

control::HeadSettings SettingsOf(const HeadOptions& options) {
  control::HeadSettings settings;
  if (!options.head_file.empty()) settings = control::ReadHeadFile(options.head_file);
  if (!options.source.empty()) settings.source = *control::ParseHeadSource(options.source);
  if (options.port > 0) settings.port = options.port;
  if (!options.cap_file.empty()) settings.cap = control::ReadCapFile(options.cap_file);
  return settings;
}

control::HeadReport Watch(const control::HeadSettings& settings, const HeadOptions& options,
                          const CommandContext& context) {
  const auto on_report = [&](const control::HeadReport& report) { context.tell(LineOf(report)); };
  if (settings.source == HeadSource::kCap) {
    if (options.rig_file.empty())
      throw core::Error(
          core::ErrorKind::kRange,
          "the cap is found in the pictures of calibrated cameras: say which with --rig RIG.yml");
    const auto source = recon::OpenRig(recon::ReadRigFile(options.rig_file), context.stop);
    return control::WatchCap(settings, *source, options.seconds, on_report, context.stop);
  }
  const auto on_port = [&](int port) {
    context.tell(fmt::format("listening to UDP port {} of {}", port, settings.address));
  };
  return control::WatchPackets(settings, options.seconds, on_port, on_report, context.stop);
}

std::string WhyNoPose(const control::HeadReport& report, const control::HeadSettings& settings) {
  if (settings.source == HeadSource::kCap) return "the cap was found in no picture";
  if (settings.source == HeadSource::kOpenXr)
    return fmt::format("no pose was accepted from the headset: {}", HeadsetText(report));
  return fmt::format(
      "no pose was accepted at UDP port {}: does the tracker send to this computer, and to that port?",
      settings.port_or_default());
}

CommandResult Run(const HeadOptions& options, const CommandContext& context) {
  if (!options.write_cap.empty()) {
    core::WriteWholeFile(options.write_cap, control::CapFileText(recon::EightSidedCap()));
    return {{{"cap", options.write_cap.string()}}, fmt::format("wrote {}", options.write_cap.string())};
  }
  const control::HeadSettings settings = SettingsOf(options);
  if (settings.source == HeadSource::kFixed)
    return {{{"source", "fixed"},
             {"last", PoseJson({settings.world_from_fixed_head, {}, HeadSource::kFixed, {}, {}})}},
            "no tracker: " + control::HeadText(settings.world_from_fixed_head)};
  const control::HeadReport report = Watch(settings, options, context);
  CommandResult result{ReportJson(report, settings.source), TextOf(report)};
  if (report.counts.accepted == 0) result.failure = WhyNoPose(report, settings);
  return result;
}

}  // namespace

void AddHeadCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand(
      "head", "what a head tracker gives: poses, how many a second, what was refused and why");
  auto options = std::make_shared<HeadOptions>();
  command->add_option("--file", options->head_file, "HEAD.toml: source, port, registration, cap")
      ->check(CLI::ExistingFile);
  command
      ->add_option("--source", options->source,
                   "fixed, opentrack, freed, cap or openxr (default: the file's, or fixed)")
      ->check(CLI::IsMember({"fixed", "opentrack", "freed", "cap", "openxr"}));
  command
      ->add_option("--port", options->port,
                   "UDP port (default: the file's, or 4242 for opentrack and 40000 for freed)")
      ->check(CLI::Range(1, 65535));
  command->add_option("--cap", options->cap_file, "CAP.toml (default: the file's, or the eight-sided cap)")
      ->check(CLI::ExistingFile);
  command->add_option("--rig", options->rig_file, "RIG.yml of the calibrated cameras that see the cap")
      ->check(CLI::ExistingFile);
  command->add_option("--seconds", options->seconds, "how long to watch, s (default: 10)")
      ->check(CLI::Range(0.1, 86'400.0));
  command->add_option("--write-cap", options->write_cap,
                      "write the eight-sided cap as a CAP.toml, and do nothing else");
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
