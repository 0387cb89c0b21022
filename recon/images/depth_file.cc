#include "recon/images/depth_file.h"

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/error.h"
#include "recon/images/picture_encoder.h"

namespace elbowroom::recon {

std::string EncodeDepthTiff(const DepthMap& picture) {
  core::Require(picture.width_px > 0 && picture.height_px > 0, "a depth map to encode has pixels");
  core::Require(picture.depth_mm.size() ==
                    static_cast<std::size_t>(picture.width_px) * static_cast<std::size_t>(picture.height_px),
                "a depth map holds a float a pixel");
  // OpenCV's header type takes a mutable pointer; the encoder only reads it.
  const cv::Mat depth(picture.height_px, picture.width_px, CV_32FC1,
                      const_cast<float*>(picture.depth_mm.data()));
  const std::vector<std::uint8_t> tiff = EncodePicture(depth, ".tiff");
  return {tiff.begin(), tiff.end()};
}

}  // namespace elbowroom::recon
