#include "tests/recon/capture/fake_rtsp_camera.h"

#include <fmt/format.h>
#include <gst/app/gstappsrc.h>
#include <gst/rtsp-server/rtsp-server.h>

#include <random>
#include <stdexcept>
#include <thread>
#include <utility>

namespace elbowroom::recon::testing {
namespace {

// What one client's stream needs.
struct Feed {
  FakeRtspCamera::Picture picture;
  int rate_hz = 30;
  double damaged_share = 0.0;
  int index = 0;
  std::mt19937 random{1};
};

void PushNext(GstElement* source, guint, gpointer data) {
  auto& feed = *static_cast<Feed*>(data);
  const cv::Mat picture = feed.picture(feed.index);
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, picture.total() * picture.elemSize(), nullptr);
  gst_buffer_fill(buffer, 0, picture.data, picture.total() * picture.elemSize());
  GST_BUFFER_PTS(buffer) =
      gst_util_uint64_scale_int(static_cast<guint64>(feed.index), GST_SECOND, feed.rate_hz);
  GST_BUFFER_DURATION(buffer) = gst_util_uint64_scale_int(1, GST_SECOND, feed.rate_hz);
  ++feed.index;
  gst_app_src_push_buffer(GST_APP_SRC(source), buffer);
}

// Overwrites bytes of an encoded picture.
GstPadProbeReturn Damage(GstPad*, GstPadProbeInfo* info, gpointer data) {
  auto& feed = *static_cast<Feed*>(data);
  if (!std::bernoulli_distribution(feed.damaged_share)(feed.random)) return GST_PAD_PROBE_OK;
  GstBuffer* buffer = gst_buffer_make_writable(GST_PAD_PROBE_INFO_BUFFER(info));
  info->data = buffer;
  GstMapInfo map;
  if (gst_buffer_map(buffer, &map, GST_MAP_WRITE) == 0) return GST_PAD_PROBE_OK;
  std::uniform_int_distribution<std::size_t> at(0, map.size - 1);
  std::uniform_int_distribution<int> byte(0, 255);
  constexpr int kBytes = 20;
  for (int i = 0; i < kBytes; ++i) map.data[at(feed.random)] = static_cast<guint8>(byte(feed.random));
  gst_buffer_unmap(buffer, &map);
  return GST_PAD_PROBE_OK;
}

}  // namespace

struct FakeRtspCamera::Impl {
  int port = 0;
  Feed feed;
  GMainContext* context = g_main_context_new();
  GMainLoop* loop = g_main_loop_new(context, FALSE);
  GstRTSPServer* server = nullptr;
  guint attached = 0;
  std::thread thread;

  static void Configure(GstRTSPMediaFactory*, GstRTSPMedia* media, gpointer self) {
    GstElement* bin = gst_rtsp_media_get_element(media);
    GstElement* source = gst_bin_get_by_name_recurse_up(GST_BIN(bin), "pictures");
    auto* feed = new Feed(static_cast<Impl*>(self)->feed);
    g_object_set_data_full(G_OBJECT(source), "feed", feed,
                           [](gpointer data) { delete static_cast<Feed*>(data); });
    g_signal_connect(source, "need-data", G_CALLBACK(&PushNext), feed);
    gst_object_unref(source);
    if (feed->damaged_share > 0.0) {
      GstElement* encoder = gst_bin_get_by_name_recurse_up(GST_BIN(bin), "encoder");
      GstPad* pad = gst_element_get_static_pad(encoder, "src");
      gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, &Damage, feed, nullptr);
      gst_object_unref(pad);
      gst_object_unref(encoder);
    }
    gst_object_unref(bin);
  }
};

FakeRtspCamera::FakeRtspCamera(int port, cv::Size size_px, int rate_hz, Picture picture, double damaged_share)
    : impl_(std::make_unique<Impl>()) {
  gst_init(nullptr, nullptr);
  impl_->port = port;
  impl_->feed = {std::move(picture), rate_hz, damaged_share};
  impl_->server = gst_rtsp_server_new();
  gst_rtsp_server_set_service(impl_->server, std::to_string(port).c_str());
  GstRTSPMediaFactory* factory = gst_rtsp_media_factory_new();
  const std::string launch = fmt::format(
      "( appsrc name=pictures is-live=true format=time max-buffers=2 block=false "
      "caps=video/x-raw,format=BGR,width={},height={},framerate={}/1 ! clocksync ! videoconvert ! "
      "video/x-raw,format=I420 ! "
      "x264enc name=encoder tune=zerolatency speed-preset=ultrafast key-int-max={} bitrate=4000 ! rtph264pay "
      "name=pay0 "
      "pt=96 )",
      size_px.width, size_px.height, rate_hz, rate_hz);
  gst_rtsp_media_factory_set_launch(factory, launch.c_str());
  gst_rtsp_media_factory_set_shared(factory, TRUE);
  g_signal_connect(factory, "media-configure", G_CALLBACK(&Impl::Configure), impl_.get());
  GstRTSPMountPoints* mounts = gst_rtsp_server_get_mount_points(impl_->server);
  gst_rtsp_mount_points_add_factory(mounts, "/live", factory);
  g_object_unref(mounts);
  impl_->attached = gst_rtsp_server_attach(impl_->server, impl_->context);
  if (impl_->attached == 0) throw std::runtime_error(fmt::format("port {} is taken", port));
  impl_->thread = std::thread([impl = impl_.get()] {
    g_main_context_push_thread_default(impl->context);
    g_main_loop_run(impl->loop);
    g_main_context_pop_thread_default(impl->context);
  });
}

FakeRtspCamera::~FakeRtspCamera() {
  // Every client is cut off.
  GList* left = gst_rtsp_server_client_filter(
      impl_->server, [](GstRTSPServer*, GstRTSPClient*, gpointer) { return GST_RTSP_FILTER_REMOVE; },
      nullptr);
  g_list_free_full(left, g_object_unref);
  g_main_loop_quit(impl_->loop);
  impl_->thread.join();
  GSource* source = g_main_context_find_source_by_id(impl_->context, impl_->attached);
  if (source != nullptr) g_source_destroy(source);
  g_object_unref(impl_->server);
  g_main_loop_unref(impl_->loop);
  g_main_context_unref(impl_->context);
}

std::string FakeRtspCamera::url() const { return fmt::format("rtsp://127.0.0.1:{}/live", impl_->port); }

}  // namespace elbowroom::recon::testing
