// elbowroom rig import FILE… --out RIG.yml: a rig that another program calibrated, checked by a board.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options/command.h"
#include "app/cli/options/unit_option.h"
#include "app/cli/options/value_json.h"
#include "app/control/calibration/calibration_file.h"
#include "app/control/calibration/rig_import.h"

namespace elbowroom::cli {
namespace {

using recon::RigConvention;

struct RigImportArguments {
  control::RigImportOptions import;
  std::filesystem::path out;
  std::filesystem::path check;  // empty: none
};

std::string_view PoseText(RigConvention::Pose pose) {
  return pose == RigConvention::Pose::kCamFromWorld ? "cam_from_world" : "world_from_cam";
}
std::string_view AxesText(RigConvention::Axes axes) {
  return axes == RigConvention::Axes::kOpenCv ? "opencv" : "opengl";
}

nlohmann::json RigImportJson(const control::RigImport& import) {
  const control::FoundConvention& found = import.found;
  nlohmann::json json = {
      {"format", ToString(import.format)},
      {"pose", PoseText(found.convention.pose)},
      {"axes", AxesText(found.convention.axes)},
      {"unit", found.unit ? nlohmann::json(core::ToString(*found.unit)) : nlohmann::json()},
      {"unit_mm", found.unit_mm},
      {"checked", found.check.has_value()},
      {"error_px", nullptr},
      {"scale_of_board", nullptr},
      {"tried", nlohmann::json::array()},
      {"cameras", nlohmann::json::array()},
      {"warnings", import.warnings}};
  if (found.check) {
    json["error_px"] = found.check->error_px;
    json["scale_of_board"] = found.check->scale;
  }
  for (const control::TriedConvention& tried : found.tried) {
    json["tried"].push_back(
        {{"pose", PoseText(tried.convention.pose)},
         {"axes", AxesText(tried.convention.axes)},
         {"error_px", tried.check ? nlohmann::json(tried.check->error_px) : nlohmann::json()}});
  }
  const std::vector<core::CameraModel>& cameras = import.rig_file.rig.cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    json["cameras"].push_back(
        {{"name", cameras[i].name()},
         {"distortion_model", core::ToString(cameras[i].calibration().distortion_model)},
         {"center_mm", JsonOf(cameras[i].center_in_world())},
         {"error_px", found.check ? OrNull(found.check->camera_error_px[i]) : nlohmann::json()}});
  }
  return json;
}

std::string RigImportText(const control::RigImport& import) {
  const control::FoundConvention& found = import.found;
  std::string text = fmt::format("{}: {} cameras, poses {}, lengths in {}\n", ToString(import.format),
                                 import.rig_file.rig.cameras.size(), ToString(found.convention),
                                 found.unit ? std::string(core::ToString(*found.unit))
                                            : fmt::format("units of {:.4g} mm", found.unit_mm));
  for (std::size_t i = 0; i < import.rig_file.rig.cameras.size(); ++i) {
    const core::CameraModel& camera = import.rig_file.rig.cameras[i];
    const Eigen::Vector3d& center = camera.center_in_world();
    text += fmt::format("{}: {}, centre {:.1f} {:.1f} {:.1f} mm", camera.name(),
                        core::ToString(camera.calibration().distortion_model), center.x(), center.y(),
                        center.z());
    if (found.check && found.check->camera_error_px[i])
      text += fmt::format(", {:.2f} px", *found.check->camera_error_px[i]);
    text += "\n";
  }
  if (found.check)
    text += fmt::format(
        "the board: {:.2f} px, the median of {} views; by its squares the rig should be {:.4f} times as "
        "large\n",
        found.check->error_px, found.check->views, found.check->scale);
  for (const control::TriedConvention& tried : found.tried) {
    if (tried.convention == found.convention) continue;
    text +=
        fmt::format("tried and refuted: {}, {}\n", ToString(tried.convention),
                    tried.check ? fmt::format("{:.1f} px", tried.check->error_px) : std::string("no fit"));
  }
  for (const std::string& warning : import.warnings) text += "warning: " + warning + "\n";
  return text;
}

CommandResult ImportOneRig(const RigImportArguments& arguments, const CommandContext& context) {
  const std::string name = arguments.out.stem().string();
  const control::RigImport import =
      arguments.check.empty()
          ? control::ImportRig(arguments.import, name)
          : control::ImportCheckedRig(arguments.import, control::ReadCalibrationFile(arguments.check), name,
                                      context.progress, context.stop);
  recon::WriteRigFile(import.rig_file, arguments.out);
  CommandResult result;
  result.json = RigImportJson(import);
  result.json["out"] = arguments.out.string();
  result.text = RigImportText(import) + arguments.out.string();
  return result;
}

Eigen::Vector3d AxisOf(const std::string& text) {
  const double sign = text.starts_with('-') ? -1.0 : 1.0;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  axis[text.back() - 'x'] = sign;
  return axis;
}

// What a file doesn't say, or says otherwise than documented.
void AddStatedOptions(CLI::App* command, control::RigImportOptions* import) {
  command
      ->add_option_function<std::string>(
          "--pose",
          [import](const std::string& text) {
            import->stated.pose = text == "cam_from_world" ? RigConvention::Pose::kCamFromWorld
                                                           : RigConvention::Pose::kWorldFromCam;
          },
          "what the file's poses map")
      ->check(CLI::IsMember({"cam_from_world", "world_from_cam"}));
  command
      ->add_option_function<std::string>(
          "--axes",
          [import](const std::string& text) {
            import->stated.axes =
                text == "opencv" ? RigConvention::Axes::kOpenCv : RigConvention::Axes::kOpenGl;
          },
          "the cameras' axes in the file: y down, z forward; or y up, z backward")
      ->check(CLI::IsMember({"opencv", "opengl"}));
  AddUnitOption(*command, &import->stated.unit);
  command
      ->add_option_function<std::string>(
          "--up", [import](const std::string& text) { import->up_in_file = AxisOf(text); },
          "which axis of the file's world points up (default: z); not with --check")
      ->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}));
  command
      ->add_option_function<std::vector<int>>(
          "--size",
          [import](const std::vector<int>& size) {
            import->size_px = {{ size[0], size[1] }};
          },
          "the pictures' size in pixels, where the file doesn't say it")
      ->expected(2)
      ->check(CLI::Range(1, 32768))
      ->type_name("WIDTH HEIGHT");
  command
      ->add_option_function<std::vector<double>>(
          "--workspace",
          [import](const std::vector<double>& n) {
            import->workspace_mm =
                Eigen::AlignedBox3d(Eigen::Vector3d(n[0], n[1], n[2]), Eigen::Vector3d(n[3], n[4], n[5]));
          },
          "the rig's workspace in mm")
      ->expected(6)
      ->type_name("X0 Y0 Z0 X1 Y1 Z1");
}

}  // namespace

