// Masks as pictures: `segment` writes them, and ready masks are read from them.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

#include "core/bit_mask.h"
#include "recon/images/picture_header.h"

namespace elbowroom::recon {

// Object where any channel but alpha is not zero; 8 or 16 bit, 1, 3 or 4 channels.
[[nodiscard]] core::BitMask MaskFromImage(const cv::Mat& image);

// 8-bit, one channel: object 255, background 0.
[[nodiscard]] cv::Mat ImageFromMask(const core::BitMask& mask);

// Throws: Error{kFormat} naming `who` and the file for a JPEG: its rounding makes background pixels non-zero.
void RequireExactMask(const PictureHeader& header, const std::filesystem::path& path, const std::string& who);

// Throws: as RequireExactMask; Error{kFile} naming `who` and the file if it can't be read whole.
[[nodiscard]] core::BitMask ReadMaskImage(const std::filesystem::path& path, const std::string& who);

// Writes the whole file or nothing. Throws: Error{kFile}.
void WriteMaskPng(const core::BitMask& mask, const std::filesystem::path& path);

}  // namespace elbowroom::recon
