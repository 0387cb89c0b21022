#include "recon/headset/headset_protocol.h"

namespace elbowroom::recon {

std::string_view ToString(HeadsetPhase phase) {
  switch (phase) {
    case HeadsetPhase::kStarting:
      return "starting";
    case HeadsetPhase::kIdle:
      return "idle";
    case HeadsetPhase::kRunning:
      return "running";
    case HeadsetPhase::kVisible:
      return "visible";
    case HeadsetPhase::kFocused:
      return "focused";
    case HeadsetPhase::kStopping:
      return "stopping";
    case HeadsetPhase::kRecentred:
      return "recentred";
    case HeadsetPhase::kSilent:
      return "silent";
    case HeadsetPhase::kLost:
      return "lost";
    case HeadsetPhase::kRefused:
      return "refused";
    case HeadsetPhase::kEnded:
      return "ended";
  }
  return "";
}

}  // namespace elbowroom::recon
