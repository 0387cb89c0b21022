// Encodes and writes pictures as PNG.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "recon/images/image.h"

namespace elbowroom::recon {

// Throws: PreconditionError when the image is empty or its bytes don't match its size; Error{kFile} as
// EncodePicture.
[[nodiscard]] std::vector<std::uint8_t> EncodePng(const Image& image);

// Writes the whole file or nothing: it is written beside `path`, then renamed over it. Throws: Error{kFile}
// naming the path when its folder is missing or can't be written; others as EncodePng.
void WritePng(const Image& image, const std::filesystem::path& path);

}  // namespace elbowroom::recon
