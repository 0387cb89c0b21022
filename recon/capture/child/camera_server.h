// What a camera program does: it serves one live camera to the program that started it.
#pragma once

namespace elbowroom::recon {

// Takes its order (recon/capture/device/camera_protocol.h), opens the camera, and tells of each picture until
// the other end is closed or the camera is gone; then the process exits. Its memory is limited. A picture
// that finds no slot free is left out, and told of as such.
[[noreturn]] void ServeCamera();

}  // namespace elbowroom::recon
