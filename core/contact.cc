#include "core/contact.h"

#include <array>

namespace elbowroom::core {
namespace {

constexpr std::array<std::string_view, 4> kVerdicts = {"contact", "near", "clear", "undecided"};
constexpr std::array<std::string_view, 7> kRecoveryStatuses = {
    "found",     "no contact", "reference inside hull", "no direction", "no exit", "hull inside part",
    "on surface"};

}  // namespace

std::string_view ToString(Verdict verdict) { return kVerdicts[static_cast<std::size_t>(verdict)]; }

std::optional<Verdict> ParseVerdict(std::string_view text) {
  for (std::size_t i = 0; i < kVerdicts.size(); ++i) {
    if (kVerdicts[i] == text) return static_cast<Verdict>(i);
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
