// Pictures as cameras lay them out, turned into BGR.
#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <span>

namespace elbowroom::recon {

enum class PixelLayout { kMono8, kRgb8, kBgr8, kBayerRg8, kBayerGr8, kBayerGb8, kBayerBg8, kYuyv };

[[nodiscard]] std::size_t BytesPerRow(PixelLayout layout, int width_px);

// Writes the picture in `bytes`, rows of `row_bytes` each, into `image_bgr`, which keeps its memory if it is
// CV_8UC3 of that size. Bayer layouts are named by the first two pixels of the first row and interpolated
// bilinearly. Throws: PreconditionError if `bytes` are too few, or for rows shorter than BytesPerRow.
void ToBgr(std::span<const std::byte> bytes, PixelLayout layout, cv::Size size_px, std::size_t row_bytes,
           cv::Mat& image_bgr);

}  // namespace elbowroom::recon
