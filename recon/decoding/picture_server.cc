#include "recon/decoding/picture_server.h"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <map>
#include <opencv2/core/mat.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/system/child_process.h"
#include "recon/decoding/packet.h"
#include "recon/decoding/picture_codecs.h"
#include "recon/decoding/picture_protocol.h"
#include "recon/decoding/picture_tasks.h"

namespace elbowroom::recon {
namespace {

enum OrderFile : std::size_t { kWorkerSocket, kLeash, kMemory, kOrderFiles };

void Ignore(int) {}  // handles SIGCHLD, which only has to end a wait

// Uses codecs once, before any fork. What they look up at their first picture needn't be looked up again by
// every worker.
void WarmUp(const PictureCodecs& codecs) {
  const cv::Mat picture(8, 8, CV_8UC3, cv::Scalar::all(0));
  for (const char* extension : {".png", ".jpg"}) {
    const std::vector<std::uint8_t> file = codecs.encode(picture, extension);
    (void)codecs.decode({reinterpret_cast<const char*>(file.data()), file.size()}, DecodedAs::kBgr);
  }
}

class Server {
 public:
  Server() {
    try {
      codecs_ = &LoadedPictureCodecs();
      WarmUp(*codecs_);
    } catch (const std::exception& exception) {
      trouble_ = exception.what();
    }
    // SIGCHLD is blocked except in ppoll, so that a worker's end interrupts nothing else.
    sigset_t child_ended;
    sigemptyset(&child_ended);
    sigaddset(&child_ended, SIGCHLD);
    sigprocmask(SIG_BLOCK, &child_ended, &unblocked_);
    struct sigaction action {};
    action.sa_handler = &Ignore;
    sigaction(SIGCHLD, &action, nullptr);
  }

  [[noreturn]] void Run() {
    for (;;) {
      std::vector<pollfd> waiting{{orders_.number(), POLLIN, 0}};
      std::vector<pid_t> leashed;
      for (const auto& [pid, leash] : leashes_) {
        waiting.push_back({leash.number(), POLLIN, 0});
        leashed.push_back(pid);
      }
      const int ready = ::ppoll(waiting.data(), waiting.size(), nullptr, &unblocked_);
      Reap();
      if (ready <= 0) continue;
      for (std::size_t i = 0; i < leashed.size(); ++i)
        if (waiting[i + 1].revents != 0) ::kill(leashed[i], SIGKILL);
      if (waiting[0].revents == 0) continue;
      std::optional<Packet> packet = ReceivePacket(orders_);
      if (!packet) EndAll();
      Take(std::move(*packet));
    }
  }

 private:
  void Take(Packet packet) {
    const auto order = packet.Head<WorkerOrder>();
    if (!order || packet.files.size() != kOrderFiles) return;
    if (codecs_ == nullptr) {
      (void)SendPacket(packet.files[kWorkerSocket], PictureReply{.outcome = PictureOutcome::kNoCodecs},
                       trouble_);
      return;
    }
    const pid_t pid = ::fork();
    if (pid == 0) {
      sigprocmask(SIG_SETMASK, &unblocked_, nullptr);
      leashes_.clear();
      orders_.Close();
      packet.files[kLeash].Close();
      WorkForOneSource(*codecs_, *order, packet.files[kWorkerSocket], packet.files[kMemory]);
    }
    if (pid > 0) leashes_.emplace(pid, std::move(packet.files[kLeash]));
  }

  void Reap() {
    int status = 0;
    for (pid_t pid = 0; (pid = ::waitpid(-1, &status, WNOHANG)) > 0;) {
      const auto leash = leashes_.find(pid);
      if (leash == leashes_.end()) continue;
      (void)SendPacket(leash->second, WorkerEnd{status});
      leashes_.erase(leash);
    }
  }

  [[noreturn]] void EndAll() {
    for (const auto& [pid, leash] : leashes_) ::kill(pid, SIGKILL);
    while (::waitpid(-1, nullptr, 0) > 0 || errno == EINTR) {
    }
    std::_Exit(EXIT_SUCCESS);
  }

  core::Descriptor orders_{kOrderSocket};
  std::map<pid_t, core::Descriptor> leashes_;
  const PictureCodecs* codecs_ = nullptr;
  std::string trouble_;  // why there are no codecs
  sigset_t unblocked_{};
};

}  // namespace

void ServePictures() { Server().Run(); }

}  // namespace elbowroom::recon