void AddRigCommand(CLI::App& app, Choice* choice) {
  CLI::App* rig = app.add_subcommand("rig", "rigs that other programs calibrated");
  rig->require_subcommand(1);
  auto arguments = std::make_shared<RigImportArguments>();
  CLI::App* command = rig->add_subcommand(
      "import",
      "make a RIG.yml of a calibration by OpenCV, ROS, Kalibr, anipose or Caliscope, or of 3 x 4 matrices");
  command->add_option("FILE", arguments->import.files, "one file of all cameras, or one of each")->required();
  command->add_option("--out", arguments->out, "the rig file to write (RIG.yml)")->required();
  command
      ->add_option_function<std::string>(
          "--format",
          [arguments](const std::string& text) {
            arguments->import.format = recon::ParseForeignFormat(text);  // "auto" is none
          },
          "the files' format (default: auto)")
      ->check(CLI::IsMember({"auto", "opencv", "ros", "kalibr", "anipose", "caliscope", "projection"}));
  CLI::Option* check = command->add_option(
      "--check", arguments->check,
      "CALIB.toml with pictures of a board, which tell what the poses mean, the unit and the world");
  AddStatedOptions(command, &arguments->import);
  command->get_option("--up")->excludes(check);
  command->callback([=] {
    choice->action = [=](const CommandContext& context) { return ImportOneRig(*arguments, context); };
  });
}

}  // namespace elbowroom::cli
