#include "recon/capture/device/camera_protocol.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

namespace elbowroom::recon {
namespace {

double OrNan(const std::optional<double>& value) {
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

std::optional<double> Known(double value) { return std::isnan(value) ? std::nullopt : std::optional(value); }

}  // namespace

CameraOrder OrderFor(const DeviceRequest& request) {
  const CaptureSettings& settings = request.settings;
  CameraOrder order{request.width_px,        request.height_px,
                    OrNan(settings.rate_hz), OrNan(settings.exposure_us),
                    OrNan(settings.gain_db), OrNan(settings.white_balance_k),
                    settings.trigger,        settings.packet_bytes.value_or(0)};
  std::copy_n(settings.pixel_format.begin(),
              std::min(settings.pixel_format.size(), order.pixel_format.size() - 1),
              order.pixel_format.begin());
  return order;
}

DeviceRequest RequestOf(const CameraOrder& order, std::string_view location) {
  CaptureSettings settings;
  settings.rate_hz = Known(order.rate_hz);
  settings.exposure_us = Known(order.exposure_us);
  settings.gain_db = Known(order.gain_db);
  settings.white_balance_k = Known(order.white_balance_k);
  settings.trigger = order.trigger;
  settings.pixel_format = order.pixel_format.data();
  if (order.packet_bytes > 0) settings.packet_bytes = order.packet_bytes;
  return {std::string(location), order.width_px, order.height_px, std::move(settings)};
}

CameraNews NewsOf(const DeviceReport& report) {
  CameraNews news{CameraNewsKind::kStarted};
  news.rate_hz = OrNan(report.rate_hz);
  news.exposure_us = OrNan(report.exposure_us);
  news.gain_db = OrNan(report.gain_db);
  news.white_balance_k = OrNan(report.white_balance_k);
  return news;
}

std::string TextOf(const DeviceReport& report) {
  std::string text = report.name;
  for (const std::string& warning : report.warnings) text += '\n' + warning;
  return text;
}

DeviceReport ReportOf(const CameraNews& news, std::string_view text) {
  DeviceReport report{
      "", Known(news.rate_hz), Known(news.exposure_us), Known(news.gain_db), Known(news.white_balance_k), {}};
  std::istringstream lines{std::string(text)};
  std::getline(lines, report.name);
  for (std::string line; std::getline(lines, line);) report.warnings.push_back(line);
  return report;
}

}  // namespace elbowroom::recon
