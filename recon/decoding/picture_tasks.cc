#include "recon/decoding/picture_tasks.h"

#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "recon/decoding/codec_complaint.h"
#include "recon/decoding/packet.h"

namespace elbowroom::recon {
namespace {

using Clock = std::chrono::steady_clock;

// The codecs' threads need no larger stack, and a stack counts as a whole against the limit on addresses.
constexpr std::size_t kThreadStackBytes = std::size_t{1} << 20U;
// A program that has pictures counted gets an answer about this often.
constexpr auto kLongestGrab = std::chrono::milliseconds(100);

// Everything that this process prints.
class CaughtPrint {
 public:
  CaughtPrint() : file_(core::MakeMemoryFile("print")) {
    ::dup2(file_.number(), STDOUT_FILENO);
    ::dup2(file_.number(), STDERR_FILENO);
    std::signal(SIGXFSZ, SIG_IGN);  // what is beyond the limit isn't written
    std::setvbuf(stdout, nullptr, _IONBF, 0);
  }

  [[nodiscard]] bool has_any() const { return ::lseek(file_.number(), 0, SEEK_CUR) > 0; }

  // The first line since the last call that tells of damage; "" if none does.
  std::string TakeComplaint() {
    constexpr std::size_t kMostRead = 8192;
    if (!has_any()) return {};
    std::string text(kMostRead, '\0');
    const ssize_t size = ::pread(file_.number(), text.data(), text.size(), 0);
    text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    (void)!::ftruncate(file_.number(), 0);
    ::lseek(file_.number(), 0, SEEK_SET);
    return ComplaintIn(text);
  }

 private:
  core::Descriptor file_;  // descriptors 1 and 2 are this open file, and share its position
};

// How much address space this process has, now.
double OwnBytes() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0;
  file >> pages;
  return pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

class Worker {
 public:
  Worker(const PictureCodecs& codecs, const WorkerOrder& order, const core::Descriptor& memory)
      : codecs_(codecs), order_(order) {
    const std::size_t bytes = static_cast<std::size_t>(order.pixel_bytes + order.file_bytes);
    void* shared = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, memory.number(), 0);
    core::Require(shared != MAP_FAILED, "memory that was handed over can be shared");
    pixels_ = static_cast<unsigned char*>(shared);
    LimitOwnMemory();
  }

  PictureReply Do(const PictureRequest& request, const std::string& text) {
    switch (request.task) {
      case PictureTask::kDecode:
        return Decode(request);
      case PictureTask::kOpenVideo:
        video_.reset();  // before the next takes its memory
        video_ = codecs_.open_video(text);
        return Opened();
      case PictureTask::kGrab:
        return Grab(request.number, request.tries);
      case PictureTask::kNext:
        return Next(request);
      case PictureTask::kEncode:
        return Encode(request, text);
    }
    return {};
  }

  std::string TakeComplaint() { return print_.TakeComplaint(); }

 private:
  void LimitOwnMemory() const {
    ::mallopt(M_ARENA_MAX, 1);  // each arena takes 64 MiB of addresses
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, kThreadStackBytes);
    pthread_setattr_default_np(&attributes);
    pthread_attr_destroy(&attributes);
    core::LimitMyself({.memory_bytes = OwnBytes() + static_cast<double>(order_.own_bytes),
                       .file_bytes = 1e6,  // of what it prints
                       .cpu_s = std::nullopt});
  }

  // A picture in the shared memory, if one of that size fits there; otherwise an empty one, which will get
  // memory of its own.
  [[nodiscard]] cv::Mat Place(const PictureRequest& request) const {
    if (request.width_px <= 0 || request.height_px <= 0 ||
        3 * std::int64_t{request.width_px} * request.height_px > order_.pixel_bytes) {
      return {};
    }
    return {request.height_px, request.width_px, CV_8UC3, pixels_};
  }

