#include "recon/capture/encoding/video_encoder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gst/app/gstappsrc.h>
#include <gst/gst.h>
#include <gst/video/video.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;

constexpr guint64 kMostOnTheWay = 2;

}  // namespace

struct VideoEncoder::Pipeline {
  std::string path;
  GstVideoInfo info{};
  GstElement* pipeline = nullptr;
  GstElement* source = nullptr;
  GstBus* bus = nullptr;
  guint64 pictures = 0;

  Pipeline(std::string path_of_file, cv::Size size_px, double rate_hz) : path(std::move(path_of_file)) {
    gst_init(nullptr, nullptr);
    GError* error = nullptr;
    pipeline = gst_parse_launch(
        "appsrc name=source format=time ! avenc_huffyuv ! avimux ! filesink name=sink", &error);
    const std::string why = error == nullptr ? "" : error->message;
    g_clear_error(&error);
    if (!why.empty() || pipeline == nullptr) Fail(fmt::format("{}; install GStreamer's plugins", why));
    bus = gst_element_get_bus(pipeline);
    source = gst_bin_get_by_name(GST_BIN(pipeline), "source");
    SetFormat(size_px, rate_hz);
    GstElement* sink = gst_bin_get_by_name(GST_BIN(pipeline), "sink");
    g_object_set(sink, "location", path.c_str(), nullptr);
    gst_object_unref(sink);
    if (gst_element_set_state(pipeline, GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE) {
      ThrowIfWrong(0);
      Fail("it can't be opened");
    }
  }

  ~Pipeline() {
    if (bus != nullptr) gst_object_unref(bus);
    if (source != nullptr) gst_object_unref(source);
    if (pipeline == nullptr) return;
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
  }

  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  void SetFormat(cv::Size size_px, double rate_hz) {
    constexpr int kLeastSidePx = 16, kMostSidePx = 4096;  // of avimux
    if (std::min(size_px.width, size_px.height) < kLeastSidePx ||
        std::max(size_px.width, size_px.height) > kMostSidePx) {
      Fail(fmt::format("pictures of {} x {} px can't be recorded: a side must be {} to {} px", size_px.width,
                       size_px.height, kLeastSidePx, kMostSidePx));
    }
    gst_video_info_set_format(&info, GST_VIDEO_FORMAT_RGB, static_cast<guint>(size_px.width),
                              static_cast<guint>(size_px.height));
    gst_util_double_to_fraction(rate_hz, &info.fps_n, &info.fps_d);
    GstCaps* caps = gst_video_info_to_caps(&info);
    gst_app_src_set_caps(GST_APP_SRC(source), caps);
    gst_caps_unref(caps);
  }

  [[noreturn]] void Fail(const std::string& why) const {
    throw Error(ErrorKind::kFile, fmt::format("video '{}': {}", path, why));
  }

  // Waits so long for the end of all, or for something wrong. True: the end.
  bool ThrowIfWrong(GstClockTime most_wait) const {
    GstMessage* message = gst_bus_timed_pop_filtered(
        bus, most_wait, static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS));
    if (message == nullptr) return false;
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS) {
      gst_message_unref(message);
      return true;
    }
    GError* error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    const bool is_full = g_error_matches(error, GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_NO_SPACE_LEFT) != 0;
    const std::string why = error == nullptr ? "no reason is given" : error->message;
    g_clear_error(&error);
    gst_message_unref(message);
    Fail(is_full ? "the disk is full; make room, or record to another disk"
                 : why + " Check the folder and the disk");
  }

  GstBuffer* Copied(const cv::Mat& image_bgr) {
    GstBuffer* buffer = gst_buffer_new_allocate(nullptr, info.size, nullptr);
    GstMapInfo map;
    if (buffer == nullptr || gst_buffer_map(buffer, &map, GST_MAP_WRITE) == 0)
      Fail("there is no memory for a picture; close other programs");
    cv::Mat image_rgb(image_bgr.size(), CV_8UC3, map.data, static_cast<std::size_t>(info.stride[0]));
    cv::cvtColor(image_bgr, image_rgb, cv::COLOR_BGR2RGB);
    gst_buffer_unmap(buffer, &map);
    // The file's own times are even; what the true ones are stands in the table of stamps.
    const auto at = [this](guint64 picture) {
      return gst_util_uint64_scale(picture * GST_SECOND, static_cast<guint64>(info.fps_d),
                                   static_cast<guint64>(info.fps_n));
    };
    GST_BUFFER_PTS(buffer) = at(pictures);
    GST_BUFFER_DURATION(buffer) = at(pictures + 1) - at(pictures);
    ++pictures;
    return buffer;
  }
};

VideoEncoder::VideoEncoder(const std::string& path, cv::Size size_px, double rate_hz)
    : pipeline_(std::make_unique<Pipeline>(path, size_px, rate_hz)) {}

VideoEncoder::~VideoEncoder() = default;

void VideoEncoder::Write(const cv::Mat& image_bgr) {
  core::Require(image_bgr.type() == CV_8UC3 && image_bgr.cols == pipeline_->info.width &&
                    image_bgr.rows == pipeline_->info.height,
                "all pictures of a video are of its size");
  GstAppSrc* source = GST_APP_SRC(pipeline_->source);
  // Not with the source's own blocking, which an error in the file doesn't end.
  pipeline_->ThrowIfWrong(0);
  while (gst_app_src_get_current_level_buffers(source) >= kMostOnTheWay) pipeline_->ThrowIfWrong(GST_MSECOND);
  if (gst_app_src_push_buffer(source, pipeline_->Copied(image_bgr)) == GST_FLOW_OK) return;
  pipeline_->ThrowIfWrong(GST_SECOND);
  pipeline_->Fail("it takes no more pictures");
}

void VideoEncoder::Finish() {
  (void)gst_app_src_end_of_stream(GST_APP_SRC(pipeline_->source));
  (void)pipeline_->ThrowIfWrong(GST_CLOCK_TIME_NONE);
  const std::string path = pipeline_->path;
  gst_element_set_state(pipeline_->pipeline, GST_STATE_NULL);
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_synced = file >= 0 && ::fsync(file) == 0;
  const int why = errno;
  if (file >= 0) ::close(file);
  if (!is_synced) pipeline_->Fail(std::strerror(why));
}

}  // namespace elbowroom::recon
