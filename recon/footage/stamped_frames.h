// Frames of cameras that share no clock, put together by their stamps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/ids.h"

namespace elbowroom::recon {

// A frame's time in s, by its number; frames without a stamp have none.
using FrameStamps = std::vector<std::optional<double>>;

// Reads a table with the columns frame and time_s, further columns being ignored. `who` begins the messages,
// as in "camera 'cam1'". Throws: Error{kFile} if it can't be read; Error{kFormat} naming the line for a
// missing column, a value that is no number, a frame that occurs twice, or a stamp that isn't later than the
// one of the frame before it.
[[nodiscard]] FrameStamps ReadFrameStamps(const std::filesystem::path& path, const std::string& who);

// The same table with its column `picture`: the numbers that the camera's pictures had when they came.
struct FrameTable {
  FrameStamps time_s;
  std::vector<std::uint64_t> pictures;  // by frame, 0 without a stamp; empty: the table has no such column
};

// Throws: as ReadFrameStamps; Error{kFormat} also for a picture that is no number.
[[nodiscard]] FrameTable ReadFrameTable(const std::filesystem::path& path, const std::string& who);

struct StampedFrame {
  core::FrameIndex frame = 0;
  double time_s = 0.0;

  [[nodiscard]] bool operator==(const StampedFrame&) const = default;
};

// One frame of each camera, as near in time as there are.
struct StampedSet {
  std::vector<std::optional<StampedFrame>> frames;  // by camera; nothing: none is near
};

// The sets of all cameras in the order of time. Each frame is in one set at most. The camera with the fewest
// stamps decides when sets are; of another camera the frame belongs to it that is the nearest in time, at
// most half of that camera's own median period away. Empty if a camera has no stamps.
[[nodiscard]] std::vector<StampedSet> SetsByNearestStamp(std::span<const FrameStamps> cameras);

// The sets of footage in which cameras lost pictures, from the latest of the first stamps to the earliest of
// the last ones. Of the slowest cameras, that one leads which is the nearest to the others; each of its
// frames makes a set, as above. Where frames of it are missing, the times at which they were due take their
// places, so that no time is left out as long as one camera has pictures. Empty if a camera has no stamps.
[[nodiscard]] std::vector<StampedSet> SetsOfAllTimes(std::span<const FrameStamps> cameras);

// The median time between one stamp and the next, in s. Nothing with fewer than two stamps.
[[nodiscard]] std::optional<double> MedianPeriod(const FrameStamps& stamps);

}  // namespace elbowroom::recon
