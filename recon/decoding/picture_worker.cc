#include "recon/decoding/picture_worker.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <thread>

#include "core/error.h"
#include "core/progress.h"
#include "core/system/module.h"
#include "recon/decoding/packet.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;
using core::Woken;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t kMib = std::int64_t{1} << 20U;
// A worker starts as soon as the decoder has its libraries, which may have to come from a slow disk.
constexpr std::chrono::seconds kLongestStart{60};
// The system may take so long to report that a process has ended.
constexpr std::chrono::seconds kLongestEnd{2};

// The decoder of this program: a server that makes workers.
class Decoder {
 public:
  ~Decoder() {
    orders_.Close();  // the decoder notices that, kills its workers and exits
    if (child_) (void)child_->WaitForEnd({}, Clock::now() + kLongestEnd);
  }

  void Order(const WorkerOrder& order, std::span<const int> files) {
    const std::lock_guard lock(mutex_);
    for (const bool is_again : {false, true}) {
      if (!child_ || is_again) Start();
      if (SendPacket(orders_, order, {}, files)) return;
    }
    throw Error(ErrorKind::kFile, "the program that reads pictures ends at once; build or install it again");
  }

 private:
  void Start() {
    child_.reset();
    core::Pipe ends = core::MakeSocketPair();
    child_.emplace(core::ChildProgram{.program = core::FindProgramBeside(kDecoderProgram),
                                      .arguments = {"elbowroom_decoder"},
                                      .gives = {&ends.to}});
    orders_ = std::move(ends.from);
  }

  std::mutex mutex_;
  core::Descriptor orders_;
  std::optional<core::Child> child_;
};

Decoder& DecoderOfThisProgram() {
  static Decoder decoder;
  return decoder;
}

// A generous bound on what a source's worker takes beside the codecs: for a picture its pixels and
// coefficients; for a video the pictures that it refers to, and those that its threads hold.
std::int64_t OwnBytes(const WorkerNeeds& needs) {
  const std::int64_t pixels = needs.width_px * needs.height_px;
  if (needs.memory == SourceMemory::kPicture) return 96 * kMib + 32 * pixels;
  const auto threads = static_cast<std::int64_t>(std::max(1U, std::thread::hardware_concurrency()));
  return (160 + 3 * threads) * kMib + 3 * (40 + 2 * threads) * pixels;
}

WorkerOrder OrderFor(const WorkerNeeds& needs) {
  core::Require(needs.width_px > 0 && needs.height_px > 0 && needs.file_bytes >= 0, "a picture has pixels");
  constexpr std::int64_t kLargestPixelBytes = 8;  // four channels of 16 bits
  constexpr std::int64_t kPixelBytes = 3;
  const std::int64_t each = needs.memory == SourceMemory::kPicture ? kLargestPixelBytes : kPixelBytes;
  return {needs.width_px * needs.height_px * each, needs.file_bytes, OwnBytes(needs)};
}

}  // namespace

PictureWorker::PictureWorker(const WorkerNeeds& needs)
    : order_(OrderFor(needs)),
      memory_("pictures", static_cast<std::size_t>(order_.pixel_bytes + order_.file_bytes)) {}

PictureWorker::~PictureWorker() = default;

std::span<std::byte> PictureWorker::file_bytes() const {
  return memory_.bytes().subspan(static_cast<std::size_t>(order_.pixel_bytes));
}

std::span<std::byte> PictureWorker::pixel_bytes() const {
  return memory_.bytes().first(static_cast<std::size_t>(order_.pixel_bytes));
}

void PictureWorker::Start(const std::stop_token& stop) {
  core::Pipe socket = core::MakeSocketPair(), leash = core::MakeSocketPair();
  const std::array files{socket.to.number(), leash.to.number(), memory_.file().number()};
  DecoderOfThisProgram().Order(order_, files);
  socket.to.Close();
  leash.to.Close();
  const Woken woken = core::WaitToRead(socket.from, stop, Clock::now() + kLongestStart);
  core::ThrowIfStopped(stop, "reading pictures");
  const auto packet = woken == Woken::kReady ? ReceivePacket(socket.from) : std::nullopt;
  const auto reply = packet ? packet->Head<PictureReply>() : std::nullopt;
  if (reply && reply->outcome == PictureOutcome::kNoCodecs)
    throw Error(ErrorKind::kFile, std::string(packet->Text<PictureReply>()));
  if (!reply) {
    throw Error(ErrorKind::kFile,
                "the program that reads pictures doesn't start; close other programs, or install it again");
  }
  socket_ = std::move(socket.from);
  leash_ = std::move(leash.from);
}

void PictureWorker::End() {
  socket_.Close();
  leash_.Close();
}

PictureAnswer PictureWorker::AnswerOfEnd() {
  PictureAnswer answer{{}, "its decoder is gone", true};
  if (core::WaitToRead(leash_, {}, Clock::now() + kLongestEnd) == Woken::kReady) {
    const auto packet = ReceivePacket(leash_);
    if (const auto end = packet ? packet->Head<WorkerEnd>() : std::nullopt)
      answer.complaint = "its decoder " + core::TextOfEnd(end->status);
  }
  End();
  return answer;
}

PictureAnswer PictureWorker::Ask(const PictureRequest& request, std::string_view text,
                                 const std::stop_token& stop,
                                 const std::optional<std::chrono::seconds>& most_time) {
  if (!is_running()) Start(stop);
  const core::Deadline deadline = most_time ? core::Deadline(Clock::now() + *most_time) : std::nullopt;
  if (!SendPacket(socket_, request, text)) return AnswerOfEnd();
  switch (core::WaitToRead(socket_, stop, deadline)) {
    case Woken::kReady:
      break;
    case Woken::kStopped:
      End();
      core::ThrowIfStopped(stop, "reading pictures");
      break;
    case Woken::kTooLate:
      End();
      return {{}, fmt::format("decoding it takes more than {} s", most_time->count()), true};
  }
  const auto packet = ReceivePacket(socket_);
  const auto reply = packet ? packet->Head<PictureReply>() : std::nullopt;
  if (!reply) return AnswerOfEnd();
  return {*reply, core::PrintableLine(packet->Text<PictureReply>(), kLongestPacketBytes), false};
}

}  // namespace elbowroom::recon
