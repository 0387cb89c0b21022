#include "recon/rig_files/capture_settings.h"

#include "core/error.h"

namespace elbowroom::recon {

std::string_view ToString(CaptureTrigger trigger) {
  switch (trigger) {
    case CaptureTrigger::kFree:
      return "free";
    case CaptureTrigger::kSoftware:
      return "software";
    case CaptureTrigger::kHardware:
      return "hardware";
  }
  throw core::PreconditionError("this trigger has no name");
}

std::optional<CaptureTrigger> ParseCaptureTrigger(std::string_view text) {
  for (const CaptureTrigger trigger :
       {CaptureTrigger::kFree, CaptureTrigger::kSoftware, CaptureTrigger::kHardware})
    if (text == ToString(trigger)) return trigger;
  return std::nullopt;
}

}  // namespace elbowroom::recon
