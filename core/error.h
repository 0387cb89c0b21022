// The two kinds of failure that are thrown; the third kind, a legitimate "no", lives in return types.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace elbowroom::core {

enum class ErrorKind { kFile, kFormat, kCamera, kGeometry, kGraphics, kDatabase, kCad, kRange, kCancelled };

// The world failed: what() is one line that says what, where, and what to do about it.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  [[nodiscard]] ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

// The caller is wrong: a bug, not a condition to handle.
class PreconditionError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] void ThrowPreconditionError(std::string_view what_must_hold);

// Throws: PreconditionError naming `what_must_hold` unless `condition`.
inline void Require(bool condition, std::string_view what_must_hold) {
  if (!condition) ThrowPreconditionError(what_must_hold);
}

}  // namespace elbowroom::core
