#include "recon/decoding/packet.h"

#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {

bool SendPacket(const core::Descriptor& socket, std::string_view bytes, std::span<const int> files) {
  core::Require(files.size() <= kMostFiles, "a packet carries a few files");
  if (bytes.size() > kLongestPacketBytes) return false;
  iovec part{const_cast<char*>(bytes.data()), bytes.size()};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(kMostFiles * sizeof(int))> control{};
  if (!files.empty()) {
    message.msg_control = control.data();
    message.msg_controllen = CMSG_SPACE(files.size_bytes());
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(files.size_bytes());
    std::memcpy(CMSG_DATA(header), files.data(), files.size_bytes());
  }
  ssize_t sent = 0;
  do {
    sent = ::sendmsg(socket.number(), &message, MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  return sent == static_cast<ssize_t>(bytes.size());
}

std::optional<Packet> ReceivePacket(const core::Descriptor& socket) {
  std::array<char, kLongestPacketBytes> buffer;
  iovec part{buffer.data(), buffer.size()};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(kMostFiles * sizeof(int))> control{};
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  ssize_t size = 0;
  // A peer that ended with packets unread leaves its last words behind one reset: once it is told, they are
  // read.
  bool is_reset = false;
  const auto is_worth_another_try = [&] {
    if (errno == EINTR) return true;
    return errno == ECONNRESET && !std::exchange(is_reset, true);
  };
  do {
    size = ::recvmsg(socket.number(), &message, MSG_CMSG_CLOEXEC);
  } while (size < 0 && is_worth_another_try());
  if (size <= 0) return std::nullopt;
  Packet packet{std::string(buffer.data(), static_cast<std::size_t>(size)), {}};
  for (cmsghdr* header = CMSG_FIRSTHDR(&message); header != nullptr; header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET || header->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t files = (header->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < files; ++i) {
      int number = -1;
      std::memcpy(&number, CMSG_DATA(header) + i * sizeof(int), sizeof number);
      packet.files.emplace_back(number);
    }
  }
  return packet;
}

}  // namespace elbowroom::recon
