#include "recon/decoding/packet.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <optional>
#include <string>

namespace elbowroom::recon {
namespace {

struct Ends {
  core::Descriptor here, there;
};

Ends ConnectedEnds() {
  int numbers[2] = {-1, -1};
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, numbers), 0);
  return {core::Descriptor(numbers[0]), core::Descriptor(numbers[1])};
}

// A program that fails says why and ends, while orders to it are still under way.
TEST(Packet, LastWordsAreReadFromAPeerThatLeftPacketsUnread) {
  Ends ends = ConnectedEnds();
  ASSERT_TRUE(SendPacket(ends.here, std::string_view("an order that nobody reads")));
  ASSERT_TRUE(SendPacket(ends.there, std::string_view("the disk is full")));
  ends.there = core::Descriptor();
  const std::optional<Packet> packet = ReceivePacket(ends.here);
  ASSERT_TRUE(packet.has_value());
  EXPECT_EQ(packet->bytes, "the disk is full");
  EXPECT_FALSE(ReceivePacket(ends.here).has_value());
}

TEST(Packet, APeerThatEndsWithoutAWordIsTheEnd) {
  Ends ends = ConnectedEnds();
  ASSERT_TRUE(SendPacket(ends.here, std::string_view("an order that nobody reads")));
  ends.there = core::Descriptor();
  EXPECT_FALSE(ReceivePacket(ends.here).has_value());
  EXPECT_FALSE(ReceivePacket(ends.here).has_value());
}

}  // namespace
}  // namespace elbowroom::recon
