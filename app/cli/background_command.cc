// elbowroom background RIG.yml --out DIR: the empty scene, taken with the live cameras.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/cli/light_json.h"
#include "app/cli/options/command.h"
#include "app/control/cameras/background_taking.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::cli {
namespace {

// For somebody at the keyboard to leave the cameras' view.
constexpr double kCountdownS = 5.0;

struct BackgroundCommandOptions {
  std::filesystem::path rig_file;
  std::filesystem::path out;
  double seconds = 3.0;
  std::optional<double> countdown_s;
  bool anyway = false;
};

nlohmann::json BackgroundJson(const control::CameraBackground& camera) {
  nlohmann::json json = {{"name", camera.name},
                         {"frames", camera.frames},
                         {"mean_level", camera.scene.mean_level},
                         {"sigma_median_levels", camera.scene.sigma_median_levels},
                         {"suggested_k_sigma", nullptr},
                         {"suggested_floor_levels", nullptr},
                         {"flicker_hz", FlickerHz(camera.scene.pulse)},
                         {"flicker_share", nullptr},
                         {"light_steady", nullptr},
                         {"moved", !camera.scene.moved_px.empty()},
                         {"faults", camera.faults}};
  if (camera.scene.moved_px.empty()) json["light_steady"] = camera.scene.is_light_steady();
  if (camera.scene.pulse) json["flicker_share"] = camera.scene.pulse->amplitude_share;
  if (camera.suggested) {
    json["suggested_k_sigma"] = camera.suggested->k_sigma;
    json["suggested_floor_levels"] = camera.suggested->floor_levels;
  }
  return json;
}

std::string BackgroundText(const control::CameraBackground& camera) {
  std::string text = fmt::format("{}: {} pictures, level {:.0f}, noise {:.2f} levels", camera.name,
                                 camera.frames, camera.scene.mean_level, camera.scene.sigma_median_levels);
  if (camera.suggested) {
    text += fmt::format(
        "; k_sigma = {:.1f} and floor_levels = {:.1f} take one background pixel in a million for "
        "an object",
        camera.suggested->k_sigma, camera.suggested->floor_levels);
  }
  for (const std::string& fault : camera.faults) text += "\n  warning: " + fault;
  return text + "\n";
}

CommandResult Run(const BackgroundCommandOptions& options, const CommandContext& context) {
  const recon::RigFile rig_file = recon::ReadRigFile(options.rig_file, recon::RigUse::kPictures);
  control::BackgroundOptions background;
  background.seconds = options.seconds;
  background.countdown_s = options.countdown_s.value_or(::isatty(STDERR_FILENO) != 0 ? kCountdownS : 0.0);
  background.anyway = options.anyway;
  const control::BackgroundOutcome outcome =
      control::TakeBackground(rig_file, options.out, background, context.progress, context.stop);
  CommandResult result;
  result.json = {{"rig", outcome.rig_file.string()},
                 {"cameras", nlohmann::json::array()},
                 {"seconds", outcome.seconds},
                 {"bytes", outcome.bytes}};
  for (const control::CameraBackground& camera : outcome.cameras) {
    result.json["cameras"].push_back(BackgroundJson(camera));
    result.text += BackgroundText(camera);
  }
  constexpr double kBytesPerMb = 1e6;
  result.text += fmt::format("{}: {:.1f} MB of pictures", outcome.rig_file.string(),
                             static_cast<double>(outcome.bytes) / kBytesPerMb);
  return result;
}

}  // namespace

void AddBackgroundCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand(
      "background", "take the empty scene with the live cameras, and write a rig that uses it");
  auto options = std::make_shared<BackgroundCommandOptions>();
  command->add_option("RIG", options->rig_file, "the rig (RIG.yml) with live cameras")->required();
  command->add_option("--out", options->out, "folder for RIG.yml and the pictures; new or empty")->required();
  constexpr double kLongestS = 3600.0, kShortestS = 0.1;
  command->add_option("--seconds", options->seconds, "how long pictures are taken (default: 3)")
      ->check(CLI::Range(kShortestS, kLongestS));
  command
      ->add_option("--countdown", options->countdown_s,
                   "seconds to leave the cameras' view first (default: 5 on a terminal, else 0)")
      ->check(CLI::Range(0.0, kLongestS));
  command->add_flag("--anyway", options->anyway,
                    "take it also where something moves or the light isn't steady");
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
