#include "tests/recon/capture/own_network.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstring>
#include <stdexcept>

#include "core/system/child_process.h"

namespace elbowroom::recon::testing {
namespace {

void RequireDone(bool is_done, const char* what) {
  if (!is_done) throw std::runtime_error(fmt::format("{}: {}", what, std::strerror(errno)));
}

ifreq RequestFor(const std::string& device) {
  ifreq request{};
  std::strncpy(request.ifr_name, device.c_str(), IFNAMSIZ - 1);
  return request;
}

void SetAddress(const core::Descriptor& socket, const std::string& device, unsigned long what,
                const std::string& address) {
  ifreq request = RequestFor(device);
  sockaddr_in value{};
  value.sin_family = AF_INET;
  ::inet_pton(AF_INET, address.c_str(), &value.sin_addr);
  std::memcpy(&request.ifr_addr, &value, sizeof value);
  RequireDone(::ioctl(socket.number(), what, &request) == 0, "an address of the loopback network");
}

}  // namespace

std::string LoopbackAddress(int i) { return fmt::format("127.0.0.{}", i + 1); }

void EnterOwnNetwork(int addresses) {
  const int as_root = ::geteuid() == 0 ? 0 : CLONE_NEWUSER;
  RequireDone(::unshare(CLONE_NEWNET | as_root) == 0, "a network of its own (unshare)");
  const core::Descriptor socket(::socket(AF_INET, SOCK_DGRAM, 0));
  for (int i = 0; i < addresses; ++i) {
    const std::string device = i == 0 ? "lo" : fmt::format("lo:{}", i);
    SetAddress(socket, device, SIOCSIFADDR, LoopbackAddress(i));
    SetAddress(socket, device, SIOCSIFNETMASK, i == 0 ? "255.0.0.0" : "255.255.255.255");
  }
  ifreq request = RequestFor("lo");
  RequireDone(::ioctl(socket.number(), SIOCGIFFLAGS, &request) == 0, "the loopback device");
  request.ifr_flags |= IFF_UP;
  RequireDone(::ioctl(socket.number(), SIOCSIFFLAGS, &request) == 0, "switching the loopback device on");
}

}  // namespace elbowroom::recon::testing
