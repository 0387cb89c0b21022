// The decoder's first process: loads the codecs once, then makes a worker for every source.
#pragma once

namespace elbowroom::recon {

// Takes orders (recon/decoding/picture_protocol.h) until the program that started this one is gone. Then it
// kills its workers and exits. A worker is a fork of this process, so it has the codecs at once. A fork
// copies the calling thread only; this process has no other.
[[noreturn]] void ServePictures();

}  // namespace elbowroom::recon
