// A UDP port that is listened to.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "app/control/head/head_pose_holder.h"

namespace elbowroom::control {

// Move-only. Thread: one.
class UdpPort {
 public:
  struct Datagram {
    std::span<const std::byte> bytes;  // valid until the next Receive
    HeadClock::time_point came_at;     // at the computer, as the system stamped it; not when it was read
  };

  // `address`: of this computer, as "127.0.0.1" or "0.0.0.0" (all of its networks). Port 0: any that is free.
  // Throws: Error{kRange} for what isn't an IPv4 address or a port; Error{kFile} naming the port if it is in
  // use.
  UdpPort(const std::string& address, int port);
  ~UdpPort();
  UdpPort(UdpPort&& other) noexcept;
  UdpPort& operator=(UdpPort&&) = delete;

  [[nodiscard]] int port() const { return port_; }

  // The next datagram; nothing: none came in that time. One longer than kLongest is cut off at that.
  [[nodiscard]] std::optional<Datagram> Receive(std::chrono::milliseconds patience);

 private:
  static constexpr std::size_t kLongest = 512;

  int socket_ = -1;
  int port_ = 0;
  std::array<std::byte, kLongest> buffer_{};
};

// Sends one datagram. Throws: Error{kRange}, Error{kFile}.
void SendDatagram(const std::string& address, int port, std::span<const std::byte> bytes);

}  // namespace elbowroom::control
