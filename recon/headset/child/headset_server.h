// What the headset program does: it asks the OpenXR runtime for poses, and gives it pictures.
#pragma once

namespace elbowroom::recon {

// Serves the order that comes through its socket until the other end is closed or the runtime ends. A call of
// the runtime may take for ever: then the program is killed by the one that started it.
void ServeHeadset();

}  // namespace elbowroom::recon
