// One camera's pictures by number, wherever they are kept.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "core/camera_model.h"
#include "core/ids.h"

namespace elbowroom::recon {

struct SourcePicture {
  cv::Mat image_bgr;  // 8-bit BGR of the camera's size, in memory of its own
};

// Thread: one reader.
class ImageSource {
 public:
  virtual ~ImageSource() = default;

  // Of a video it is what the container promises, until Read has met the video's end. Thread: any.
  [[nodiscard]] virtual core::FrameIndex frame_count() const = 0;
  [[nodiscard]] virtual std::optional<double> frame_rate_hz() const = 0;  // if the file says

  // Nothing at and after the end. Reading in order is fast. Going back in a video decodes it again from its
  // beginning, since only that is right for every codec. Throws: Error{kRange} for an index below 0;
  // Error{kFile} naming camera, file and (about) the frame for a picture that can't be read, is damaged so
  // that a decoder reports it, or is of another size than the camera's; Error{kCancelled} at once on a stop.
  [[nodiscard]] virtual std::optional<SourcePicture> Read(core::FrameIndex index,
                                                          const std::stop_token& stop = {}) = 0;
};

// Opens the source that `location` (a resolved one of CameraSources) names. Of a video, the container's
// structure is checked and the first picture is decoded here; damage farther on is found by Read. A video
// whose container promises no number of frames is decoded once to its end. Throws: Error{kFile} naming camera
// and file if it is missing, unreadable, without pictures, cut short (with the frame where it breaks off and
// how many it promised), or of another size than the camera's; Error{kCancelled} on a stop. Everything is
// decoded in a child process (recon/decoding/picture_worker.h): a codec that crashes is an error, too.
[[nodiscard]] std::unique_ptr<ImageSource> OpenImageSource(const std::string& location,
                                                           const core::CameraModel& camera,
                                                           std::stop_token stop = {});

// The same for a camera that isn't calibrated yet. All its pictures must have the size of the first one,
// which is returned. Live cameras are refused. Throws: as above.
struct UncalibratedSource {
  std::unique_ptr<ImageSource> pictures;
  cv::Size size_px;
};
[[nodiscard]] UncalibratedSource OpenUncalibratedSource(const std::string& location,
                                                        const std::string& camera_name,
                                                        std::stop_token stop = {});

}  // namespace elbowroom::recon