  [[nodiscard]] PictureReply Shown(const cv::Mat& image) const {
    if (image.empty()) return {};
    const std::size_t row_bytes = static_cast<std::size_t>(image.cols) * image.elemSize();
    const auto rows = static_cast<std::size_t>(image.rows);
    if (image.data != pixels_ && row_bytes * rows <= static_cast<std::size_t>(order_.pixel_bytes)) {
      for (int row = 0; row < image.rows; ++row)
        std::memcpy(pixels_ + static_cast<std::size_t>(row) * row_bytes, image.ptr(row), row_bytes);
    }
    return {PictureOutcome::kDone, image.cols, image.rows, image.type()};
  }

  PictureReply Decode(const PictureRequest& request) {
    if (request.number <= 0 || request.number > order_.file_bytes) return {};
    const std::string_view bytes(reinterpret_cast<const char*>(pixels_) + order_.pixel_bytes,
                                 static_cast<std::size_t>(request.number));
    return Shown(codecs_.decode(bytes, request.as));
  }

  PictureReply Encode(const PictureRequest& request, const std::string& extension) const {
    const cv::Mat image(request.height_px, request.width_px, request.type, pixels_);
    if (static_cast<std::int64_t>(image.total() * image.elemSize()) > order_.pixel_bytes) return {};
    const std::vector<std::uint8_t> file = codecs_.encode(image, extension);
    if (file.empty() || static_cast<std::int64_t>(file.size()) > order_.file_bytes) return {};
    std::memcpy(pixels_ + order_.pixel_bytes, file.data(), file.size());
    return {.outcome = PictureOutcome::kDone, .file_bytes = static_cast<std::int64_t>(file.size())};
  }

  PictureReply Opened() {
    if (video_ == nullptr) return {};
    const cv::Size size = video_->size_px();
    return {.outcome = PictureOutcome::kDone,
            .width_px = size.width,
            .height_px = size.height,
            .frame_rate_hz = video_->frame_rate_hz(),
            .promised_frames = video_->promised_frames()};
  }

  PictureReply Grab(std::int64_t most, int tries) {
    PictureReply reply{PictureOutcome::kDone};
    const auto begin = Clock::now();
    // Ends when something is printed: that is about this picture, or about one soon after it that a thread
    // decodes already.
    while (reply.frames < most && !print_.has_any() && Clock::now() - begin < kLongestGrab) {
      bool has_next = false;
      for (int i = 0; i < tries && video_ != nullptr && !has_next; ++i) has_next = video_->Grab();
      if (!has_next) {
        reply.outcome = PictureOutcome::kNothing;
        break;
      }
      ++reply.frames;
    }
    return reply;
  }

  PictureReply Next(const PictureRequest& request) {
    if (video_ == nullptr || !video_->Grab()) return {};
    cv::Mat image = Place(request);
    video_->Retrieve(image);
    return Shown(image);
  }

  const PictureCodecs& codecs_;
  WorkerOrder order_;
  CaughtPrint print_;
  unsigned char* pixels_ = nullptr;
  std::unique_ptr<VideoStream> video_;
};

}  // namespace

void WorkForOneSource(const PictureCodecs& codecs, const WorkerOrder& order, const core::Descriptor& socket,
                      const core::Descriptor& memory) {
  try {
    // libtiff's messages come through OpenCV's log.
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_DEBUG);
    Worker worker(codecs, order, memory);
    if (!SendPacket(socket, PictureReply{.outcome = PictureOutcome::kReady})) std::_Exit(EXIT_SUCCESS);
    while (const auto packet = ReceivePacket(socket)) {
      const auto request = packet->Head<PictureRequest>();
      if (!request) break;
      const PictureReply reply = worker.Do(*request, std::string(packet->Text<PictureRequest>()));
      if (!SendPacket(socket, reply, worker.TakeComplaint())) break;
    }
  } catch (const std::exception&) {
    std::_Exit(EXIT_FAILURE);  // its parent reports it
  }
  std::_Exit(EXIT_SUCCESS);  // no exit handlers of the libraries run
}

}  // namespace elbowroom::recon
