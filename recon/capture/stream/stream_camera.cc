#include "recon/capture/stream/stream_camera.h"

#include <fmt/format.h>
#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gst/video/video.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
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
// Its threads are at an end before anything that they use goes.
inline void EndPipeline(GstElement* pipeline) {
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
}
using PipelineHandle = std::unique_ptr<GstElement, Freed<GstElement, EndPipeline>>;
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
    Play();
    // The first picture tells the size and the rate; Next hands it on.
    WaitForFirst();
    is_live_ = IsLivePipeline();
    ReadCaps(*first_);
    report_.name = request_.location;
    WarnOfSettings();
  }

  StreamCamera(const StreamCamera&) = delete;
  StreamCamera& operator=(const StreamCamera&) = delete;

  [[nodiscard]] const DeviceReport& report() const override { return report_; }

  [[nodiscard]] std::optional<DevicePicture> Next(std::chrono::milliseconds most_wait,
                                                  cv::Mat& image_bgr) override {
    if (after_them_) return NextDamaged(image_bgr);
    const SampleHandle sample = first_ ? std::move(first_) : Pull(most_wait);
    if (sample) {
      const DevicePicture picture = Take(*sample, image_bgr);
      if (damaged_numbers_.first > damaged_numbers_.second) return picture;
      after_them_ = picture;
      image_bgr.copyTo(kept_);
      return NextDamaged(image_bgr);
    }
    if (const std::optional<std::string> wrong = WhatIsWrong()) Fail(*wrong);
    if (gst_app_sink_is_eos(GST_APP_SINK(sink_.get())) != 0) Fail("ended; check the camera");
    return std::nullopt;
  }

 private:
  // First the damaged pictures, then the one that came after them.
  DevicePicture NextDamaged(cv::Mat& image_bgr) {
    DevicePicture picture = *after_them_;
    if (damaged_numbers_.first <= damaged_numbers_.second) {
      picture.state = PictureState::kDamaged;
      picture.number = damaged_numbers_.first++;
    } else {
      kept_.copyTo(image_bgr);
      after_them_.reset();
    }
    return picture;
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw Error(ErrorKind::kCamera, fmt::format("'{}' {}", request_.location, what));
  }

  void Build() {
    GError* error = nullptr;
    // uridecodebin would wait for seconds of HTTP before it decodes any. The sink never waits for a clock,
    // and blocks the decoder rather than lose a picture in silence.
    const bool is_http =
        request_.location.starts_with("http://") || request_.location.starts_with("https://");
    const std::string text = fmt::format(
        "{} ! videoconvert ! video/x-raw,format=BGR ! appsink name=sink sync=false max-buffers={}",
        is_http ? "souphttpsrc name=source is-live=true do-timestamp=true ! multipartdemux "
                  "single-stream=true ! jpegdec name=decoder"
                : "uridecodebin name=source",
        kMostWaiting);
    pipeline_.reset(gst_parse_launch(text.c_str(), &error));
    if (error != nullptr || !pipeline_) {
      const std::string why = error == nullptr ? "" : error->message;
      g_clear_error(&error);
      Fail(fmt::format("can't be decoded ({}); install GStreamer's plugins", why));
    }
    sink_.reset(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "sink"));
    const ElementHandle source(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "source"));
    g_object_set(source.get(), is_http ? "location" : "uri", request_.location.c_str(), nullptr);
    if (!is_http) g_signal_connect(source.get(), "source-setup", G_CALLBACK(&OnSourceSetup), nullptr);
    g_signal_connect(pipeline_.get(), "deep-element-added", G_CALLBACK(&OnElement), this);
    if (const ElementHandle decoder(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "decoder")); decoder)
      OnElement(nullptr, nullptr, decoder.get(), this);
  }

  // Packets are stamped when they come, and late ones waited for no longer than a frame period or two.
  static void OnSourceSetup(GstElement*, GstElement* source, gpointer) {
    constexpr guint kLatencyMs = 50;
    const auto has = [known = G_OBJECT_GET_CLASS(source)](const char* property) {
      return g_object_class_find_property(known, property) != nullptr;
    };
    if (has("latency")) g_object_set(source, "latency", kLatencyMs, nullptr);
    if (has("is-live")) g_object_set(source, "is-live", TRUE, nullptr);
    if (has("do-timestamp")) g_object_set(source, "do-timestamp", TRUE, nullptr);
  }

  // What goes into a decoder and doesn't come out of it is damaged.
  static void OnElement(GstBin*, GstBin*, GstElement* element, gpointer self) {
    const char* what = gst_element_get_metadata(element, GST_ELEMENT_METADATA_KLASS);
    const auto is_a = [&](std::string_view kind) {
      return what != nullptr && std::string_view(what).find(kind) != std::string_view::npos;
    };
    if (!is_a("Decoder/Image") && !is_a("Decoder/Video")) return;
    GstPad* pad = gst_element_get_static_pad(element, "sink");
    if (pad == nullptr) return;
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, &OnEncoded, self, nullptr);
    gst_object_unref(pad);
  }

  static GstPadProbeReturn OnEncoded(GstPad*, GstPadProbeInfo* info, gpointer self) {
    auto& camera = *static_cast<StreamCamera*>(self);
    const GstClockTime stamp = GST_BUFFER_PTS(GST_PAD_PROBE_INFO_BUFFER(info));
    constexpr std::size_t kMostRemembered = 256;
    const std::lock_guard lock(camera.mutex_);
    if (GST_CLOCK_TIME_IS_VALID(stamp)) camera.encoded_.push_back(stamp);
    if (camera.encoded_.size() > kMostRemembered) camera.encoded_.pop_front();
    return GST_PAD_PROBE_OK;
  }

  void Play() {
    if (gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE)
      Fail(WhatIsWrong().value_or("can't be opened; check the address and the camera"));
  }

  void WaitForFirst() {
    constexpr std::chrono::milliseconds kStep{50};
    const auto end = std::chrono::steady_clock::now() + kLongestOpening;
    while (!first_) {
      first_ = Pull(kStep);
      if (first_) return;
      if (const std::optional<std::string> wrong = WhatIsWrong()) Fail(*wrong);
      if (std::chrono::steady_clock::now() > end) Fail("sends no picture; check the address and the camera");
    }
  }

  // Whether the stream's times are those at which its pictures came.
  [[nodiscard]] bool IsLivePipeline() const {
    GstQuery* query = gst_query_new_latency();
    gboolean is_live = FALSE;
    if (gst_element_query(pipeline_.get(), query) != 0)
      gst_query_parse_latency(query, &is_live, nullptr, nullptr);
    gst_query_unref(query);
    return is_live != 0;
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
    picture.number = NumberAt(picture.taken_ns, DamagedBefore(stamp));
    GstMapInfo map;
    if (GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_CORRUPTED) != 0 ||
        gst_buffer_map(buffer, &map, GST_MAP_READ) == 0) {
      picture.state = PictureState::kDamaged;
      return picture;
    }
    ToBgr({reinterpret_cast<const std::byte*>(map.data), map.size}, PixelLayout::kBgr8,
          {request_.width_px, request_.height_px}, row_bytes_, image_bgr);
    gst_buffer_unmap(buffer, &map);
    return picture;
  }

  // How many pictures went into the decoder since the last one that came out of it.
  std::uint64_t DamagedBefore(GstClockTime stamp) {
    const std::lock_guard lock(mutex_);
    const auto end = std::ranges::find(encoded_, stamp);
    if (end == encoded_.end()) return 0;
    const auto damaged = static_cast<std::uint64_t>(end - encoded_.begin());
    encoded_.erase(encoded_.begin(), end + 1);
    return damaged;
  }

  // As many numbers on as periods have passed, or as pictures were sent.
  std::uint64_t NumberAt(std::int64_t taken_ns, std::uint64_t damaged) {
    std::uint64_t step = 1 + damaged;
    if (last_ns_ && report_.rate_hz) {
      const double periods = static_cast<double>(taken_ns - *last_ns_) * 1e-9 * *report_.rate_hz;
      if (periods > 1.0) step = std::max(step, static_cast<std::uint64_t>(std::llround(periods)));
    }
    last_ns_ = taken_ns;
    damaged_numbers_ = {number_ + 1, number_ + damaged};
    return number_ += step;
  }

  DeviceRequest request_;
  DeviceReport report_;
  SampleHandle first_;
  bool is_live_ = false;
  std::size_t row_bytes_ = 0;
  std::optional<std::int64_t> last_ns_;
  std::uint64_t number_ = 0;
  std::pair<std::uint64_t, std::uint64_t> damaged_numbers_{1, 0};  // first and last that are still to be told
  std::optional<DevicePicture> after_them_;                        // the picture that comes then
  cv::Mat kept_;                                                   // its pixels
  std::mutex mutex_;
  std::deque<GstClockTime> encoded_;  // stamps of what went into the decoder and hasn't come out
  PipelineHandle pipeline_;
  ElementHandle sink_;
};

}  // namespace

std::unique_ptr<CameraDevice> OpenStreamCamera(const DeviceRequest& request) {
  return std::make_unique<StreamCamera>(request);
}

}  // namespace elbowroom::recon
