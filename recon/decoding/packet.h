// Packets between this program and its decoder: a value, some text, and open files.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/system/child_process.h"

namespace elbowroom::recon {

struct Packet {
  std::string bytes;
  std::vector<core::Descriptor> files;

  // The value at the beginning; nothing if the packet is shorter than that.
  template <typename Value>
  [[nodiscard]] std::optional<Value> Head() const {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value{};
    if (bytes.size() < sizeof value) return std::nullopt;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  // The bytes after that value.
  template <typename Value>
  [[nodiscard]] std::string_view Text() const {
    return std::string_view(bytes).substr(std::min(sizeof(Value), bytes.size()));
  }
};

inline constexpr std::size_t kLongestPacketBytes = std::size_t{16} << 10U;
inline constexpr std::size_t kMostFiles = 4;

// False if it can't be sent: its other end is closed, or it is longer than kLongestPacketBytes. Throws:
// PreconditionError for more than kMostFiles files.
[[nodiscard]] bool SendPacket(const core::Descriptor& socket, std::string_view bytes,
                              std::span<const int> files = {});

template <typename Value>
[[nodiscard]] bool SendPacket(const core::Descriptor& socket, const Value& value, std::string_view text = {},
                              std::span<const int> files = {}) {
  static_assert(std::is_trivially_copyable_v<Value>);
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
  bytes += text;
  return SendPacket(socket, std::string_view(bytes), files);
}

// Waits for a packet. Nothing if the other end is closed.
[[nodiscard]] std::optional<Packet> ReceivePacket(const core::Descriptor& socket);

}  // namespace elbowroom::recon
