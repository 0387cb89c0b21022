#include "tests/recon/capture/fake_gige_camera.h"

#include <arv.h>

#include <atomic>
#include <stdexcept>
#include <utility>

namespace elbowroom::recon::testing {

struct FakeGigeCamera::Impl {
  Fill fill;
  std::atomic<std::int64_t> sent{0};
  ArvGvFakeCamera* camera = nullptr;

  static void FillPattern(ArvBuffer* buffer, void* self, guint32 exposure_us, guint32 gain,
                          ArvPixelFormat format) {
    auto& impl = *static_cast<Impl*>(self);
    std::size_t size = 0;
    void* data = const_cast<void*>(arv_buffer_get_data(buffer, &size));
    const bool is_colour = format == ARV_PIXEL_FORMAT_RGB_8_PACKED;
    cv::Mat pixels(arv_buffer_get_image_height(buffer), arv_buffer_get_image_width(buffer),
                   is_colour ? CV_8UC3 : CV_8UC1, data);
    const Clock::time_point taken_at =
        impl.fill(impl.sent++, {static_cast<double>(exposure_us), gain}, pixels);
    const auto ago = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - taken_at);
    arv_buffer_set_timestamp(buffer, static_cast<guint64>(g_get_real_time() - ago.count()) * 1000);
  }
};

FakeGigeCamera::FakeGigeCamera(const std::string& address, const std::string& serial, Fill fill)
    : impl_(std::make_unique<Impl>()) {
  impl_->fill = std::move(fill);
  impl_->camera = arv_gv_fake_camera_new(address.c_str(), serial.c_str());
  if (arv_gv_fake_camera_is_running(impl_->camera) == 0) {
    g_object_unref(impl_->camera);
    throw std::runtime_error("no camera can be at " + address);
  }
  arv_fake_camera_set_fill_pattern(arv_gv_fake_camera_get_fake_camera(impl_->camera), &Impl::FillPattern,
                                   impl_.get());
}

FakeGigeCamera::~FakeGigeCamera() { g_object_unref(impl_->camera); }

void FakeGigeCamera::SetPacketLoss(double share) {
  g_object_set(impl_->camera, "gvsp-lost-ratio", share, nullptr);
}

std::int64_t FakeGigeCamera::pictures_sent() const { return impl_->sent; }

}  // namespace elbowroom::recon::testing
