#include "recon/decoding/quiet_opencv.h"

#include <cstdlib>
#include <mutex>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>

namespace elbowroom::recon {
namespace {

int IgnoreError(int, const char*, const char*, const char*, int, void*) { return 0; }

}  // namespace

void SilenceOpenCv() {
  static std::once_flag once;
  std::call_once(once, [] {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    cv::redirectError(&IgnoreError);
    // FFmpeg's own level, -8 = quiet; OpenCV reads it when the first video opens. A level set by the user
    // stays.
    ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
  });
}

}  // namespace elbowroom::recon
