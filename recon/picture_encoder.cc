#include "recon/picture_encoder.h"

#include <fmt/format.h>

#include <cstring>

#include "core/error.h"
#include "recon/picture_worker.h"

namespace elbowroom::recon {

std::vector<std::uint8_t> EncodePicture(const cv::Mat& image, const std::string& extension) {
  core::Require(!image.empty() && image.elemSize() <= 8, "a picture to encode has pixels of up to 8 bytes");
  const std::size_t row_bytes = static_cast<std::size_t>(image.cols) * image.elemSize();
  const auto rows = static_cast<std::size_t>(image.rows);
  // What doesn't pack at all gets a little larger.
  const auto most_bytes = static_cast<std::int64_t>(rows * row_bytes * 5 / 4 + (std::size_t{1} << 16U));
  PictureWorker worker({image.cols, image.rows, most_bytes, SourceMemory::kPicture});
  for (int row = 0; row < image.rows; ++row)
    std::memcpy(worker.pixel_bytes().data() + static_cast<std::size_t>(row) * row_bytes, image.ptr(row),
                row_bytes);
  const PictureRequest request{
      .task = PictureTask::kEncode, .width_px = image.cols, .height_px = image.rows, .type = image.type()};
  const PictureAnswer answer = worker.Ask(request, extension, {}, std::nullopt);
  const std::int64_t size = answer.reply.file_bytes;
  if (answer.reply.outcome != PictureOutcome::kDone || size <= 0 || size > most_bytes) {
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("a picture can't be packed as {} ({}); close other programs and try it again", extension,
                    answer.complaint.empty() ? "no answer" : answer.complaint));
  }
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(worker.file_bytes().data());
  return {bytes, bytes + size};
}

}  // namespace elbowroom::recon
