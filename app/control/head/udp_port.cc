#include "app/control/head/udp_port.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace elbowroom::control {
namespace {

sockaddr_in AddressOf(const std::string& address, int port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  if (port < 0 || port > 65535)
    throw core::Error(core::ErrorKind::kRange, fmt::format("the UDP port {} must be 1 to 65535", port));
  result.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &result.sin_addr) != 1)
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("'{}' must be an IPv4 address, as 127.0.0.1 or 0.0.0.0", address));
  return result;
}

[[noreturn]] void FailAt(const std::string& what) {
  throw core::Error(core::ErrorKind::kFile,
                    fmt::format("{}: {}", what, std::system_category().message(errno)));
}

// What the system's clock says of a datagram, on the clock that isn't set. A clock that was set in between
// makes it fresh, or stale for one datagram.
HeadClock::time_point ArrivalOf(const msghdr& message) {
  const auto now = HeadClock::now();
  for (const cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr;
       part = CMSG_NXTHDR(const_cast<msghdr*>(&message), const_cast<cmsghdr*>(part))) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
    const auto since_epoch = std::chrono::seconds(stamp.tv_sec) + std::chrono::nanoseconds(stamp.tv_nsec);
    const auto age = std::chrono::system_clock::now().time_since_epoch() - since_epoch;
    return now - std::max(std::chrono::duration_cast<HeadClock::duration>(age), HeadClock::duration::zero());
  }
  return now;
}

}  // namespace

UdpPort::UdpPort(const std::string& address, int port) {
  sockaddr_in own = AddressOf(address, port);
  socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) FailAt("no UDP socket");
  const int on = 1;
  (void)setsockopt(socket_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  socklen_t size = sizeof own;
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0 ||
      getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size) != 0) {
    const int why = errno;
    close(std::exchange(socket_, -1));
    errno = why;
    FailAt(fmt::format("UDP port {} of {} can't be listened to; another program may have it", port, address));
  }
  port_ = ntohs(own.sin_port);
}

UdpPort::~UdpPort() {
  if (socket_ >= 0) close(socket_);
}

UdpPort::UdpPort(UdpPort&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), port_(other.port_), buffer_(other.buffer_) {}

std::optional<UdpPort::Datagram> UdpPort::Receive(std::chrono::milliseconds patience) {
  pollfd waiting{socket_, POLLIN, 0};
  if (poll(&waiting, 1, static_cast<int>(patience.count())) <= 0) return std::nullopt;
  iovec data{buffer_.data(), buffer_.size()};
  alignas(cmsghdr) std::array<char, 128> control{};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t length = recvmsg(socket_, &message, 0);
  if (length < 0) return std::nullopt;
  return Datagram{std::span(buffer_).first(static_cast<std::size_t>(length)), ArrivalOf(message)};
}

void SendDatagram(const std::string& address, int port, std::span<const std::byte> bytes) {
  const sockaddr_in to = AddressOf(address, port);
  const int out = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (out < 0) FailAt("no UDP socket");
  const auto sent =
      sendto(out, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  const int why = errno;
  close(out);
  errno = why;
  if (sent != static_cast<ssize_t>(bytes.size())) FailAt(fmt::format("UDP to {}:{}", address, port));
}

}  // namespace elbowroom::control
