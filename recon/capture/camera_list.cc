#include "recon/capture/camera_list.h"

#include <chrono>
#include <optional>
#include <sstream>

#include "core/error.h"
#include "core/progress.h"
#include "core/system/child_process.h"
#include "recon/capture/camera_program.h"
#include "recon/capture/device/camera_protocol.h"
#include "recon/decoding/packet.h"

namespace elbowroom::recon {

std::vector<std::string> FindLiveCameras(const std::stop_token& stop) {
  constexpr std::chrono::seconds kLongest{15};
  const CameraProgram program;
  (void)SendPacket(program.socket, CameraOrder{}, kListOrder);
  const core::Woken woken =
      core::WaitToRead(program.socket, stop, std::chrono::steady_clock::now() + kLongest);
  core::ThrowIfStopped(stop, "looking for cameras");
  const std::optional<Packet> packet =
      woken == core::Woken::kReady ? ReceivePacket(program.socket) : std::nullopt;
  const auto news = packet ? packet->Head<CameraNews>() : std::nullopt;
  if (!news || news->kind == CameraNewsKind::kFailed) {
    throw core::Error(core::ErrorKind::kCamera,
                      "the program that looks for cameras doesn't answer; install this program again");
  }
  std::vector<std::string> cameras;
  std::istringstream lines{std::string(packet->Text<CameraNews>())};
  for (std::string line; std::getline(lines, line);) cameras.push_back(line);
  return cameras;
}

}  // namespace elbowroom::recon
