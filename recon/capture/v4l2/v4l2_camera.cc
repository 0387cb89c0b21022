#include "recon/capture/v4l2/v4l2_camera.h"

#include <fmt/format.h>
#include <linux/videodev2.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>

#include "core/error.h"
#include "recon/capture/device/pixel_layout.h"
#include "recon/capture/v4l2/jpeg_decoder.h"
#include "recon/capture/v4l2/v4l2_controls.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;

constexpr std::uint32_t kBuffers = 4;
constexpr auto kCapture = V4L2_BUF_TYPE_VIDEO_CAPTURE;

std::string PathOf(const std::string& location) {
  const std::string name = location.substr(location.find(':') + 1);
  return location.starts_with("device:") ? "/dev/video" + name : name;
}

// "YUYV" of its code.
std::string NameOf(std::uint32_t format) {
  std::string name;
  for (unsigned shift = 0; shift < 32; shift += 8) name += static_cast<char>((format >> shift) & 0xFFU);
  return name;
}

// What the device itself can, of a driver that has several.
std::uint32_t AbilitiesOf(const v4l2_capability& capability) {
  return (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? capability.device_caps
                                                               : capability.capabilities;
}

class V4l2Camera : public CameraDevice {
 public:
  V4l2Camera(const DeviceRequest& request, std::unique_ptr<VideoSystem> system)
      : request_(request), system_(std::move(system)) {
    RequireCapture();
    SetFormat();
    SetRate();
    SetControls(request_.settings, *system_, &report_);
    if (request_.settings.trigger != CaptureTrigger::kFree)
      report_.warnings.emplace_back("trigger can't be set; the camera runs freely");
    MapBuffers();
    int type = kCapture;
    RequireDone(VIDIOC_STREAMON, &type, "starts no stream");
  }

  ~V4l2Camera() override {
    int type = kCapture;
    system_->Ioctl(VIDIOC_STREAMOFF, &type);
    for (const auto& buffer : buffers_) system_->Unmap(const_cast<std::byte*>(buffer.data()), buffer.size());
  }
  V4l2Camera(const V4l2Camera&) = delete;
  V4l2Camera& operator=(const V4l2Camera&) = delete;

  [[nodiscard]] const DeviceReport& report() const override { return report_; }

  [[nodiscard]] std::optional<DevicePicture> Next(std::chrono::milliseconds most_wait,
                                                  cv::Mat& image_bgr) override {
    if (system_->Wait(most_wait) <= 0) return std::nullopt;
    v4l2_buffer buffer = Described(0);
    if (system_->Ioctl(VIDIOC_DQBUF, &buffer) != 0) {
      if (errno == EAGAIN) return std::nullopt;
      Fail("is gone; check its cable");
    }
    const DevicePicture picture = Take(buffer, image_bgr);
    RequireDone(VIDIOC_QBUF, &buffer, "takes no buffer back");
    return picture;
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw Error(ErrorKind::kCamera, fmt::format("'{}' {}", request_.location, what));
  }

  void RequireDone(unsigned long call, void* argument, const char* what) {
    if (system_->Ioctl(call, argument) == 0) return;
    const char* hint = errno == EBUSY ? "; close the program that uses it" : "; check the camera";
    Fail(fmt::format("{} ({}){}", what, std::strerror(errno), hint));
  }

  [[nodiscard]] static v4l2_buffer Described(std::uint32_t index) {
    v4l2_buffer buffer{};
    buffer.type = kCapture;
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = index;
    return buffer;
  }

  void RequireCapture() {
    v4l2_capability capability{};
    RequireDone(VIDIOC_QUERYCAP, &capability, "is no video device");
    const std::uint32_t can = AbilitiesOf(capability);
    if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0 || (can & V4L2_CAP_STREAMING) == 0)
      Fail("gives no pictures; it is another of the camera's devices: see 'elbowroom cameras list'");
    report_.name = reinterpret_cast<const char*>(capability.card);
  }

  [[nodiscard]] bool Offers(std::uint32_t format) {
    v4l2_fmtdesc description{};
    description.type = kCapture;
    for (; system_->Ioctl(VIDIOC_ENUM_FMT, &description) == 0; ++description.index)
      if (description.pixelformat == format) return true;
    return false;
  }

  // Whether the format has the rate that is asked for, in this size.
  [[nodiscard]] bool IsFastEnough(std::uint32_t format) {
    if (!request_.settings.rate_hz) return true;
    v4l2_frmivalenum interval{};
    interval.pixel_format = format;
    interval.width = static_cast<std::uint32_t>(request_.width_px);
    interval.height = static_cast<std::uint32_t>(request_.height_px);
    constexpr double kAlmost = 0.98;
    for (; system_->Ioctl(VIDIOC_ENUM_FRAMEINTERVALS, &interval) == 0; ++interval.index) {
      const v4l2_fract& least =
          interval.type == V4L2_FRMIVAL_TYPE_DISCRETE ? interval.discrete : interval.stepwise.min;
      if (least.numerator > 0 &&
          static_cast<double>(least.denominator) / least.numerator > kAlmost * *request_.settings.rate_hz)
        return true;
    }
    return false;
  }

  [[nodiscard]] std::uint32_t ChooseFormat() {
    const std::string& wanted = request_.settings.pixel_format;
    const auto is_wanted = [&](std::uint32_t format) { return wanted.empty() || wanted == NameOf(format); };
    const bool has_yuyv = is_wanted(V4L2_PIX_FMT_YUYV) && Offers(V4L2_PIX_FMT_YUYV);
    const bool has_jpeg = is_wanted(V4L2_PIX_FMT_MJPEG) && Offers(V4L2_PIX_FMT_MJPEG);
    if (has_yuyv && (!has_jpeg || IsFastEnough(V4L2_PIX_FMT_YUYV))) return V4L2_PIX_FMT_YUYV;
    if (has_jpeg) return V4L2_PIX_FMT_MJPEG;
    Fail(fmt::format("offers neither YUYV nor MJPG{}; use another camera",
                     wanted.empty() ? "" : fmt::format(", of which '{}' is asked for", wanted)));
  }

  void SetFormat() {
    v4l2_format format{};
    format.type = kCapture;
    format.fmt.pix.width = static_cast<std::uint32_t>(request_.width_px);
    format.fmt.pix.height = static_cast<std::uint32_t>(request_.height_px);
    format.fmt.pix.pixelformat = ChooseFormat();
    format.fmt.pix.field = V4L2_FIELD_NONE;
    const std::uint32_t asked = format.fmt.pix.pixelformat;
    RequireDone(VIDIOC_S_FMT, &format, "refuses its pixel format");
    const v4l2_pix_format& pix = format.fmt.pix;
    if (pix.pixelformat != asked)
      Fail(fmt::format("gives {} instead of {}; use another camera", NameOf(pix.pixelformat), NameOf(asked)));
    if (static_cast<int>(pix.width) != request_.width_px ||
        static_cast<int>(pix.height) != request_.height_px) {
      Fail(fmt::format("gives {} x {} px, but it was calibrated with {} x {}; calibrate it again", pix.width,
                       pix.height, request_.width_px, request_.height_px));
    }
    is_jpeg_ = asked == V4L2_PIX_FMT_MJPEG;
    row_bytes_ = std::max(static_cast<std::size_t>(pix.bytesperline),
                          BytesPerRow(PixelLayout::kYuyv, request_.width_px));
  }

  void SetRate() {
    v4l2_streamparm parameters{};
    parameters.type = kCapture;
    v4l2_fract& interval = parameters.parm.capture.timeperframe;
    if (const auto& rate_hz = request_.settings.rate_hz) {
      constexpr double kParts = 1000.0;
      interval = {static_cast<std::uint32_t>(kParts),
                  static_cast<std::uint32_t>(std::lround(*rate_hz * kParts))};
      system_->Ioctl(VIDIOC_S_PARM, &parameters);
    }
    if (system_->Ioctl(VIDIOC_G_PARM, &parameters) != 0 || interval.numerator == 0) return;
    report_.rate_hz = static_cast<double>(interval.denominator) / interval.numerator;
    const auto& wanted = request_.settings.rate_hz;
    if (wanted && std::abs(*report_.rate_hz - *wanted) > 0.02 * *wanted)
      report_.warnings.push_back(fmt::format("rate_hz is {:g}, not {:g}", *report_.rate_hz, *wanted));
  }

  void MapBuffers() {
    v4l2_requestbuffers wanted{};
    wanted.count = kBuffers;
    wanted.type = kCapture;
    wanted.memory = V4L2_MEMORY_MMAP;
    RequireDone(VIDIOC_REQBUFS, &wanted, "has no buffers");
    for (std::uint32_t i = 0; i < wanted.count; ++i) {
      v4l2_buffer buffer = Described(i);
      RequireDone(VIDIOC_QUERYBUF, &buffer, "doesn't tell where its buffers are");
      void* memory = system_->Map(buffer.length, buffer.m.offset);
      if (memory == MAP_FAILED) Fail("has buffers that can't be mapped; close other programs");
      buffers_.emplace_back(static_cast<const std::byte*>(memory), buffer.length);
      RequireDone(VIDIOC_QBUF, &buffer, "takes no buffer");
    }
  }

  // Of the middle of the exposure. A driver's stamp is its beginning, or the end of the picture's transfer.
  void Stamp(const v4l2_buffer& buffer, DevicePicture* picture) const {
    if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) return;
    const std::int64_t stamp_ns =
        std::int64_t{buffer.timestamp.tv_sec} * 1'000'000'000 + std::int64_t{buffer.timestamp.tv_usec} * 1000;
    const auto half_ns = static_cast<std::int64_t>(report_.exposure_us.value_or(0.0) * 500.0);
    const bool is_begin = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    picture->taken_ns = is_begin ? stamp_ns + half_ns : stamp_ns - half_ns;
    picture->stamp_source = StampSource::kDriver;
  }

  // The driver counts in 32 bits; some don't count at all.
  std::uint64_t NumberOf(const v4l2_buffer& buffer) {
    const std::uint32_t step = buffer.sequence - last_sequence_;
    constexpr std::uint32_t kHalf = 1U << 31U;
    number_ += has_number_ && step > 0 && step < kHalf ? step : 1;
    has_number_ = true;
    last_sequence_ = buffer.sequence;
    return number_;
  }

  DevicePicture Take(const v4l2_buffer& buffer, cv::Mat& image_bgr) {
    const std::int64_t now_ns = MonotonicNs();
    DevicePicture picture{PictureState::kWhole, NumberOf(buffer), now_ns, now_ns, StampSource::kArrival};
    Stamp(buffer, &picture);
    if (buffer.index >= buffers_.size() || (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0) {
      picture.state = PictureState::kDamaged;
      return picture;
    }
    const std::span<const std::byte> bytes =
        buffers_[buffer.index].first(std::min<std::size_t>(buffer.bytesused, buffers_[buffer.index].size()));
    if (!Decode(bytes, image_bgr))
      picture.state = is_jpeg_ ? PictureState::kDamaged : PictureState::kIncomplete;
    return picture;
  }

  bool Decode(std::span<const std::byte> bytes, cv::Mat& image_bgr) {
    if (is_jpeg_) return jpeg_.Decode(bytes, image_bgr);
    if (bytes.size() < row_bytes_ * static_cast<std::size_t>(request_.height_px)) return false;
    ToBgr(bytes, PixelLayout::kYuyv, {request_.width_px, request_.height_px}, row_bytes_, image_bgr);
    return true;
  }

  DeviceRequest request_;
  std::unique_ptr<VideoSystem> system_;
  DeviceReport report_;
  JpegDecoder jpeg_;
  bool is_jpeg_ = false;
  std::size_t row_bytes_ = 0;
  std::vector<std::span<const std::byte>> buffers_;  // the driver writes them
  bool has_number_ = false;
  std::uint32_t last_sequence_ = 0;
  std::uint64_t number_ = 0;
};

}  // namespace

