// The message of the error that a call must end in.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"

namespace elbowroom::cad_import::testing {

// Fails the test unless `call` throws core::Error of that kind with a message of one line.
template <typename Call>
[[nodiscard]] std::string ErrorOf(core::ErrorKind kind, Call call) {
  try {
    call();
  } catch (const core::Error& error) {
    std::string message = error.what();
    EXPECT_EQ(static_cast<int>(error.kind()), static_cast<int>(kind)) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  ADD_FAILURE() << "no error";
  return "";
}

[[nodiscard]] inline bool Mentions(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

}  // namespace elbowroom::cad_import::testing
