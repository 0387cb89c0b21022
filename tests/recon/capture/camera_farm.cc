#include "tests/recon/capture/camera_farm.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <memory>
#include <opencv2/core.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "tests/recon/capture/fake_gige_camera.h"
#include "tests/recon/capture/own_network.h"
#include "tests/recon/footage/made_footage.h"

namespace elbowroom::recon::testing {
namespace {

constexpr int kFarmWidth = 640, kFarmHeight = 480;

using Cameras = std::vector<std::unique_ptr<FakeGigeCamera>>;

void SwitchOne(Cameras& cameras, std::size_t i, bool is_on, const cv::Mat& noise) {
  cameras.at(i).reset();
  if (!is_on) return;
  cameras[i] =
      std::make_unique<FakeGigeCamera>(LoopbackAddress(static_cast<int>(i)), fmt::format("GV{:02}", i + 1),
                                       [&noise](std::int64_t, const FakeSettings&, cv::Mat& pixels) {
                                         noise.copyTo(pixels);
                                         return FakeGigeCamera::Clock::now();
                                       });
}

// The orders are lines: "on 3", "off 3", "loss 3 0.01". Each is answered by one byte.
[[noreturn]] void Serve(int count, const core::Descriptor& orders, const core::Descriptor& answers) {
  cv::Mat noise(kFarmHeight, kFarmWidth, CV_8UC1);
  cv::randu(noise, 0, 255);
  Cameras cameras(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < cameras.size(); ++i) SwitchOne(cameras, i, true, noise);
  std::string line;
  for (char c = 0; ::read(orders.number(), &c, 1) == 1;) {
    if (c != '\n') {
      line += c;
      continue;
    }
    std::istringstream words(std::exchange(line, {}));
    std::string what;
    std::size_t camera = 0;
    double share = 0.0;
    words >> what >> camera >> share;
    if (what == "loss") {
      cameras.at(camera)->SetPacketLoss(share);
    } else {
      SwitchOne(cameras, camera, what == "on", noise);
    }
    (void)!::write(answers.number(), "!", 1);
  }
  std::_Exit(EXIT_SUCCESS);
}

}  // namespace

CameraFarm::CameraFarm(int cameras) : cameras_(cameras) {
  core::Pipe orders = core::MakePipe(), answers = core::MakePipe();
  process_ = ::fork();
  if (process_ == 0) {
    orders.to.Close();
    Serve(cameras, orders.from, answers.to);
  }
  to_ = std::move(orders.to);
  from_ = std::move(answers.from);
  Ask("loss 0 0");  // answered once all cameras are there
}

CameraFarm::~CameraFarm() {
  to_.Close();
  ::waitpid(process_, nullptr, 0);
}

void CameraFarm::Ask(const std::string& what) {
  const std::string line = what + "\n";
  (void)!::write(to_.number(), line.data(), line.size());
  char answer = 0;
  (void)!::read(from_.number(), &answer, 1);
}

void CameraFarm::Switch(int camera, bool is_on) { Ask(fmt::format("{} {}", is_on ? "on" : "off", camera)); }
void CameraFarm::SetPacketLoss(int camera, double share) { Ask(fmt::format("loss {} {}", camera, share)); }

RigFile CameraFarm::Rig(double rate_hz) const {
  std::vector<CameraSources> sources;
  for (int i = 0; i < cameras_; ++i) {
    CameraSources source;
    source.frames = "gige:" + LoopbackAddress(i);
    source.capture.rate_hz = rate_hz;
    source.capture.exposure_us = 5000.0;
    source.capture.packet_bytes = 8000;
    sources.push_back(source);
  }
  RigFile rig_file = PlainRig(sources);
  for (std::size_t i = 0; i < rig_file.rig.cameras.size(); ++i)
    rig_file.rig.cameras[i] = PlainCamera(rig_file.rig.cameras[i].name(), kFarmWidth, kFarmHeight);
  return rig_file;
}

}  // namespace elbowroom::recon::testing
