// OpenCV writes to stderr on its own; the user gets one line, and it is ours.
#pragma once

namespace elbowroom::recon {

// Turns off OpenCV's log, its error print-out and FFmpeg's messages, for the whole process. Idempotent;
// called before every use of OpenCV's readers.
void SilenceOpenCv();

}  // namespace elbowroom::recon
