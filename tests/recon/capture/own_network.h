// A network of its own for a test: cameras of other tests, and of the house, aren't in it.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace elbowroom::recon::testing {

// This process, and all that it starts from now on, gets a loopback network of its own, with the addresses
// LoopbackAddress(0) to LoopbackAddress(addresses - 1). It has one thread when this is called. Throws:
// std::runtime_error where the system doesn't allow that.
void EnterOwnNetwork(int addresses);

// The same for all tests of a program.
class OwnNetwork : public ::testing::Environment {
 public:
  explicit OwnNetwork(int addresses) : addresses_(addresses) {}
  void SetUp() override { EnterOwnNetwork(addresses_); }

 private:
  int addresses_;
};

[[nodiscard]] std::string LoopbackAddress(int i);  // "127.0.0.1", "127.0.0.2", ...

}  // namespace elbowroom::recon::testing
