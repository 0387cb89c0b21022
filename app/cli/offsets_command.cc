// elbowroom cameras offsets RIG.yml: how late each camera's clock is, without a board.
#include "app/cli/offsets_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/cli/options/value_json.h"
#include "app/control/cameras/time_offsets.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::cli {
namespace {

struct OffsetsOptions {
  std::filesystem::path rig_file;
  std::string by = "silhouettes";
  std::optional<double> seconds;
  std::filesystem::path out;
};

CommandResult Run(const OffsetsOptions& options, const CommandContext& context) {
  const recon::RigFile rig_file = recon::ReadRigFile(options.rig_file);
  const control::OffsetMethod method =
      options.by == "light" ? control::OffsetMethod::kLight : control::OffsetMethod::kSilhouettes;
  const control::TimeOffsets offsets =
      control::MeasureTimeOffsets(rig_file, {method, options.seconds}, context.progress, context.stop);
  CommandResult result;
  result.json = {{"by", options.by},
                 {"seconds", offsets.seconds},
                 {"edges", offsets.edges ? nlohmann::json(*offsets.edges) : nlohmann::json()},
                 {"rms_px", OrNull(offsets.rms_px)},
                 {"cameras", nlohmann::json::array()},
                 {"out", options.out.empty() ? nlohmann::json() : nlohmann::json(options.out.string())},
                 {"warnings", offsets.warnings}};
  constexpr double kMsPerS = 1e3;
  for (const control::CameraOffset& camera : offsets.cameras) {
    result.json["cameras"].push_back({{"name", camera.name},
                                      {"pictures", camera.pictures},
                                      {"change_s", camera.change_s},
                                      {"time_offset_s", camera.time_offset_s},
                                      {"time_offset_sigma_s", camera.sigma_s}});
    const bool is_first = &camera == offsets.cameras.data();
    result.text +=
        is_first ? fmt::format("{}: the others are held against it\n", camera.name)
                 : fmt::format("{}: {:+.2f} +- {:.2f} ms late; time_offset_s: {:.6f}\n", camera.name,
                               kMsPerS * camera.change_s, kMsPerS * camera.sigma_s, camera.time_offset_s);
  }
  for (const std::string& warning : offsets.warnings) result.text += "warning: " + warning + "\n";
  if (options.out.empty()) {
    result.text += "nothing was written; --out NEW.yml writes a rig with these offsets";
  } else {
    recon::WriteRigFile(offsets.rig_file, options.out);
    result.text += options.out.string();
  }
  return result;
}

}  // namespace

void AddOffsetsCommand(CLI::App& cameras, Choice* choice) {
  CLI::App* command = cameras.add_subcommand(
      "offsets", "how late each camera's stamps are, from hands that move or a light that blinks");
  auto options = std::make_shared<OffsetsOptions>();
  command->add_option("RIG", options->rig_file, "the rig (RIG.yml), live or with footage that has stamps")
      ->required();
  command
      ->add_option(
          "--by", options->by,
          "silhouettes: hands move in view of all cameras (default); light: a lamp blinks irregularly "
          "in view of all cameras")
      ->check(CLI::IsMember({"silhouettes", "light"}));
  constexpr double kShortestS = 5.0, kLongestS = 600.0;
  command
      ->add_option("--seconds", options->seconds,
                   "how long to look (default: 30 of live cameras, all of footage)")
      ->check(CLI::Range(kShortestS, kLongestS));
  command->add_option("--out", options->out, "the rig file to write, with the offsets");
  command->callback(
      [=] { choice->action = [options](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
