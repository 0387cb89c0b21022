#include "tests/recon/footage/mjpeg_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/recon/footage/made_footage.h"

namespace elbowroom::recon::testing {
namespace {

constexpr int kPollMs = 20;

bool WaitFor(const core::Descriptor& socket, short event, const std::stop_token& stop) {
  pollfd waiting{socket.number(), event, 0};
  while (!stop.stop_requested())
    if (::poll(&waiting, 1, kPollMs) > 0) return true;
  return false;
}

// False: the caller is gone, or the test is over.
bool Send(const core::Descriptor& socket, std::string_view bytes, const std::stop_token& stop) {
  while (!bytes.empty()) {
    if (!WaitFor(socket, POLLOUT, stop)) return false;
    const ssize_t sent = ::send(socket.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

}  // namespace

MjpegServer::MjpegServer(Part part)
    : part_(std::move(part)), listening_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* any = reinterpret_cast<sockaddr*>(&address);
  if (::bind(listening_.number(), any, size) != 0 || ::listen(listening_.number(), 4) != 0 ||
      ::getsockname(listening_.number(), any, &size) != 0) {
    throw std::runtime_error("no port on 127.0.0.1");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
}

MjpegServer::~MjpegServer() {
  thread_.request_stop();
  thread_.join();
}

std::string MjpegServer::url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/video"; }

void MjpegServer::WaitUntilItStalls() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return is_stalled_; });
}

void MjpegServer::Stall() {
  const std::lock_guard lock(mutex_);
  is_stalled_ = true;
  changed_.notify_all();
}

void MjpegServer::Run(const std::stop_token& stop) {
  for (int i = 0; WaitFor(listening_, POLLIN, stop);) {
    caller_ = core::Descriptor(::accept4(listening_.number(), nullptr, nullptr, SOCK_CLOEXEC));
    if (!part_) return Stall();
    bool is_there = Send(
        caller_, "HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=frame\r\n\r\n", stop);
    while (is_there) {
      const std::optional<std::string> part = part_(i++);
      if (!part) return Stall();
      const std::string head =
          "--frame\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(part->size()) +
          "\r\n\r\n";
      is_there = Send(caller_, head + *part + "\r\n", stop);
    }
  }
}

std::string Jpeg(int number) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", NumberedPicture(number), bytes);
  return {bytes.begin(), bytes.end()};
}

}  // namespace elbowroom::recon::testing
