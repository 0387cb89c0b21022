// A decoder's worker: what it does for one source.
#pragma once

#include "core/system/child_process.h"
#include "recon/decoding/picture_codecs.h"
#include "recon/decoding/picture_protocol.h"

namespace elbowroom::recon {

// Answers requests until the other end is closed. It limits its own memory first. What the codecs print is
// caught; a line that tells of damage goes into the answer.
[[noreturn]] void WorkForOneSource(const PictureCodecs& codecs, const WorkerOrder& order,
                                   const core::Descriptor& socket, const core::Descriptor& memory);

}  // namespace elbowroom::recon
