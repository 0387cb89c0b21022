// What the operator chose for the participant's view, over the program's runs.
#pragma once

#include <QString>

#include "app/control/head/head_settings.h"
#include "app/control/participant/eye_views.h"

namespace elbowroom::console {

struct ParticipantChoices {
  recon::HeadSource source = recon::HeadSource::kFixed;
  int port = control::kOpenTrackPort;  // of OpenTrack or FreeD
  QString head_file;                   // HEAD.toml; empty: no registration, the eight-sided cap
  control::EyeOptions eyes;
  int camera = 1;   // whose picture is shown in the camera's modes; from 1
  QString display;  // a screen's name; empty: the last one there is
  bool fills_display = true;
};

[[nodiscard]] ParticipantChoices RememberedChoices();
void RememberChoices(const ParticipantChoices& choices);

// Those of the head file, where there is one, with the choices' source and port. Throws: ReadHeadFile.
[[nodiscard]] control::HeadSettings HeadSettingsOf(const ParticipantChoices& choices);

}  // namespace elbowroom::console
