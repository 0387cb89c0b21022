#include "recon/capture/v4l2/jpeg_decoder.h"

#include <turbojpeg.h>

#include "core/error.h"

namespace elbowroom::recon {

namespace {

bool DecodeWith(void* decoder, std::span<const std::byte> bytes, cv::Mat& image_bgr) {
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width = 0, height = 0, subsampling = 0, colours = 0;
  if (tjDecompressHeader3(decoder, data, bytes.size(), &width, &height, &subsampling, &colours) != 0 ||
      width != image_bgr.cols || height != image_bgr.rows)
    return false;
  // Webcams send baseline pictures; many scans of a progressive one would only cost time.
  constexpr int kFlags = TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS;
  return tjDecompress2(decoder, data, bytes.size(), image_bgr.data, width, static_cast<int>(image_bgr.step),
                       height, TJPF_BGR, kFlags) == 0;
}

}  // namespace

JpegDecoder::JpegDecoder() { Begin(); }

JpegDecoder::~JpegDecoder() { tjDestroy(decoder_); }

void JpegDecoder::Begin() {
  if (decoder_ != nullptr) tjDestroy(decoder_);
  decoder_ = tjInitDecompress();
  if (decoder_ == nullptr) throw core::Error(core::ErrorKind::kCamera, "JPEG can't be decoded: no memory");
}

// A decoder that met a damaged picture takes the next one for damaged, too.
bool JpegDecoder::Decode(std::span<const std::byte> bytes, cv::Mat& image_bgr) {
  if (DecodeWith(decoder_, bytes, image_bgr)) return true;
  Begin();
  return false;
}

}  // namespace elbowroom::recon
