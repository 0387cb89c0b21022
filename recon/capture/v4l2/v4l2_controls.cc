#include "recon/capture/v4l2/v4l2_controls.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <cmath>
#include <optional>

namespace elbowroom::recon {
namespace {

// A setting, and what the driver calls it.
struct Control {
  const char* name;
  std::uint32_t id;
  double per_unit;          // driver's units for one of ours
  std::uint32_t automatic;  // the control that lets the device do it by itself
  std::int32_t by_hand;     // its value for: not by itself
};

constexpr Control kExposure{"exposure_us", V4L2_CID_EXPOSURE_ABSOLUTE, 0.01, V4L2_CID_EXPOSURE_AUTO,
                            V4L2_EXPOSURE_MANUAL};
// Drivers count gain in steps of their own.
constexpr Control kGain{"gain_db", V4L2_CID_GAIN, 1.0, V4L2_CID_AUTOGAIN, 0};
constexpr Control kWhiteBalance{"white_balance_k", V4L2_CID_WHITE_BALANCE_TEMPERATURE, 1.0,
                                V4L2_CID_AUTO_WHITE_BALANCE, 0};

bool Set(VideoSystem& system, std::uint32_t id, std::int32_t value) {
  v4l2_control control{id, value};
  return system.Ioctl(VIDIOC_S_CTRL, &control) == 0;
}

std::optional<std::int32_t> Get(VideoSystem& system, std::uint32_t id) {
  v4l2_control control{id, 0};
  if (system.Ioctl(VIDIOC_G_CTRL, &control) != 0) return std::nullopt;
  return control.value;
}

std::optional<double> SetAndReadBack(const Control& control, const std::optional<double>& wanted,
                                     VideoSystem& system, DeviceReport* report) {
  if (wanted) {
    (void)Set(system, control.automatic, control.by_hand);  // not every device can do it by itself
    if (!Set(system, control.id, static_cast<std::int32_t>(std::lround(*wanted * control.per_unit)))) {
      report->warnings.push_back(fmt::format("{} {:g} is refused by the driver", control.name, *wanted));
    }
  }
  const std::optional<std::int32_t> value = Get(system, control.id);
  if (!value) return std::nullopt;
  const double read = *value / control.per_unit;
  if (wanted && std::abs(read - *wanted) > 0.5 / control.per_unit + 0.02 * std::abs(*wanted))
    report->warnings.push_back(fmt::format("{} is {:g}, not {:g}", control.name, read, *wanted));
  return read;
}

}  // namespace

void SetControls(const CaptureSettings& wanted, VideoSystem& system, DeviceReport* report) {
  report->exposure_us = SetAndReadBack(kExposure, wanted.exposure_us, system, report);
  report->gain_db = SetAndReadBack(kGain, wanted.gain_db, system, report);
  if (wanted.gain_db && report->gain_db)
    report->warnings.emplace_back("gain_db is in the driver's own steps, which needn't be dB");
  report->white_balance_k = SetAndReadBack(kWhiteBalance, wanted.white_balance_k, system, report);
}

}  // namespace elbowroom::recon