std::unique_ptr<CameraDevice> MakeV4l2Camera(const DeviceRequest& request,
                                             std::unique_ptr<VideoSystem> system) {
  return std::make_unique<V4l2Camera>(request, std::move(system));
}

std::unique_ptr<CameraDevice> OpenV4l2Camera(const DeviceRequest& request) {
  std::unique_ptr<VideoSystem> system = OpenVideoSystem(PathOf(request.location));
  if (system == nullptr) {
    throw Error(ErrorKind::kCamera, fmt::format("'{}' can't be opened ({}); check that it is plugged in",
                                                request.location, std::strerror(errno)));
  }
  return MakeV4l2Camera(request, std::move(system));
}

std::vector<std::string> FindV4l2Cameras() {
  std::vector<std::string> found;
  constexpr int kMostDevices = 64;
  for (int i = 0; i < kMostDevices; ++i) {
    const std::string path = fmt::format("/dev/video{}", i);
    const std::unique_ptr<VideoSystem> system = OpenVideoSystem(path);
    v4l2_capability capability{};
    if (system == nullptr || system->Ioctl(VIDIOC_QUERYCAP, &capability) != 0) continue;
    const std::uint32_t can = AbilitiesOf(capability);
    if ((can & V4L2_CAP_VIDEO_CAPTURE) != 0)
      found.push_back(fmt::format("v4l2:{} ({})", path, reinterpret_cast<const char*>(capability.card)));
  }
  return found;
}

}  // namespace elbowroom::recon
