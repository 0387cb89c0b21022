// Whether a video file holds all the bytes that its own headers promise, in the structure that they say.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace elbowroom::recon {

struct ContainerDamage {
  std::uint64_t at_byte = 0;         // where the file ends, or where its structure breaks
  std::uint64_t promised_bytes = 0;  // by its headers; at_byte where only the structure is broken
  // Where an AVI's chunks are overwritten: of the first picture without a header. The one before may be hit
  // too. A decoder leaves these pictures out, and all that follow get smaller numbers.
  std::optional<std::int64_t> frame;
};

// Nothing for a whole file, and for a container that this does not know (it knows AVI and the MP4 family).
// Frame counts play no part: containers estimate them, and codecs hold frames back. What is overwritten
// within a chunk isn't seen. An AVI whose writer left its size open (a stream) is taken as whole, as is one
// whose headers overstep by no more than their own 8 bytes.
[[nodiscard]] std::optional<ContainerDamage> FindContainerDamage(const std::filesystem::path& path);

}  // namespace elbowroom::recon
