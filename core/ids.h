// The numbers by which all rooms name parts, spacings, groups, cameras, frames and episodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace elbowroom::core {

using PartIndex = std::size_t;     // position in Layout::parts
using SpacingIndex = std::size_t;  // position in Layout::spacings
using GroupIndex = std::size_t;    // position in Layout::groups
using CameraIndex = std::size_t;   // position in Rig::cameras
using FrameIndex = std::int64_t;   // 0 is the first frame of the footage, not of the trial's range
using EpisodeId = std::int64_t;    // counts from 1 within a session

// 32 hexadecimal digits that name a touch or near miss. Its replays have the same (core/findings).
using FindingId = std::string;

}  // namespace elbowroom::core
