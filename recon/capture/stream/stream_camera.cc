#include "recon/capture/stream/stream_camera.h"

#include <fmt/format.h>
#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gst/video/video.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "core/error.h"
#include "recon/capture/device/pixel_layout.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;

template <typename Type, void (*Free)(Type*)>
struct Freed {
  void operator()(Type* object) const { Free(object); }
};
inline void UnrefElement(GstElement* element) { gst_object_unref(element); }
inline void UnrefSample(GstSample* sample) { gst_sample_unref(sample); }
inline void UnrefMessage(GstMessage* message) { gst_message_unref(message); }
using ElementHandle = std::unique_ptr<GstElement, Freed<GstElement, UnrefElement>>;
using SampleHandle = std::unique_ptr<GstSample, Freed<GstSample, UnrefSample>>;
using MessageHandle = std::unique_ptr<GstMessage, Freed<GstMessage, UnrefMessage>>;

// The decoder's pictures wait here while one is handed on; at 30 Hz a fifth of a second of them.
constexpr guint kMostWaiting = 6;

class StreamCamera : public CameraDevice {
 public:
  explicit StreamCamera(const DeviceRequest& request) : request_(request) {
    gst_init(nullptr, nullptr);
    Build();
    is_live_ = Play();
    // The first picture tells the size and the rate; Next hands it on.
    first_ = Pull(kLongestOpening);
    if (!first_) Fail(WhatIsWrong().value_or("sends no picture; check the address and the camera"));
    ReadCaps(*first_);
    report_.name = request_.location;
    WarnOfSettings();
  }

  ~StreamCamera() override { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }
  StreamCamera(const StreamCamera&) = delete;
  StreamCamera& operator=(const StreamCamera&) = delete;

  [[nodiscard]] const DeviceReport& report() const override { return report_; }

  [[nodiscard]] std::optional<DevicePicture> Next(std::chrono::milliseconds most_wait,
                                                  cv::Mat& image_bgr) override {
    const SampleHandle sample = first_ ? std::move(first_) : Pull(most_wait);
    if (sample) return Take(*sample, image_bgr);
    if (const std::optional<std::string> wrong = WhatIsWrong()) Fail(*wrong);
    if (gst_app_sink_is_eos(GST_APP_SINK(sink_.get())) != 0) Fail("ended; check the camera");
    return std::nullopt;
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw Error(ErrorKind::kCamera, fmt::format("'{}' {}", request_.location, what));
  }

