#include "recon/headset/child/headset_server.h"

#include <poll.h>
#include <sys/mman.h>

#include <exception>
#include <optional>

#include "core/error.h"
#include "core/system/child_process.h"
#include "recon/decoding/packet.h"
#include "recon/headset/child/xr_session.h"
#include "recon/headset/headset_protocol.h"

namespace elbowroom::recon {
namespace {

using Clock = std::chrono::steady_clock;

// Between two looks for events while the runtime isn't ready, and between two poses without graphics.
constexpr int kRestMs = 20, kHeadlessPaceMs = 8;

// The socket, and what comes and goes through it.
class Talk {
 public:
  [[nodiscard]] std::optional<HeadsetOrder> ReceiveOrder() const {
    const auto packet = ReceivePacket(socket_);
    return packet ? packet->Head<HeadsetOrder>() : std::nullopt;
  }

  void Tell(const HeadsetNews& news, std::string_view text = {}) {
    is_open_ = SendPacket(socket_, news, text) && is_open_;
    told_at_ = Clock::now();
  }
  void Tell(HeadsetPhase phase, std::string_view text) {
    HeadsetNews news;
    news.kind = HeadsetNewsKind::kPhase;
    news.phase = phase;
    Tell(news, text);
  }
  void SayAlive() {
    if (Clock::now() - told_at_ > kHeadsetSignOfLife) Tell(HeadsetNews());
  }

  // The latest picture that came; waits for one for so long. Those before it are given back.
  std::optional<PictureForHeadset> LatestPicture(int patience_ms) {
    std::optional<PictureForHeadset> latest;
    pollfd waiting{socket_.number(), POLLIN, 0};
    while (is_open_ && ::poll(&waiting, 1, latest ? 0 : patience_ms) > 0) {
      const auto packet = ReceivePacket(socket_);
      is_open_ = packet.has_value();
      const auto picture = packet ? packet->Head<PictureForHeadset>() : std::nullopt;
      if (!picture || picture->slot < 0 || picture->slot >= kHeadsetSlots) continue;
      if (latest) GiveBack(*latest);
      latest = picture;
    }
    return latest;
  }
  void GiveBack(const PictureForHeadset& picture) {
    HeadsetNews news;
    news.kind = HeadsetNewsKind::kSlotBack;
    news.slot = picture.slot;
    Tell(news);
  }
  [[nodiscard]] bool is_open() const { return is_open_; }

 private:
  core::Descriptor socket_{kHeadsetSocket};
  bool is_open_ = true;
  Clock::time_point told_at_;
};

const std::byte* MapPictures(const HeadsetOrder& order) {
  if (order.shows_pictures == 0) return nullptr;
  void* memory = ::mmap(nullptr, kHeadsetSlots * kHeadsetSlotBytes, PROT_READ, MAP_SHARED, kHeadsetMemory, 0);
  core::Require(memory != MAP_FAILED, "the memory that is shared can be mapped");
  return static_cast<const std::byte*>(memory);
}

void Serve(const HeadsetOrder& order, Talk* talk) {
  const std::byte* const pictures = MapPictures(order);
  XrHeadset headset(order);
  HeadsetNews started;
  started.kind = HeadsetNewsKind::kStarted;
  started.recommended_px = headset.recommended_px();
  talk->Tell(started, headset.name());
  while (talk->is_open()) {
    talk->SayAlive();
    for (const XrHeadset::Change& change : headset.FollowEvents()) {
      talk->Tell(change.phase, change.text);
      if (change.phase == HeadsetPhase::kEnded) return;
    }
    const int rest_ms = !headset.is_running() ? kRestMs : headset.waits_for_frames() ? 0 : kHeadlessPaceMs;
    const auto picture = talk->LatestPicture(rest_ms);
    if (headset.is_running()) {
      talk->Tell(headset.BeginFrame());
      if (picture && pictures != nullptr)
        headset.TakePicture(*picture, pictures + static_cast<std::size_t>(picture->slot) * kHeadsetSlotBytes);
      headset.EndFrame();
    }
    if (picture) talk->GiveBack(*picture);
  }
}

}  // namespace

void ServeHeadset() {
  core::LimitMyself({});
  Talk talk;
  const auto order = talk.ReceiveOrder();
  if (!order) return;
  try {
    Serve(*order, &talk);
  } catch (const RuntimeLost& lost) {
    talk.Tell(HeadsetPhase::kLost, lost.what());
  } catch (const std::exception& error) {  // the outermost loop: nothing may escape
    talk.Tell(HeadsetPhase::kRefused, error.what());
  }
}

}  // namespace elbowroom::recon
