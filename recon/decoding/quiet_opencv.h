// Keeps OpenCV from writing to stderr: the user gets one line of this program instead.
#pragma once

namespace elbowroom::recon {

// Turns off OpenCV's log, its error print-out and FFmpeg's messages, for the whole process. Idempotent;
// LoadedPictureCodecs calls it.
void SilenceOpenCv();

}  // namespace elbowroom::recon
