#include "core/contact.h"

#include <array>

namespace elbowroom::core {
namespace {

constexpr std::array kVerdicts = {Verdict::kContact, Verdict::kNear, Verdict::kClear, Verdict::kUndecided};
constexpr std::array<std::string_view, 7> kRecoveryStatuses = {
    "found",     "no contact", "reference inside hull", "no direction", "no exit", "hull inside part",
    "on surface"};

}  // namespace

std::string_view ToString(Verdict verdict) {
  switch (verdict) {
    case Verdict::kContact:
      return "contact";
    case Verdict::kNear:
      return "near";
    case Verdict::kClear:
      return "clear";
    case Verdict::kUndecided:
      break;
  }
  return "undecided";
}

std::optional<Verdict> ParseVerdict(std::string_view text) {
  for (const Verdict verdict : kVerdicts) {
    if (ToString(verdict) == text) return verdict;
  }
  return std::nullopt;
}

std::string_view ToString(RecoveryStatus status) {
  return kRecoveryStatuses[static_cast<std::size_t>(status)];
}

std::optional<RecoveryStatus> ParseRecoveryStatus(std::string_view text) {
  for (std::size_t i = 0; i < kRecoveryStatuses.size(); ++i) {
    if (kRecoveryStatuses[i] == text) return static_cast<RecoveryStatus>(i);
  }
  return std::nullopt;
}

}  // namespace elbowroom::core
