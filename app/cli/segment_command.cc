// elbowroom segment RIG.yml --frame N --out DIR: the silhouettes as pictures.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/options/command.h"
#include "app/cli/rig_frame.h"
#include "core/system/file_sync.h"
#include "recon/images/mask_image.h"

namespace elbowroom::cli {
namespace {

struct SegmentOptions {
  RigFrameOptions frame;
  std::filesystem::path out;
};

CommandResult Run(const SegmentOptions& options, const CommandContext& context) {
  const RigFrame frame = LoadRigFrame(options.frame, context);
  core::MakeFolder(options.out);
  CommandResult result;
  result.json["masks"] = nlohmann::json::array();
  for (std::size_t i = 0; i < frame.masks.size(); ++i) {
    const std::string& camera = frame.rig->cameras[i].name();
    const std::filesystem::path file =
        options.out / fmt::format("{}_{:04d}.png", camera, options.frame.frame);
    const core::BitMask& mask = frame.masks[i].mask;
    recon::WriteMaskPng(mask, file);
    const std::size_t object_pixels = mask.CountObjectPixels();
    result.json["masks"].push_back(
        {{"camera", camera}, {"file", file.string()}, {"object_pixels", object_pixels}});
    result.text += fmt::format("{}{}: {} object pixels", i == 0 ? "" : "\n", file.string(), object_pixels);
  }
  return result;
}

}  // namespace

void AddSegmentCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand("segment", "write the silhouettes of one frame as PNG");
  auto options = std::make_shared<SegmentOptions>();
  AddRigFrameOptions(*command, &options->frame);
  command->add_option("--out", options->out, "folder for the masks; made if it isn't there")->required();
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
