// Our own pictures to files. The codecs are in the decoder, so that this program needn't load them, too.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace elbowroom::recon {

// The bytes of a file of the kind that `extension` names: ".png", ".tiff". Throws: Error{kFile} when the
// decoder can't be started, or ends. Thread: any.
[[nodiscard]] std::vector<std::uint8_t> EncodePicture(const cv::Mat& image, const std::string& extension);

}  // namespace elbowroom::recon
