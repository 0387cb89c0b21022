// A camera of the network, on this machine: pictures over HTTP, as a script has them.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/system/child_process.h"

namespace elbowroom::recon::testing {

// Answers calls to its address on 127.0.0.1, one at a time, and ends with this object. A later caller gets
// the parts that come next.
class MjpegServer {
 public:
  // What part `index` of the stream holds; nothing: it stalls from there on, the connection stays open.
  using Part = std::function<std::optional<std::string>(int index)>;

  // Without parts it takes the call and never says a word.
  explicit MjpegServer(Part part);
  ~MjpegServer();
  MjpegServer(const MjpegServer&) = delete;
  MjpegServer& operator=(const MjpegServer&) = delete;

  [[nodiscard]] std::string url() const;
  void WaitUntilItStalls();

 private:
  void Run(const std::stop_token& stop);
  void Stall();

  Part part_;
  core::Descriptor listening_;
  int port_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_stalled_ = false;
  core::Descriptor caller_;  // open until the end
  std::jthread thread_;
};

// NumberedPicture(number).
[[nodiscard]] std::string Jpeg(int number);

}  // namespace elbowroom::recon::testing