  void Build() {
    GError* error = nullptr;
    // The sink never waits for a clock, and blocks the decoder rather than lose a picture in silence.
    const std::string text = fmt::format(
        "uridecodebin name=source ! videoconvert ! video/x-raw,format=BGR ! "
        "appsink name=sink sync=false max-buffers={}",
        kMostWaiting);
    pipeline_.reset(gst_parse_launch(text.c_str(), &error));
    if (error != nullptr || !pipeline_) {
      const std::string why = error == nullptr ? "" : error->message;
      g_clear_error(&error);
      Fail(fmt::format("can't be decoded ({}); install GStreamer's plugins", why));
    }
    sink_.reset(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "sink"));
    const ElementHandle source(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "source"));
    g_object_set(source.get(), "uri", request_.location.c_str(), nullptr);
    g_signal_connect(source.get(), "source-setup", G_CALLBACK(&OnSourceSetup), nullptr);
  }

  // Waits for late packets no longer than a frame period or two.
  static void OnSourceSetup(GstElement*, GstElement* source, gpointer) {
    constexpr guint kLatencyMs = 50;
    GObjectClass* known = G_OBJECT_GET_CLASS(source);
    if (g_object_class_find_property(known, "latency") != nullptr)
      g_object_set(source, "latency", kLatencyMs, nullptr);
    if (g_object_class_find_property(known, "is-live") != nullptr)
      g_object_set(source, "is-live", TRUE, nullptr);
  }

  // Whether the stream's times are those of the computer's clock.
  bool Play() {
    GstStateChangeReturn change = gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
    if (change == GST_STATE_CHANGE_ASYNC) {
      change =
          gst_element_get_state(pipeline_.get(), nullptr, nullptr,
                                static_cast<GstClockTime>(std::chrono::nanoseconds(kLongestOpening).count()));
    }
    if (change == GST_STATE_CHANGE_FAILURE)
      Fail(WhatIsWrong().value_or("can't be opened; check the address and the camera"));
    return change == GST_STATE_CHANGE_NO_PREROLL;
  }

  SampleHandle Pull(std::chrono::nanoseconds most_wait) {
    return SampleHandle(gst_app_sink_try_pull_sample(GST_APP_SINK(sink_.get()),
                                                     static_cast<GstClockTime>(most_wait.count())));
  }

  // The first error that the pipeline told of.
  [[nodiscard]] std::optional<std::string> WhatIsWrong() const {
    GstBus* bus = gst_element_get_bus(pipeline_.get());
    const MessageHandle message(gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR));
    gst_object_unref(bus);
    if (!message) return std::nullopt;
    GError* error = nullptr;
    gst_message_parse_error(message.get(), &error, nullptr);
    const std::string why = error == nullptr ? "no reason is given" : error->message;
    g_clear_error(&error);
    return fmt::format("fails ({}); check the address and the camera", why);
  }

  void ReadCaps(GstSample& sample) {
    GstVideoInfo info;
    gst_video_info_init(&info);
    if (gst_video_info_from_caps(&info, gst_sample_get_caps(&sample)) == 0) Fail("sends what is no video");
    if (info.width != request_.width_px || info.height != request_.height_px) {
      Fail(
          fmt::format("gives {} x {} px, but it was calibrated with {} x {}; set the camera to that, or "
                      "calibrate it again",
                      info.width, info.height, request_.width_px, request_.height_px));
    }
    row_bytes_ = static_cast<std::size_t>(info.stride[0]);
    if (info.fps_n > 0 && info.fps_d > 0) report_.rate_hz = static_cast<double>(info.fps_n) / info.fps_d;
    if (!report_.rate_hz) report_.rate_hz = request_.settings.rate_hz;
  }

  void WarnOfSettings() {
    const CaptureSettings& wanted = request_.settings;
    const auto warn = [&](bool is_wanted, const char* what) {
      if (is_wanted)
        report_.warnings.push_back(fmt::format("{} can't be set over a stream; set it at the camera", what));
    };
    warn(wanted.exposure_us.has_value(), "exposure_us");
    warn(wanted.gain_db.has_value(), "gain_db");
    warn(wanted.white_balance_k.has_value(), "white_balance_k");
    warn(wanted.trigger != CaptureTrigger::kFree, "trigger");
    if (wanted.rate_hz && report_.rate_hz &&
        std::abs(*wanted.rate_hz - *report_.rate_hz) > 0.02 * *wanted.rate_hz)
      report_.warnings.push_back(fmt::format("rate_hz is {:g}, not {:g}", *report_.rate_hz, *wanted.rate_hz));
  }

  DevicePicture Take(GstSample& sample, cv::Mat& image_bgr) {
    GstBuffer* buffer = gst_sample_get_buffer(&sample);
    const std::int64_t now_ns = MonotonicNs();
    DevicePicture picture{PictureState::kWhole, 0, now_ns, now_ns, StampSource::kArrival};
    const GstClockTime stamp = GST_BUFFER_PTS(buffer);
    if (is_live_ && GST_CLOCK_TIME_IS_VALID(stamp)) {
      const GstClockTime running =
          gst_segment_to_running_time(gst_sample_get_segment(&sample), GST_FORMAT_TIME, stamp);
      picture.taken_ns = static_cast<std::int64_t>(running + gst_element_get_base_time(pipeline_.get()));
      picture.stamp_source = StampSource::kDriver;
    }
    picture.number = NumberAt(picture.taken_ns);
    if (GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_CORRUPTED) != 0) {
      picture.state = PictureState::kDamaged;
      return picture;
    }
    GstMapInfo map;
    if (gst_buffer_map(buffer, &map, GST_MAP_READ) == 0) {
      picture.state = PictureState::kDamaged;
      return picture;
    }
    ToBgr({reinterpret_cast<const std::byte*>(map.data), map.size}, PixelLayout::kBgr8,
          {request_.width_px, request_.height_px}, row_bytes_, image_bgr);
    gst_buffer_unmap(buffer, &map);
    return picture;
  }

  // As many numbers on as periods have passed, at least one.
  std::uint64_t NumberAt(std::int64_t taken_ns) {
    std::uint64_t step = 1;
    if (last_ns_ && report_.rate_hz) {
      const double periods = static_cast<double>(taken_ns - *last_ns_) * 1e-9 * *report_.rate_hz;
      if (periods > 1.0) step = static_cast<std::uint64_t>(std::llround(periods));
    }
    last_ns_ = taken_ns;
    return number_ += step;
  }

  DeviceRequest request_;
  DeviceReport report_;
  ElementHandle pipeline_, sink_;
  SampleHandle first_;
  bool is_live_ = false;
  std::size_t row_bytes_ = 0;
  std::optional<std::int64_t> last_ns_;
  std::uint64_t number_ = 0;
};

}  // namespace

std::unique_ptr<CameraDevice> OpenStreamCamera(const DeviceRequest& request) {
  return std::make_unique<StreamCamera>(request);
}

}  // namespace elbowroom::recon
