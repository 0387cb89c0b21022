// Expects a core::Error of one kind whose single line mentions what the user must know.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"

namespace elbowroom::tests {

template <typename Work>
void ExpectError(Work&& work, core::ErrorKind kind, const std::string& part_of_message) {
  try {
    work();
    ADD_FAILURE() << "no error; expected one that says: " << part_of_message;
  } catch (const core::Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(error.kind(), kind) << message;
    EXPECT_NE(message.find(part_of_message), std::string::npos)
        << message << "\ndoesn't say: " << part_of_message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

}  // namespace elbowroom::tests
