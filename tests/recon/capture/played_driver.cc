#include "tests/recon/capture/played_driver.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <iterator>

namespace elbowroom::recon::testing {

int PlayedDriver::Fail(int error) {
  errno = error;
  return -1;
}

int PlayedDriver::Ioctl(unsigned long request, void* argument) {
  const int error = Answer(request, argument);
  return error == 0 ? 0 : Fail(error);
}

void* PlayedDriver::Map(std::size_t, std::int64_t offset) {
  return buffers_.at(static_cast<std::size_t>(offset)).data();
}

// 0, or the error.
int PlayedDriver::Answer(unsigned long request, void* argument) {
  switch (request) {
    case VIDIOC_QUERYCAP: {
      auto& capability = *static_cast<v4l2_capability*>(argument);
      std::strcpy(reinterpret_cast<char*>(capability.card), "Played webcam");
      capability.capabilities = V4L2_CAP_DEVICE_CAPS;
      capability.device_caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
      return 0;
    }
    case VIDIOC_ENUM_FMT: {
      auto& description = *static_cast<v4l2_fmtdesc*>(argument);
      if (description.index >= webcam_.most_rate_hz.size()) return EINVAL;
      description.pixelformat = std::next(webcam_.most_rate_hz.begin(), description.index)->first;
      return 0;
    }
    case VIDIOC_ENUM_FRAMEINTERVALS: {
      auto& interval = *static_cast<v4l2_frmivalenum*>(argument);
      if (interval.index > 0) return EINVAL;
      interval.type = V4L2_FRMIVAL_TYPE_DISCRETE;
      interval.discrete = {
          10, static_cast<std::uint32_t>(std::lround(10.0 * webcam_.most_rate_hz.at(interval.pixel_format)))};
      return 0;
    }
    case VIDIOC_S_FMT: {
      auto& pix = static_cast<v4l2_format*>(argument)->fmt.pix;
      pix.width = webcam_.width;
      pix.height = webcam_.height;
      pix.bytesperline = pix.pixelformat == V4L2_PIX_FMT_YUYV ? 2 * pix.width : 0;
      webcam_.format = pix.pixelformat;
      return 0;
    }
    case VIDIOC_S_PARM: {
      const auto& interval = static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe;
      webcam_.rate_hz = std::min(webcam_.most_rate_hz.at(webcam_.format),
                                 static_cast<double>(interval.denominator) / interval.numerator);
      return 0;
    }
    case VIDIOC_G_PARM:
      static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = {
          10, static_cast<std::uint32_t>(std::lround(10.0 * webcam_.rate_hz))};
      return 0;
    case VIDIOC_S_CTRL: {
      const auto& control = *static_cast<v4l2_control*>(argument);
      const auto known = webcam_.controls.find(control.id);
      if (known == webcam_.controls.end()) return EINVAL;
      const auto most = webcam_.most.find(control.id);
      known->second = most == webcam_.most.end() ? control.value : std::min(control.value, most->second);
      return 0;
    }
    case VIDIOC_G_CTRL: {
      auto& control = *static_cast<v4l2_control*>(argument);
      const auto known = webcam_.controls.find(control.id);
      if (known == webcam_.controls.end()) return EINVAL;
      control.value = known->second;
      return 0;
    }
    case VIDIOC_REQBUFS:
      buffers_.assign(static_cast<v4l2_requestbuffers*>(argument)->count,
                      std::vector<std::byte>(std::size_t{2} * webcam_.width * webcam_.height));
      return 0;
    case VIDIOC_QUERYBUF: {
      auto& buffer = *static_cast<v4l2_buffer*>(argument);
      buffer.length = static_cast<std::uint32_t>(buffers_.at(buffer.index).size());
      buffer.m.offset = buffer.index;
      return 0;
    }
    case VIDIOC_QBUF:
      queued_.push_back(static_cast<v4l2_buffer*>(argument)->index);
      webcam_.buffers_out = static_cast<int>(queued_.size());
      return 0;
    case VIDIOC_STREAMON:
    case VIDIOC_STREAMOFF:
      webcam_.is_streaming = request == VIDIOC_STREAMON;
      return 0;
    case VIDIOC_DQBUF: {
      if (webcam_.pictures.empty()) return ENODEV;
      if (queued_.empty()) return EAGAIN;
      const PlayedPicture picture = webcam_.pictures.front();
      webcam_.pictures.pop_front();
      auto& buffer = *static_cast<v4l2_buffer*>(argument);
      buffer.index = queued_.front();
      queued_.pop_front();
      std::ranges::copy(picture.bytes, buffers_.at(buffer.index).begin());
      buffer.bytesused = static_cast<std::uint32_t>(picture.bytes.size());
      buffer.sequence = picture.sequence;
      buffer.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | picture.more_flags;
      buffer.timestamp = {picture.stamp_us / 1'000'000, picture.stamp_us % 1'000'000};
      return 0;
    }
    default:
      return ENOTTY;
  }
}

}  // namespace elbowroom::recon::testing
