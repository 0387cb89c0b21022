// The pictures' memory as a camera program sees it.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace elbowroom::recon {

// All kPictureSlots of the shared memory, CV_8UC3; they stay mapped until the process ends. Empty: there is
// no memory.
[[nodiscard]] std::vector<cv::Mat> MapSlots(cv::Size size_px);

}  // namespace elbowroom::recon
