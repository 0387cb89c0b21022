// Whether a video file holds all the bytes that its own headers promise, in the structure that they describe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace elbowroom::recon {

struct ContainerDamage {
  std::uint64_t at_byte = 0;         // where the file ends, or where its structure breaks
  std::uint64_t promised_bytes = 0;  // by its headers; at_byte where only the structure is broken
  // If an AVI's chunks are overwritten: the number of the first picture whose header is lost. The picture
  // before it may be damaged, too. A decoder leaves these pictures out, and all later ones get smaller
  // numbers.
  std::optional<std::int64_t> frame;
};

// Nothing for a whole file, and for an unknown container; known are AVI and the MP4 family. Frame counts
// aren't compared, since containers estimate them and codecs hold frames back. Damage within a chunk isn't
// found. An AVI is taken as whole if its writer left its size open (a stream), or if its RIFF size is too
// large by no more than the 8 bytes of its header.
[[nodiscard]] std::optional<ContainerDamage> FindContainerDamage(const std::filesystem::path& path);

}  // namespace elbowroom::recon
