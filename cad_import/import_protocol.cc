#include "cad_import/import_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "core/system/child_process.h"

namespace elbowroom::cad_import {
namespace {

constexpr char kProgress = 'P', kFailure = 'E', kDone = 'D', kOutOfMemory = 'M';

std::string Line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  text.resize(std::min(text.size(), kLongestMessageBytes - 1));
  return text + '\n';
}

// The number at the beginning and the space after it, which are taken off.
std::optional<std::int64_t> TakeNumber(std::string_view& text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end == text.data() + text.size() || *end != ' ') return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()) + 1);
  return number;
}

}  // namespace

std::string ToLine(const ProgressMessage& message) {
  return Line(fmt::format("{}{} {} {}", kProgress, message.done, message.total, message.what));
}

std::string ToLine(const FailureMessage& message) {
  return Line(fmt::format("{}{} {}", kFailure, static_cast<int>(message.kind), message.what));
}

std::string ToLine(const DoneMessage& /*message*/) { return Line(std::string(1, kDone)); }

ImportMessage ParseMessage(std::string_view line) {
  if (line.empty() || line.size() >= kLongestMessageBytes) return NoMessage{};
  const char kind = line.front();
  line.remove_prefix(1);
  if (kind == kDone && line.empty()) return DoneMessage{};
  if (kind == kOutOfMemory && line.empty()) return OutOfMemoryMessage{};
  if (kind != kProgress && kind != kFailure) return NoMessage{};
  const auto first = TakeNumber(line);
  if (!first) return NoMessage{};
  if (kind == kFailure) {
    if (*first < 0 || *first > static_cast<int>(core::ErrorKind::kCancelled)) return NoMessage{};
    return FailureMessage{static_cast<core::ErrorKind>(*first),
                          core::PrintableLine(line, kLongestMessageBytes)};
  }
  const auto second = TakeNumber(line);
  if (!second) return NoMessage{};
  return ProgressMessage{*first, *second, core::PrintableLine(line, kLongestMessageBytes)};
}

}  // namespace elbowroom::cad_import
