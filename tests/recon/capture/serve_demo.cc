// serve_demo CAMERAS RATE_HZ FOLDER [COMMAND...]: a network of its own in which the simulated rig's cameras
// serve the demo's motion by GigE Vision; runs COMMAND in it (default: a shell), with RIG.yml, TRIAL.toml's
// rig, in FOLDER. For trying live cameras by hand, and for measuring them.
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "recon/rig_files/rig_file.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "tests/recon/capture/own_network.h"
#include "tests/recon/capture/served_rig.h"

namespace {

namespace fs = std::filesystem;
using namespace elbowroom;

int Run(const std::vector<std::string>& command) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::vector<char*> arguments;
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execvp(arguments[0], arguments.data());
    std::_Exit(127);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "usage: serve_demo CAMERAS RATE_HZ FOLDER [COMMAND...]\n";
    return 2;
  }
  const auto cameras = static_cast<std::size_t>(std::stoi(argv[1]));
  const double rate_hz = std::stod(argv[2]);
  const fs::path folder = argv[3];
  recon::testing::EnterOwnNetwork(static_cast<int>(cameras));
  // Beyond four cameras the first ones are served again, under other names.
  core::Rig rig = recon::FourCameraRig();
  recon::SyntheticRigOptions options;
  options.frame_rate_hz = rate_hz;
  recon::SyntheticRig simulated(
      rig, [](double t) { return recon::DemoSceneAt(t).objects; }, options);
  constexpr core::FrameIndex kSets = 60;
  const auto first = static_cast<core::FrameIndex>(4.0 * rate_hz);
  std::vector<recon::FrameSet> sets;
  for (core::FrameIndex i = 0; i < kSets; ++i) {
    recon::FrameSet set = simulated.Read(first + i);
    while (set.cameras.size() < cameras) set.cameras.push_back(set.cameras[set.cameras.size() - 4]);
    set.cameras.resize(cameras);
    sets.push_back(std::move(set));
  }
  const auto backgrounds = simulated.ReadBackgrounds({}, {});
  recon::testing::ServedRig served(std::move(sets), rate_hz);
  recon::RigFile rig_file{rig};
  rig_file.rig.cameras.clear();
  fs::create_directories(folder);
  for (std::size_t i = 0; i < cameras; ++i) {
    core::CameraCalibration calibration = rig.cameras[i % 4].calibration();
    calibration.name = "cam" + std::to_string(i + 1);
    rig_file.rig.cameras.emplace_back(calibration);
    cv::Mat mean;
    backgrounds[i % 4].mean_bgr.convertTo(mean, CV_8U);
    const fs::path background = fs::absolute(folder / ("background" + std::to_string(i + 1) + ".png"));
    cv::imwrite(background.string(), mean);
    rig_file.sources.push_back(served.SourcesOf(i));
    rig_file.sources.back().background = background.string();
  }
  recon::WriteRigFile(rig_file, folder / "RIG.yml");
  std::vector<std::string> command(argv + 4, argv + argc);
  if (command.empty()) command = {"/bin/sh"};
  return Run(command);
}
