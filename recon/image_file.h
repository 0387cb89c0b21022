// Images read from files, with every defect found instead of decoded over.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

namespace elbowroom::recon {

// The picture as stored (8 or 16 bit, 1, 3 or 4 channels); `who` opens the message, as in "camera 'cam01'".
//
// Throws: Error{kFile} naming `who` and the file: missing, empty, cut short (a PNG without its end, a JPEG
// without its end marker: decoders fill the rest with grey and say nothing), or no image.
[[nodiscard]] cv::Mat ReadImageAsStored(const std::filesystem::path& path, const std::string& who);

// The picture as 8-bit BGR. Throws: as above.
[[nodiscard]] cv::Mat ReadImageBgr(const std::filesystem::path& path, const std::string& who);

// True for a file that begins as a JPEG does.
[[nodiscard]] bool IsJpeg(const std::filesystem::path& path);

}  // namespace elbowroom::recon
