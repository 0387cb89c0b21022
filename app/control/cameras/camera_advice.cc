#include "app/control/cameras/camera_advice.h"

#include <fmt/format.h>

#include <string>

namespace elbowroom::control {
namespace {

// A trial misses a touch of one frame; more losses than this are worth a look at cable and computer.
constexpr double kMostLostShare = 0.001;
constexpr double kDarkLevel = 20.0;
// Where a channel is at its limit, an object can't be told from the background by being brighter.
constexpr double kMostSaturatedShare = 0.01;
// Cameras of one rate need not be farther apart than half a period; a fifth is 7 ms at 30 Hz.
constexpr double kMostSkewPeriods = 0.2;

constexpr double kLeastRateShare = 0.97;

std::int64_t Count(const CameraHealth& camera, core::LossReason reason) {
  const auto found = camera.losses.find(reason);
  return found == camera.losses.end() ? 0 : found->second;
}

void AdviseOnLosses(const CameraHealth& camera, std::vector<std::string>* advice) {
  if (camera.state.presence == recon::CameraPresence::kGone)
    advice->push_back(fmt::format("it is gone: {}", camera.state.trouble));
  const double all = static_cast<double>(camera.frames + camera.lost());
  if (static_cast<double>(camera.lost()) <= kMostLostShare * all) return;
  if (const auto lost = Count(camera, core::LossReason::kIncomplete); lost > 0)
    advice->push_back(
        fmt::format("{} pictures lost packets: use one network card for the cameras alone, a shorter cable, "
                    "or larger packets (capture: packet_bytes)",
                    lost));
  if (const auto lost = Count(camera, core::LossReason::kNotSent); lost > 0)
    advice->push_back(
        fmt::format("{} pictures never came: ask for a lower rate (capture: rate_hz), or give the camera a "
                    "USB or network port of its own",
                    lost));
  if (const auto lost = Count(camera, core::LossReason::kNoRoom); lost > 0)
    advice->push_back(fmt::format("the computer was too slow for {} pictures: close other programs", lost));
  if (const auto lost = Count(camera, core::LossReason::kDamaged); lost > 0)
    advice->push_back(fmt::format("{} pictures were damaged: check the cable", lost));
  if (const auto lost = Count(camera, core::LossReason::kCameraGone);
      lost > 0 && camera.state.presence != recon::CameraPresence::kGone)
    advice->push_back(fmt::format("it was away for {} pictures: check the cable and the power", lost));
}

void AdviseOnPicture(const CameraHealth& camera, std::vector<std::string>* advice) {
  for (const std::string& warning : camera.state.report.warnings) advice->push_back(warning);
  if (camera.frames == 0) return;
  if (camera.mean_level < kDarkLevel)
    advice->push_back(
        fmt::format("its picture is dark (mean level {:.0f} of 255): open the lens, or expose longer",
                    camera.mean_level));
  if (camera.saturated_share > kMostSaturatedShare)
    advice->push_back(fmt::format("{:.0f} % of its picture are too bright: close the lens, or expose shorter",
                                  100.0 * camera.saturated_share));
  const std::optional<double>& said_hz = camera.state.report.rate_hz;
  if (said_hz && camera.rate_hz && *camera.rate_hz < kLeastRateShare * *said_hz)
    advice->push_back(
        fmt::format("it takes {:.1f} pictures a second instead of {:.1f}: expose shorter, or ask for a lower "
                    "rate (capture: rate_hz)",
                    *camera.rate_hz, *said_hz));
  const double period_ms = 1000.0 / camera.rate_hz.value_or(30.0);
  if (camera.skew_ms && camera.skew_ms->median > kMostSkewPeriods * period_ms)
    advice->push_back(
        fmt::format("it looks {:.0f} ms beside the others: connect a trigger to all cameras (capture: "
                    "trigger), or start it again",
                    camera.skew_ms->median));
}

// Its lines name the camera, as those of a trial do.
void AdviseOnLight(const CameraHealth& camera, std::vector<std::string>* advice) {
  if (!camera.light) return;
  const std::string name = fmt::format("camera '{}': ", camera.name);
  for (const std::string& line : camera.light->advice)
    advice->push_back(line.starts_with(name) ? line.substr(name.size()) : line);
}

}  // namespace

void AddAdvice(RigHealth* health) {
  for (CameraHealth& camera : health->cameras) {
    AdviseOnLosses(camera, &camera.advice);
    AdviseOnPicture(camera, &camera.advice);
    AdviseOnLight(camera, &camera.advice);
  }
}

}  // namespace elbowroom::control
