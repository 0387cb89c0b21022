#include "recon/capture/genicam/genicam_camera.h"

#include <arv.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "recon/capture/device/device_clock.h"
#include "recon/capture/device/picture_count.h"
#include "recon/capture/device/pixel_layout.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;

// At 30 pictures a second, a quarter of a second of pictures may wait.
constexpr int kBuffers = 8;

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
using CameraHandle = std::unique_ptr<ArvCamera, Unref>;
using StreamHandle = std::unique_ptr<ArvStream, Unref>;

// What Aravis had to complain of in one call.
class Complaint {
 public:
  Complaint() = default;
  ~Complaint() { g_clear_error(&error_); }
  Complaint(const Complaint&) = delete;
  Complaint& operator=(const Complaint&) = delete;

  [[nodiscard]] GError** out() { return &error_; }
  [[nodiscard]] bool is_any() const { return error_ != nullptr; }
  [[nodiscard]] std::string text() const { return is_any() ? error_->message : ""; }

 private:
  GError* error_ = nullptr;
};

struct KnownFormat {
  std::string_view name;  // GenICam's
  PixelLayout layout;
};
// Colour in as few bytes as possible comes first.
constexpr std::array<KnownFormat, 7> kKnownFormats{{{"BayerRG8", PixelLayout::kBayerRg8},
                                                    {"BayerGR8", PixelLayout::kBayerGr8},
                                                    {"BayerGB8", PixelLayout::kBayerGb8},
                                                    {"BayerBG8", PixelLayout::kBayerBg8},
                                                    {"BGR8", PixelLayout::kBgr8},
                                                    {"RGB8", PixelLayout::kRgb8},
                                                    {"Mono8", PixelLayout::kMono8}}};

class GenicamCamera : public CameraDevice {
 public:
  explicit GenicamCamera(const DeviceRequest& request)
      : request_(request), address_(request.location.substr(std::string_view("gige:").size())) {
    Complaint complaint;
    camera_.reset(arv_camera_new(address_.empty() ? nullptr : address_.c_str(), complaint.out()));
    if (!camera_) {
      Fail(fmt::format("doesn't answer ({}); check its cable, its power and its address", complaint.text()));
    }
    g_signal_connect(arv_camera_get_device(camera_.get()), "control-lost", G_CALLBACK(&OnControlLost), this);
    Name();
    SetSize();
    SetPixelFormat();
    SetValues();
    SetTrigger();
    Start();
  }

