#include "recon/images/picture_encoder.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstring>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "core/error.h"
#include "recon/decoding/picture_worker.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;

// Keeps its worker for the next picture, since starting one costs as much as encoding a small picture.
class Encoder {
 public:
  std::vector<std::uint8_t> Encode(const cv::Mat& image, const std::string& extension) {
    const std::lock_guard lock(mutex_);
    PictureWorker& worker = WorkerFor(image);
    const std::size_t row_bytes = static_cast<std::size_t>(image.cols) * image.elemSize();
    for (int row = 0; row < image.rows; ++row)
      std::memcpy(worker.pixel_bytes().data() + static_cast<std::size_t>(row) * row_bytes, image.ptr(row),
                  row_bytes);
    const PictureRequest request{
        .task = PictureTask::kEncode, .width_px = image.cols, .height_px = image.rows, .type = image.type()};
    const PictureAnswer answer = worker.Ask(request, extension, {}, std::nullopt);
    const std::span<const std::byte> file = worker.file_bytes();
    const std::int64_t size = answer.reply.file_bytes;
    if (answer.reply.outcome != PictureOutcome::kDone || size <= 0 || size > std::ssize(file)) {
      throw Error(ErrorKind::kFile,
                  fmt::format("a picture can't be packed as {} ({}); close other programs and try it again",
                              extension, answer.complaint.empty() ? "no answer" : answer.complaint));
    }
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(file.data());
    return {bytes, bytes + size};
  }

 private:
  PictureWorker& WorkerFor(const cv::Mat& image) {
    const std::size_t pixel_bytes = image.total() * image.elemSize();
    // Pixels that can't be compressed make a file a little larger than themselves.
    const std::size_t file_bytes = pixel_bytes / 4 * 5 + (std::size_t{1} << 16U);
    if (worker_ == nullptr || worker_->pixel_bytes().size() < pixel_bytes ||
        worker_->file_bytes().size() < file_bytes) {
      worker_ = std::make_unique<PictureWorker>(
          WorkerNeeds{image.cols, image.rows, static_cast<std::int64_t>(file_bytes), SourceMemory::kPicture});
    }
    return *worker_;
  }

  std::mutex mutex_;
  std::unique_ptr<PictureWorker> worker_;
};

}  // namespace

std::vector<std::uint8_t> EncodePicture(const cv::Mat& image, const std::string& extension) {
  core::Require(!image.empty() && image.elemSize() <= 8, "a picture to encode has pixels of up to 8 bytes");
  static Encoder encoder;
  return encoder.Encode(image, extension);
}

}  // namespace elbowroom::recon
