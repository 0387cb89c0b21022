#include "app/console/participant/participant_choices.h"

#include <QSettings>
#include <algorithm>

namespace elbowroom::console {
namespace {

constexpr const char* kGroup = "participant";

QString TextOf(std::string_view text) {
  return QString::fromUtf8(text.data(), static_cast<qsizetype>(text.size()));
}

// Settings may hold anything: what is out of range becomes the nearest that isn't.
double Within(const QSettings& settings, const char* key, double otherwise, double least, double most) {
  bool is_number = false;
  const double value = settings.value(key, otherwise).toDouble(&is_number);
  return is_number && value == value ? std::clamp(value, least, most) : otherwise;
}

}  // namespace

ParticipantChoices RememberedChoices() {
  QSettings settings;
  settings.beginGroup(kGroup);
  ParticipantChoices choices;
  choices.source =
      control::ParseHeadSource(settings.value("source").toString().toStdString()).value_or(choices.source);
  choices.port = static_cast<int>(Within(settings, "port", choices.port, 1.0, 65535.0));
  choices.head_file = settings.value("head_file").toString();
  choices.eyes.mode =
      control::ParseViewMode(settings.value("mode").toString().toStdString()).value_or(choices.eyes.mode);
  choices.eyes.ipd_mm = Within(settings, "ipd_mm", choices.eyes.ipd_mm, 0.0, 100.0);
  choices.eyes.vertical_fov_rad =
      Within(settings, "vertical_fov_rad", choices.eyes.vertical_fov_rad, 0.2, 2.4);
  choices.eyes.convergence_mm =
      Within(settings, "convergence_mm", choices.eyes.convergence_mm, 100.0, 10'000.0);
  choices.camera = static_cast<int>(Within(settings, "camera", choices.camera, 1.0, 64.0));
  choices.display = settings.value("display").toString();
  choices.fills_display = settings.value("fills_display", choices.fills_display).toBool();
  return choices;
}

void RememberChoices(const ParticipantChoices& choices) {
  QSettings settings;
  settings.beginGroup(kGroup);
  settings.setValue("source", TextOf(recon::ToString(choices.source)));
  settings.setValue("port", choices.port);
  settings.setValue("head_file", choices.head_file);
  settings.setValue("mode", TextOf(control::ToString(choices.eyes.mode)));
  settings.setValue("ipd_mm", choices.eyes.ipd_mm);
  settings.setValue("vertical_fov_rad", choices.eyes.vertical_fov_rad);
  settings.setValue("convergence_mm", choices.eyes.convergence_mm);
  settings.setValue("camera", choices.camera);
  settings.setValue("display", choices.display);
  settings.setValue("fills_display", choices.fills_display);
}

control::HeadSettings HeadSettingsOf(const ParticipantChoices& choices) {
  control::HeadSettings settings;
  if (!choices.head_file.isEmpty()) settings = control::ReadHeadFile(choices.head_file.toStdString());
  settings.source = choices.source;
  settings.port = choices.port;
  return settings;
}

}  // namespace elbowroom::console
