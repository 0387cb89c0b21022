// The decoder's first process: loads the codecs once, then makes a worker for every source.
#pragma once

namespace elbowroom::recon {

// Takes orders (recon/decoding/picture_protocol.h) until the program that started this one is gone, and ends
// then, its workers with it. A worker is a fork: it has the codecs at once, and no thread of this process is
// lost to it, since there is only one.
[[noreturn]] void ServePictures();

}  // namespace elbowroom::recon
