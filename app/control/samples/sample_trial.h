// The paper's scenes as trials that need no cameras: each begins at once.
#pragma once

#include <optional>
#include <string_view>

#include "app/control/trial_setup.h"

namespace elbowroom::control {

enum class Sample {
  kPayload,  // the payload task: the demo
  kCurtain,  // a curtain before a window, which two hands push aside
  kFaucet,   // a faucet, whose water two cupped hands catch
};
inline constexpr Sample kSamples[] = {Sample::kPayload, Sample::kCurtain, Sample::kFaucet};

[[nodiscard]] std::optional<Sample> ParseSample(std::string_view text);  // "payload", "curtain", "faucet"
[[nodiscard]] std::string_view ToString(Sample sample);

// Four simulated 640 x 480 cameras, without an end.
[[nodiscard]] TrialSetup MakeSampleTrial(Sample sample);

}  // namespace elbowroom::control