  ~GenicamCamera() override {
    Complaint complaint;
    g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera_.get()), this);
    if (!is_gone_) arv_camera_stop_acquisition(camera_.get(), complaint.out());
  }
  GenicamCamera(const GenicamCamera&) = delete;
  GenicamCamera& operator=(const GenicamCamera&) = delete;

  [[nodiscard]] const DeviceReport& report() const override { return report_; }

  [[nodiscard]] std::optional<DevicePicture> Next(std::chrono::milliseconds most_wait,
                                                  cv::Mat& image_bgr) override {
    if (is_gone_) Fail("is gone; check its cable and its power");
    ArvBuffer* buffer = arv_stream_timeout_pop_buffer(
        stream_.get(), static_cast<guint64>(std::chrono::microseconds(most_wait).count()));
    if (buffer == nullptr) return std::nullopt;
    const std::optional<DevicePicture> picture = Take(buffer, image_bgr);
    arv_stream_push_buffer(stream_.get(), buffer);
    return picture;
  }

  void Trigger() override {
    Complaint complaint;
    arv_camera_software_trigger(camera_.get(), complaint.out());
    if (complaint.is_any()) Fail(fmt::format("takes no trigger ({})", complaint.text()));
  }

 private:
  static void OnControlLost(ArvDevice*, gpointer self) {
    static_cast<GenicamCamera*>(self)->is_gone_ = true;  // on Aravis' thread
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw Error(ErrorKind::kCamera, fmt::format("'{}' {}", request_.location, what));
  }

  void Warn(const std::string& what) { report_.warnings.push_back(what); }

  void Name() {
    const char* vendor = arv_camera_get_vendor_name(camera_.get(), nullptr);
    const char* model = arv_camera_get_model_name(camera_.get(), nullptr);
    const char* serial = arv_camera_get_device_serial_number(camera_.get(), nullptr);
    const auto text = [](const char* known) { return known == nullptr ? "?" : known; };
    report_.name = fmt::format("{} {} ({})", text(vendor), text(model), text(serial));
  }

  // The region keeps its place on the sensor.
  void SetSize() {
    Complaint complaint;
    arv_camera_set_region(camera_.get(), -1, -1, request_.width_px, request_.height_px, complaint.out());
    gint x = 0, y = 0, width_px = 0, height_px = 0;
    arv_camera_get_region(camera_.get(), &x, &y, &width_px, &height_px, nullptr);
    if (width_px != request_.width_px || height_px != request_.height_px) {
      Fail(fmt::format("gives {} x {} px, but it was calibrated with {} x {}; calibrate it again", width_px,
                       height_px, request_.width_px, request_.height_px));
    }
  }

  void SetPixelFormat() {
    guint count = 0;
    const char** names = arv_camera_dup_available_pixel_formats_as_strings(camera_.get(), &count, nullptr);
    const std::vector<std::string> offered(names, names + count);
    g_free(static_cast<gpointer>(names));
    const auto is_offered = [&](const KnownFormat& format) {
      return std::ranges::find(offered, format.name) != offered.end() &&
             (request_.settings.pixel_format.empty() || request_.settings.pixel_format == format.name);
    };
    const auto* chosen = std::ranges::find_if(kKnownFormats, is_offered);
    if (chosen == kKnownFormats.end()) {
      Fail(fmt::format("gives no pixel format that is known{}; it offers {}",
                       request_.settings.pixel_format.empty()
                           ? ""
                           : fmt::format(" and called '{}'", request_.settings.pixel_format),
                       fmt::join(offered, ", ")));
    }
    Complaint complaint;
    arv_camera_set_pixel_format_from_string(camera_.get(), std::string(chosen->name).c_str(),
                                            complaint.out());
    if (complaint.is_any())
      Fail(fmt::format("refuses the pixel format {} ({})", chosen->name, complaint.text()));
    layout_ = chosen->layout;
  }

  // Sets a value where one is asked for; reads it back in any case.
  template <typename IsThere, typename Set, typename Get>
  std::optional<double> SetAndReadBack(const char* what, const std::optional<double>& wanted,
                                       IsThere is_there, Set set, Get get) {
    if (is_there(camera_.get(), nullptr) == 0) {
      if (wanted) Warn(fmt::format("{} can't be set", what));
      return std::nullopt;
    }
    Complaint refused, unread;
    if (wanted) set(*wanted, refused.out());
    if (refused.is_any()) Warn(fmt::format("{} {:g} is refused ({})", what, *wanted, refused.text()));
    const double value = get(camera_.get(), unread.out());
    if (unread.is_any()) return std::nullopt;
    constexpr double kCloseEnough = 0.02;
    if (wanted && !refused.is_any() && std::abs(value - *wanted) > kCloseEnough * std::abs(*wanted))
      Warn(fmt::format("{} is {:g}, not {:g}", what, value, *wanted));
    return value;
  }

  void SetValues() {
    ArvCamera* camera = camera_.get();
    const CaptureSettings& wanted = request_.settings;
    report_.rate_hz = SetAndReadBack(
        "rate_hz", wanted.rate_hz, arv_camera_is_frame_rate_available,
        [&](double value, GError** error) { arv_camera_set_frame_rate(camera, value, error); },
        arv_camera_get_frame_rate);
    report_.exposure_us = SetAndReadBack(
        "exposure_us", wanted.exposure_us, arv_camera_is_exposure_time_available,
        [&](double value, GError** error) {
          if (arv_camera_is_exposure_auto_available(camera, nullptr) != 0)
            arv_camera_set_exposure_time_auto(camera, ARV_AUTO_OFF, nullptr);
          arv_camera_set_exposure_time(camera, value, error);
        },
        arv_camera_get_exposure_time);
    report_.gain_db = SetAndReadBack(
        "gain_db", wanted.gain_db, arv_camera_is_gain_available,
        [&](double value, GError** error) {
          if (arv_camera_is_gain_auto_available(camera, nullptr) != 0)
            arv_camera_set_gain_auto(camera, ARV_AUTO_OFF, nullptr);
          arv_camera_set_gain(camera, value, error);
        },
        arv_camera_get_gain);
    // GenICam has no temperature of colour; a fixed balance is what keeps colours comparable.
    if (arv_camera_is_feature_available(camera, "BalanceWhiteAuto", nullptr) != 0)
      arv_camera_set_string(camera, "BalanceWhiteAuto", "Off", nullptr);
    if (wanted.white_balance_k) Warn("white_balance_k can't be set; automatic white balance is off");
  }

  void SetTrigger() {
    Complaint complaint;
    switch (request_.settings.trigger) {
      case CaptureTrigger::kFree:
        arv_camera_clear_triggers(camera_.get(), complaint.out());
        break;
      case CaptureTrigger::kSoftware:
        arv_camera_set_trigger(camera_.get(), "Software", complaint.out());
        break;
      case CaptureTrigger::kHardware:
        arv_camera_set_trigger(camera_.get(), "Line0", complaint.out());
        break;
    }
    if (complaint.is_any() && request_.settings.trigger != CaptureTrigger::kFree)
      Fail(fmt::format("refuses the trigger \"{}\" ({})", ToString(request_.settings.trigger),
                       complaint.text()));
  }

  void SetPacketSize() {
    if (arv_camera_is_gv_device(camera_.get()) == 0) return;
    Complaint complaint;
    if (const auto& wanted = request_.settings.packet_bytes) {
      arv_camera_gv_set_packet_size_adjustment(camera_.get(), ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
      arv_camera_gv_set_packet_size(camera_.get(), *wanted, complaint.out());
    } else {
      (void)arv_camera_gv_auto_packet_size(camera_.get(), complaint.out());
    }
    if (complaint.is_any()) Warn(fmt::format("the size of packets can't be set ({})", complaint.text()));
  }

  void Start() {
    SetPacketSize();
    Complaint complaint;
    stream_.reset(arv_camera_create_stream(camera_.get(), nullptr, nullptr, complaint.out()));
    if (!stream_) Fail(fmt::format("opens no stream ({}); is it used by another program?", complaint.text()));
    const guint payload = arv_camera_get_payload(camera_.get(), nullptr);
    for (int i = 0; i < kBuffers; ++i)
      arv_stream_push_buffer(stream_.get(), arv_buffer_new_allocate(payload));
    arv_camera_set_acquisition_mode(camera_.get(), ARV_ACQUISITION_MODE_CONTINUOUS, nullptr);
    arv_camera_start_acquisition(camera_.get(), complaint.out());
    if (complaint.is_any()) Fail(fmt::format("doesn't start ({})", complaint.text()));
  }

  // Nothing: a buffer that came back empty.
  std::optional<DevicePicture> Take(ArvBuffer* buffer, cv::Mat& image_bgr) {
    const std::int64_t now_ns = MonotonicNs(), now_real_ns = g_get_real_time() * 1000;
    const ArvBufferStatus status = arv_buffer_get_status(buffer);
    if (status == ARV_BUFFER_STATUS_CLEARED || status == ARV_BUFFER_STATUS_ABORTED) return std::nullopt;
    const auto number = count_.Next(arv_buffer_get_frame_id(buffer));
    if (!number) return std::nullopt;
    // When the first of its packets came.
    const auto begun_ns =
        now_ns - (now_real_ns - static_cast<std::int64_t>(arv_buffer_get_system_timestamp(buffer)));
    const std::int64_t end_of_exposure_ns =
        clock_.OnComputersClock(static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer)), begun_ns);
    const auto half_ns = static_cast<std::int64_t>(report_.exposure_us.value_or(0.0) * 1000.0 / 2.0);
    DevicePicture picture{PictureState::kWhole, *number, end_of_exposure_ns - half_ns, now_ns,
                          StampSource::kDevice};
    std::size_t size = 0;
    const void* data = arv_buffer_get_data(buffer, &size);
    const std::size_t row_bytes = BytesPerRow(layout_, request_.width_px);
    if (status != ARV_BUFFER_STATUS_SUCCESS || data == nullptr ||
        size < row_bytes * static_cast<std::size_t>(request_.height_px)) {
      picture.state = PictureState::kIncomplete;
      return picture;
    }
    ToBgr({static_cast<const std::byte*>(data), size}, layout_, {request_.width_px, request_.height_px},
          row_bytes, image_bgr);
    return picture;
  }

  DeviceRequest request_;
  std::string address_;
  DeviceReport report_;
  PixelLayout layout_ = PixelLayout::kMono8;
  DeviceClock clock_;
  PictureCount count_;
  std::atomic<bool> is_gone_{false};
  CameraHandle camera_;
  StreamHandle stream_;  // goes before the camera
};

}  // namespace

std::unique_ptr<CameraDevice> OpenGenicamCamera(const DeviceRequest& request) {
  return std::make_unique<GenicamCamera>(request);
}

std::vector<std::string> FindGenicamCameras() {
  arv_update_device_list();
  std::vector<std::string> names;
  for (unsigned int i = 0; i < arv_get_n_devices(); ++i)
    if (const char* id = arv_get_device_id(i)) names.emplace_back(id);
  return names;
}

}  // namespace elbowroom::recon
