// Encodes pictures that this program makes. The decoder does it, so that this program needn't load the
// codecs.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace elbowroom::recon {

// The bytes of a file of the kind that `extension` names: ".png", ".tiff". Throws: Error{kFile} when the
// decoder can't be started, ends, or can't encode it; PreconditionError for an image that is empty or has
// more than 8 bytes a pixel. Thread: any.
[[nodiscard]] std::vector<std::uint8_t> EncodePicture(const cv::Mat& image, const std::string& extension);

}  // namespace elbowroom::recon
