// What is said of a camera's light, as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "recon/light/light_report.h"

namespace elbowroom::cli {

// The lamps' own pulse where it is known, else the one that the pictures show; null: the light doesn't pulse.
[[nodiscard]] nlohmann::json FlickerHz(const std::optional<recon::LightPulse>& pulse);

// camera, gain, drift, flicker, lasting changes and advice.
[[nodiscard]] nlohmann::json JsonOf(const recon::LightReport& light);

}  // namespace elbowroom::cli
