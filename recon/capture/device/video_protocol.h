// The messages between this program and a camera program that writes a video (docs/capture.md).
#pragma once

#include <cstdint>
#include <string_view>

namespace elbowroom::recon {

// As location in a CameraOrder: write pictures to the video whose path follows. Width, height and rate are
// those of the pictures; the shared memory is the same as for a camera.
inline constexpr std::string_view kWriteOrder = "write ";

enum class VideoCommandKind : std::int32_t {
  kWrite,   // the picture in `slot`
  kFinish,  // no more pictures come: bring the whole file to the disk, and end
};
struct VideoCommand {
  VideoCommandKind kind = VideoCommandKind::kWrite;
  std::int32_t slot = 0;
};

enum class VideoNewsKind : std::int32_t {
  kSlotBack,  // the picture in `slot` is taken over
  kFinished,  // all pictures are in the file, and the file is on the disk
  kFailed,    // the text says why; the program ends, and the file is of no use
};
struct VideoNews {
  VideoNewsKind kind = VideoNewsKind::kSlotBack;
  std::int32_t slot = -1;
};

}  // namespace elbowroom::recon
