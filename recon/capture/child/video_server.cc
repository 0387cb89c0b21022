#include "recon/capture/child/video_server.h"

#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <optional>
#include <string_view>
#include <vector>

#include "recon/capture/child/slot_map.h"
#include "recon/capture/device/video_protocol.h"
#include "recon/capture/encoding/video_encoder.h"
#include "recon/decoding/packet.h"

namespace elbowroom::recon {
namespace {

// Capture comes first; a picture that isn't written is at least counted.
constexpr int kNicer = 5;

void Encode(const core::Descriptor& socket, const DeviceRequest& request, const std::string& path) {
  const cv::Size size_px(request.width_px, request.height_px);
  const std::vector<cv::Mat> slots = MapSlots(size_px);
  if (slots.empty()) std::_Exit(EXIT_FAILURE);
  constexpr double kUsualRateHz = 30.0;
  VideoEncoder encoder(path, size_px, request.settings.rate_hz.value_or(kUsualRateHz));
  for (;;) {
    const std::optional<Packet> packet = ReceivePacket(socket);
    const auto command = packet ? packet->Head<VideoCommand>() : std::nullopt;
    if (!command) return;  // the file isn't wanted any more
    switch (command->kind) {
      case VideoCommandKind::kWrite:
        encoder.Write(slots.at(static_cast<std::size_t>(command->slot)));
        (void)SendPacket(socket, VideoNews{VideoNewsKind::kSlotBack, command->slot});
        break;
      case VideoCommandKind::kFinish:
        encoder.Finish();
        (void)SendPacket(socket, VideoNews{VideoNewsKind::kFinished});
        return;
    }
  }
}

}  // namespace

void ServeVideo(const core::Descriptor& socket, const DeviceRequest& request, const std::string& path) {
  (void)::nice(kNicer);
  try {
    Encode(socket, request, path);
  } catch (const std::exception& exception) {
    (void)SendPacket(socket, VideoNews{VideoNewsKind::kFailed},
                     std::string_view(exception.what()).substr(0, kLongestPacketBytes / 2));
  }
  std::_Exit(EXIT_SUCCESS);
}

}  // namespace elbowroom::recon
