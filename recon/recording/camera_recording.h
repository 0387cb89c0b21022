// What was recorded of one camera.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace elbowroom::recon {

// Pictures first to last aren't in the video.
struct MissingPictures {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  std::string
      reason;  // as core::ToString(LossReason) of a lost one; of an unwritten one kNotWritten or other

  [[nodiscard]] std::uint64_t count() const { return last - first + 1; }
  [[nodiscard]] bool operator==(const MissingPictures&) const = default;
};

// The picture came, and the disk or the encoder was too slow to take it.
inline constexpr const char* kNotWritten = "not written";
// The picture's stamp was no later than the one before, so that it belongs nowhere.
inline constexpr const char* kStampGoesBack = "stamp goes back";

struct CameraRecording {
  std::string name;
  std::filesystem::path video;           // empty: none is whole
  std::filesystem::path timestamps;      // columns frame,time_s,picture
  std::int64_t frames = 0;               // in the video
  std::uint64_t lost = 0;                // pictures that never came
  std::uint64_t unwritten = 0;           // pictures that came and aren't in the video
  std::vector<MissingPictures> missing;  // all of those two, by number
  std::uint64_t bytes = 0;
  std::string trouble;  // why the video isn't there, or ended before the recording did; empty: it didn't
};

}  // namespace elbowroom::recon
