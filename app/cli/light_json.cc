#include "app/cli/light_json.h"

namespace elbowroom::cli {

nlohmann::json FlickerHz(const std::optional<recon::LightPulse>& pulse) {
  if (!pulse) return nullptr;
  return pulse->lamp_hz.value_or(pulse->seen_hz);
}

nlohmann::json JsonOf(const recon::LightReport& light) {
  nlohmann::json json = {{"name", light.camera},
                         {"time_s", light.time_s},
                         {"gain", light.gain},
                         {"gain_bgr", light.gain_bgr},
                         {"agreeing_share", light.agreeing_share},
                         {"drift_share_per_hour", nullptr},
                         {"flicker_hz", FlickerHz(light.pulse)},
                         {"flicker_share", nullptr},
                         {"hidden_mains_hz", light.hidden_mains_hz},
                         {"changes", nlohmann::json::array()},
                         {"advice", light.advice}};
  if (light.drift) json["drift_share_per_hour"] = light.drift->share_per_hour;
  if (light.pulse) json["flicker_share"] = light.pulse->amplitude_share;
  for (const recon::LastingChange& change : light.changes) {
    json["changes"].push_back(
        {{"box_px", {change.box_px.x, change.box_px.y, change.box_px.width, change.box_px.height}},
         {"share", change.share},
         {"object_share", change.object_share}});
  }
  return json;
}

}  // namespace elbowroom::cli
