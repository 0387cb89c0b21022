#include "core/picture_loss.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>

namespace elbowroom::core {
namespace {

constexpr std::array<std::string_view, 7> kReasons{"not sent", "incomplete",  "damaged", "camera gone",
                                                   "no room",  "passed over", "unpaired"};

}  // namespace

std::string_view ToString(LossReason reason) { return kReasons[static_cast<std::size_t>(reason)]; }

std::optional<LossReason> ParseLossReason(std::string_view text) {
  for (std::size_t i = 0; i < kReasons.size(); ++i)
    if (kReasons[i] == text) return static_cast<LossReason>(i);
  return std::nullopt;
}

std::string TextOf(const PictureLoss& loss, std::string_view camera_name) {
  const std::string which = loss.first == loss.last
                                ? fmt::format("picture {} was", loss.first)
                                : fmt::format("pictures {} to {} were", loss.first, loss.last);
  return fmt::format("camera '{}': {} lost ({})", camera_name, which, ToString(loss.reason));
}

}  // namespace elbowroom::core
