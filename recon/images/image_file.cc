#include "recon/images/image_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/system/child_process.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;

// A picture that takes longer doesn't come from a camera.
constexpr std::chrono::seconds kLongestDecode{10};

// Room for pixels without any compression, and for what cameras write beside them.
std::int64_t MostFileBytes(const std::optional<cv::Size>& size_px) {
  constexpr std::int64_t kBytesAPixel = 8, kBeside = std::int64_t{16} << 20U;
  return (size_px ? std::int64_t{size_px->width} * size_px->height : kMostPixels) * kBytesAPixel + kBeside;
}

// Whether pixels of that type (OpenCV's) are what was asked for.
bool IsTypeOf(DecodedAs as, int type) {
  if (as == DecodedAs::kBgr) return type == CV_8UC3;
  constexpr int kLast = CV_16UC4;  // of those with up to four channels
  return type >= 0 && type <= kLast && (CV_MAT_DEPTH(type) == CV_8U || CV_MAT_DEPTH(type) == CV_16U);
}

}  // namespace

ImageReader::ImageReader(std::string who, std::optional<cv::Size> size_px)
    : who_(std::move(who)), size_px_(size_px) {}

void ImageReader::Fail(const std::string& what) const {
  throw Error(ErrorKind::kFile, fmt::format("{}: image '{}' {}", who_, path_.string(), what));
}

std::string ImageReader::ReadBytes() const {
  // O_NONBLOCK: opening a pipe would otherwise wait until another process writes into it.
  const core::Descriptor file(::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (!file.is_open() && errno == ENOENT) Fail("does not exist; check the path");
  if (!file.is_open() || ::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode))
    Fail("can't be opened; check that it is a file and may be read");
  if (status.st_size > MostFileBytes(size_px_)) {
    Fail(fmt::format("has {} bytes, more than a picture of that size needs; check that it is one",
                     status.st_size));
  }
  std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
  std::size_t have = 0;
  while (have < bytes.size()) {
    const ssize_t size = ::read(file.number(), bytes.data() + have, bytes.size() - have);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) Fail(fmt::format("can't be read ({}); check the disk", std::strerror(errno)));
    if (size == 0) break;
    have += static_cast<std::size_t>(size);
  }
  bytes.resize(have);
  return bytes;
}

const PictureHeader& ImageReader::Open(const std::filesystem::path& path) {
  path_ = path;
  bytes_ = ReadBytes();
  if (const auto defect = DefectOfPicture(bytes_)) Fail(*defect);
  const auto header = ReadPictureHeader(bytes_);
  if (!header) Fail("can't be decoded; it must be an intact PNG, JPEG, TIFF, BMP, PGM or PPM");
  header_ = *header;
  const bool has_pixels = header_.width_px > 0 && header_.height_px > 0;
  const bool is_sane =
      has_pixels && header_.width_px <= kMostPixels && header_.height_px <= kMostPixels / header_.width_px;
  if (!has_pixels || (!size_px_ && !is_sane)) {
    Fail(fmt::format("says that it is {} x {} px, which no camera's is; write or copy it again",
                     header_.width_px, header_.height_px));
  }
  return header_;
}

void ImageReader::RequireBits(DecodedAs as) const {
  constexpr int kMostForMasks = 16, kMostForPictures = 8;
  if (!header_.is_whole_numbers || header_.bits > kMostForMasks)
    Fail("doesn't hold whole numbers of 8 or 16 bits; save it as an 8-bit PNG");
  if (as == DecodedAs::kBgr && header_.bits > kMostForPictures)
    Fail(fmt::format("has {} bits a channel, where pictures have 8; save it as an 8-bit PNG", header_.bits));
}

cv::Mat ImageReader::Decode(DecodedAs as, const std::stop_token& stop) {
  RequireBits(as);
  const cv::Size size(static_cast<int>(header_.width_px), static_cast<int>(header_.height_px));
  core::Require(!size_px_ || size == *size_px_, "a picture that is decoded has the camera's size");
  const std::string bytes = DecodableBytes(bytes_, header_.format);
  // One worker for all files of a size; where none is known, one a picture.
  if (worker_ == nullptr || !size_px_ || bytes.size() > worker_->file_bytes().size()) {
    const auto own = static_cast<std::int64_t>(bytes.size());
    const std::int64_t file_bytes = size_px_ ? std::max(own, MostFileBytes(size_px_)) : own;
    worker_ = std::make_unique<PictureWorker>(
        WorkerNeeds{size.width, size.height, file_bytes, SourceMemory::kPicture});
  }
  std::memcpy(worker_->file_bytes().data(), bytes.data(), bytes.size());
  const PictureAnswer answer = worker_->Ask(
      {PictureTask::kDecode, as, static_cast<std::int64_t>(bytes.size()), size.width, size.height}, {}, stop,
      kLongestDecode);
  const PictureReply& reply = answer.reply;
  if (reply.outcome == PictureOutcome::kDone && !answer.complaint.empty())
    Fail(fmt::format("is damaged: {}; write or copy it again", answer.complaint));
  const bool is_right =
      reply.outcome == PictureOutcome::kDone && size == cv::Size(reply.width_px, reply.height_px);
  if (!is_right || !IsTypeOf(as, reply.type)) {
    const std::string why = answer.complaint.empty() ? "" : fmt::format(" ({})", answer.complaint);
    Fail(fmt::format("can't be decoded{}; it must be an intact PNG, JPEG, TIFF, BMP, PGM or PPM", why));
  }
  // The worker writes over its memory with the next picture.
  std::byte* pixels = worker_->pixel_bytes().data();
  return cv::Mat(size, reply.type, pixels).clone();
}

}  // namespace elbowroom::recon
