#include "recon/headset/headset_link.h"

#include <poll.h>

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "core/system/module.h"
#include "recon/decoding/packet.h"

namespace elbowroom::recon {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLongestLeave{25};
constexpr std::size_t kLongestText = 600;

std::unique_ptr<core::SharedMemory> MemoryFor(const HeadsetOrder& order) {
  if (order.shows_pictures == 0) return nullptr;
  return std::make_unique<core::SharedMemory>("headset", kHeadsetSlots * kHeadsetSlotBytes);
}

std::vector<const core::Descriptor*> GivenOf(const core::Descriptor& socket,
                                             const core::SharedMemory* memory) {
  if (memory == nullptr) return {&socket};
  return {&socket, &memory->file()};
}

}  // namespace

HeadsetLink::HeadsetLink(const HeadsetOrder& order) : HeadsetLink(order, core::MakeSocketPair()) {}

// The program's end of the socket is closed here once the program has it.
HeadsetLink::HeadsetLink(const HeadsetOrder& order, core::Pipe ends)
    : memory_(MemoryFor(order)),
      socket_(std::move(ends.from)),
      child_({.program = core::FindProgramBeside(kHeadsetProgram),
              .arguments = {"elbowroom_headset"},
              .gives = GivenOf(ends.to, memory_.get())}) {
  (void)SendPacket(socket_, order);  // a program that is gone is noticed by Receive
}

HeadsetLink::~HeadsetLink() {
  socket_.Close();
  (void)child_.WaitForEnd({}, Clock::now() + kLongestLeave);
}

std::optional<HeadsetLink::News> HeadsetLink::Receive(std::chrono::milliseconds patience) {
  pollfd waiting{socket_.number(), POLLIN, 0};
  if (::poll(&waiting, 1, static_cast<int>(patience.count())) <= 0) return std::nullopt;
  const auto packet = ReceivePacket(socket_);
  const auto news = packet ? packet->Head<HeadsetNews>() : std::nullopt;
  if (!news) {
    HeadsetNews lost;
    lost.kind = HeadsetNewsKind::kPhase;
    lost.phase = HeadsetPhase::kLost;
    (void)child_.WaitForEnd({}, Clock::now() + kLongestLeave);
    const auto status = child_.Status();
    return News{lost, "the OpenXR runtime ended the headset program" +
                          (status ? ": it " + core::TextOfEnd(*status) : std::string())};
  }
  if (news->kind == HeadsetNewsKind::kSlotBack && news->slot >= 0 && news->slot < kHeadsetSlots) {
    const std::lock_guard lock(mutex_);
    is_in_use_[static_cast<std::size_t>(news->slot)] = false;
  }
  return News{*news, core::PrintableLine(packet->Text<HeadsetNews>(), kLongestText)};
}

bool HeadsetLink::Show(std::int64_t pose, const std::array<EyePicture, 2>& eyes) {
  core::Require(memory_ != nullptr, "the headset program was started for pictures");
  const std::lock_guard lock(mutex_);
  const auto free = std::ranges::find(is_in_use_, false);
  if (free == is_in_use_.end()) return false;
  const auto slot = static_cast<std::size_t>(free - is_in_use_.begin());
  PictureForHeadset picture;
  picture.slot = static_cast<std::int32_t>(slot);
  picture.pose = pose;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const EyePicture& its = eyes[eye];
    core::Require(its.width_px > 0 && its.height_px > 0 && its.width_px <= kMostEyeSidePx &&
                      its.height_px <= kMostEyeSidePx &&
                      its.rgb.size() == 3 * static_cast<std::size_t>(its.width_px) *
                                            static_cast<std::size_t>(its.height_px),
                  "an eye's picture has its pixels, and not too many");
    std::ranges::copy(std::as_bytes(its.rgb),
                      memory_->bytes().subspan(slot * kHeadsetSlotBytes + eye * kEyeBytes).begin());
    picture.width_px[eye] = its.width_px;
    picture.height_px[eye] = its.height_px;
    picture.seen[eye] = its.seen;
  }
  *free = SendPacket(socket_, picture);
  return *free;
}

}  // namespace elbowroom::recon
