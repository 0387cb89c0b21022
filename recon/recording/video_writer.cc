#include "recon/recording/video_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"
#include "recon/capture/device/camera_protocol.h"
#include "recon/capture/device/video_protocol.h"
#include "recon/decoding/packet.h"

namespace elbowroom::recon {

VideoWriter::VideoWriter(const std::filesystem::path& file, cv::Size size_px, double rate_hz)
    : file_(file), slots_(size_px), is_free_(kPictureSlots, true), program_(&slots_) {
  DeviceRequest request{std::string(kWriteOrder) + file.string(), size_px.width, size_px.height, {}};
  request.settings.rate_hz = rate_hz;
  if (!SendPacket(program_.socket, OrderFor(request), request.location)) Fail("its encoder ends at once");
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::Fail(std::string_view why) const {
  throw core::Error(core::ErrorKind::kFile, fmt::format("video '{}': {}", file_.string(), why));
}

bool VideoWriter::TakeNews() {
  const auto deadline = std::chrono::steady_clock::now() + kLongestWait;
  if (core::WaitToRead(program_.socket, {}, deadline) == core::Woken::kTooLate) {
    program_.child.Kill();
    Fail(fmt::format("nothing was written for {} s; is the disk well?", kLongestWait.count()));
  }
  const std::optional<Packet> packet = ReceivePacket(program_.socket);
  const auto news = packet ? packet->Head<VideoNews>() : std::nullopt;
  if (!news) Fail("its encoder " + core::TextOfEnd(program_.child.Wait()));
  switch (news->kind) {
    case VideoNewsKind::kSlotBack:
      is_free_.at(static_cast<std::size_t>(news->slot)) = true;
      return false;
    case VideoNewsKind::kFinished:
      return true;
    case VideoNewsKind::kFailed:
      break;
  }
  throw core::Error(core::ErrorKind::kFile,
                    core::PrintableLine(packet->Text<VideoNews>(), kLongestPacketBytes));
}

void VideoWriter::Write(const cv::Mat& image_bgr) {
  auto free = std::ranges::find(is_free_, true);
  while (free == is_free_.end()) {
    (void)TakeNews();
    free = std::ranges::find(is_free_, true);
  }
  const auto slot = static_cast<std::int32_t>(free - is_free_.begin());
  cv::Mat pixels = slots_.Slot(slot);
  core::Require(image_bgr.size() == pixels.size() && image_bgr.type() == pixels.type(),
                "all pictures of a video are of its size");
  image_bgr.copyTo(pixels);
  *free = false;
  // If it can't be sent, the next message says why.
  (void)SendPacket(program_.socket, VideoCommand{VideoCommandKind::kWrite, slot});
}

void VideoWriter::Finish() {
  (void)SendPacket(program_.socket, VideoCommand{VideoCommandKind::kFinish});
  while (!TakeNews()) {
  }
}

}  // namespace elbowroom::recon
