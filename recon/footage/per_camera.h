// Work on all cameras of a rig at once, each in a thread of its own.
#pragma once

#include <cstddef>
#include <functional>

#include "core/ids.h"

namespace elbowroom::recon {

// Runs work(0) .. work(cameras - 1), each in its thread, and meanwhile() on the calling one; returns when all
// are done. Throws: what `meanwhile` threw; else what the camera of the lowest index threw, even if another
// threw earlier.
void RunPerCamera(
    std::size_t cameras, const std::function<void(core::CameraIndex)>& work,
    const std::function<void()>& meanwhile = [] {});

}  // namespace elbowroom::recon
