// The messages between a child that imports and its parent.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "core/error.h"
#include "core/system/child_process.h"

namespace elbowroom::cad_import {

// The first argument of a child, and the descriptors that it writes to.
inline constexpr std::string_view kImportWorkerArgument = "--import-worker";
inline constexpr int kMessageDescriptor = core::kFirstGivenDescriptor;     // a pipe: lines
inline constexpr int kResultDescriptor = core::kFirstGivenDescriptor + 1;  // a file in memory: the model

// The longest line that is a message.
inline constexpr std::size_t kLongestMessageBytes = std::size_t{64} << 10U;

struct ProgressMessage {
  std::int64_t done = 0;
  std::int64_t total = 0;
  std::string what;
};
struct FailureMessage {
  core::ErrorKind kind = core::ErrorKind::kCad;
  std::string what;
};
struct OutOfMemoryMessage {};  // the child met its memory limit
struct DoneMessage {};
struct NoMessage {};  // a line that is no message: libraries print, too
using ImportMessage =
    std::variant<NoMessage, ProgressMessage, FailureMessage, OutOfMemoryMessage, DoneMessage>;

// The line of OutOfMemoryMessage, for writing without allocating.
inline constexpr std::string_view kOutOfMemoryLine = "M\n";

// One line, its end included; line breaks in texts become spaces.
[[nodiscard]] std::string ToLine(const ProgressMessage& message);
[[nodiscard]] std::string ToLine(const FailureMessage& message);
[[nodiscard]] std::string ToLine(const DoneMessage& message);
// `line` without its end.
[[nodiscard]] ImportMessage ParseMessage(std::string_view line);

}  // namespace elbowroom::cad_import
