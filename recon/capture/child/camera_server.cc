#include "recon/capture/child/camera_server.h"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/system/child_process.h"
#include "recon/capture/child/slot_map.h"
#include "recon/capture/child/video_server.h"
#include "recon/capture/device/camera_device.h"
#include "recon/capture/device/camera_protocol.h"
#include "recon/capture/device/video_protocol.h"
#include "recon/capture/genicam/genicam_camera.h"
#include "recon/capture/stream/stream_camera.h"
#include "recon/capture/v4l2/v4l2_camera.h"
#include "recon/decoding/packet.h"
#include "recon/rig_files/source_location.h"

namespace elbowroom::recon {
namespace {

using Clock = std::chrono::steady_clock;

// How long one wait for a picture may be; then the orders are looked at.
constexpr std::chrono::milliseconds kLongestWait{20};

std::unique_ptr<CameraDevice> OpenDevice(const DeviceRequest& request) {
  switch (KindOf(request.location)) {
    case SourceKind::kGenicam:
      return OpenGenicamCamera(request);
    case SourceKind::kUrl:
      return OpenStreamCamera(request);
    case SourceKind::kDevice:
      return OpenV4l2Camera(request);
    case SourceKind::kSequence:
    case SourceKind::kGlob:
    case SourceKind::kFolder:
    case SourceKind::kImage:
    case SourceKind::kVideo:
      break;
  }
  throw core::Error(core::ErrorKind::kCamera, "'" + request.location + "' is no live camera of a known kind");
}

// The program that this one serves is gone, or doesn't want the camera any more.
struct NotWanted {};

class Server {
 public:
  Server() {
    const std::optional<Packet> packet = ReceivePacket(socket_);
    const auto order = packet ? packet->Head<CameraOrder>() : std::nullopt;
    if (!order) std::_Exit(EXIT_FAILURE);
    if (packet->Text<CameraOrder>() == kListOrder) List();
    request_ = RequestOf(*order, packet->Text<CameraOrder>());
    // Buffers of the driver, pictures being decoded, and the libraries.
    constexpr double kLibraries = 4e9, kPictures = 64.0;
    core::OwnLimits limits;
    limits.memory_bytes = kLibraries + kPictures * 3.0 * request_.width_px * request_.height_px;
    core::LimitMyself(limits);
    if (request_.location.starts_with(kWriteOrder))
      ServeVideo(socket_, request_, request_.location.substr(kWriteOrder.size()));
    slots_ = MapSlots({request_.width_px, request_.height_px});
    if (slots_.empty()) std::_Exit(EXIT_FAILURE);
    is_free_.assign(kPictureSlots, true);
    spare_.create(request_.height_px, request_.width_px, CV_8UC3);
  }

  [[noreturn]] void Run() {
    try {
      const std::unique_ptr<CameraDevice> device = OpenDevice(request_);
      Tell(NewsOf(device->report()), TextOf(device->report()));
      for (;;) {
        TakeCommands(*device);
        TellOfNext(*device);
      }
    } catch (const NotWanted&) {
      // The camera was let go of in order, so that another program can have it at once.
    } catch (const std::exception& exception) {
      (void)SendPacket(socket_, CameraNews{.kind = CameraNewsKind::kFailed},
                       std::string_view(exception.what()).substr(0, kLongestPacketBytes / 2));
    }
    std::_Exit(EXIT_SUCCESS);
  }

 private:
  [[noreturn]] void List() {
    std::string text;
    for (const std::string& camera : FindV4l2Cameras()) text += camera + '\n';
    for (const std::string& camera : FindGenicamCameras()) text += "gige:" + camera + '\n';
    (void)SendPacket(socket_, CameraNews{.kind = CameraNewsKind::kListed},
                     std::string_view(text).substr(0, kLongestPacketBytes / 2));
    std::_Exit(EXIT_SUCCESS);
  }

  void Tell(const CameraNews& news, std::string_view text = {}) {
    if (!SendPacket(socket_, news, text.substr(0, kLongestPacketBytes / 2))) throw NotWanted();
    last_told_ = Clock::now();
  }

  void TakeCommands(CameraDevice& device) {
    pollfd waiting{socket_.number(), POLLIN, 0};
    while (::poll(&waiting, 1, 0) > 0) {
      const std::optional<Packet> packet = ReceivePacket(socket_);
      const auto command = packet ? packet->Head<CommandToCamera>() : std::nullopt;
      if (!command) throw NotWanted();
      switch (command->command) {
        case CameraCommand::kSlotBack:
          is_free_.at(static_cast<std::size_t>(command->slot)) = true;
          break;
        case CameraCommand::kTrigger:
          device.Trigger();
          break;
      }
    }
    if (Clock::now() - last_told_ > kSignOfLife) Tell({.kind = CameraNewsKind::kAlive});
  }

  void TellOfNext(CameraDevice& device) {
    const auto slot = std::find(is_free_.begin(), is_free_.end(), true) - is_free_.begin();
    const bool has_slot = slot < kPictureSlots;
    cv::Mat& target = has_slot ? slots_[static_cast<std::size_t>(slot)] : spare_;
    const unsigned char* const pixels = target.data;
    const std::optional<DevicePicture> picture = device.Next(kLongestWait, target);
    core::Require(target.data == pixels, "a picture is written where it belongs");
    if (!picture) return;
    const bool is_there = has_slot && picture->state == PictureState::kWhole;
    if (is_there) is_free_[static_cast<std::size_t>(slot)] = false;
    Tell({CameraNewsKind::kPicture, is_there ? static_cast<std::int32_t>(slot) : -1, *picture});
  }

  core::Descriptor socket_{kCameraSocket};
  DeviceRequest request_;
  std::vector<cv::Mat> slots_;  // in the memory that both programs share
  std::vector<bool> is_free_;
  cv::Mat spare_;
  Clock::time_point last_told_ = Clock::now();
};

}  // namespace

void ServeCamera() { Server().Run(); }

}  // namespace elbowroom::recon
