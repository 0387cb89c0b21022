#include "recon/light/light_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elbowroom::recon {
namespace {

// A change of the light that takes up half of the default `floor_levels` on a grey of 125 levels.
constexpr double kMostGainChange = 0.08;
// Below this, more of the picture is something else than objects and hands cover.
constexpr double kLeastAgreeingShare = 0.4;

}  // namespace

std::string PlaceInPicture(const cv::Rect& box_px, const cv::Size& picture) {
  const double x = (box_px.x + 0.5 * box_px.width) / picture.width;
  const double y = (box_px.y + 0.5 * box_px.height) / picture.height;
  const auto third = [](double at, const char* first, const char* last) {
    return std::string(at < 1.0 / 3 ? first : at > 2.0 / 3 ? last : "");
  };
  const std::string down = third(y, "upper", "lower"), across = third(x, "left", "right");
  if (down.empty() && across.empty()) return "in the middle";
  if (down.empty()) return "on the " + across;
  return across.empty() ? down + " middle" : down + " " + across;
}

std::vector<std::string> AdviceFor(const LightReport& report, const cv::Size& picture, bool is_followed) {
  std::vector<std::string> advice;
  const auto add = [&](const std::string& what) {
    advice.push_back(fmt::format("camera '{}': {}", report.camera, what));
  };
  if (report.agreeing_share < kLeastAgreeingShare) {
    add(
        fmt::format("only {:.0f} % of the background looks as it did; see whether the camera was moved or a "
                    "lamp is off, then take the background again",
                    100.0 * report.agreeing_share));
    return advice;  // the rest would be guesses
  }
  for (const LastingChange& change : report.changes) {
    add(fmt::format("the background changed {} ({:.1f} % of the picture{}); take the background again",
                    PlaceInPicture(change.box_px, picture), 100.0 * change.share,
                    change.object_share > 0.5 ? ", which counts as an object" : ""));
  }
  if (is_followed) return advice;
  if (std::abs(report.gain - 1.0) > kMostGainChange) {
    add(fmt::format(
        "the light is {:.0f} % {} than when the background was taken; take it again, or set method "
        "= \"adaptive\"",
        100.0 * std::abs(report.gain - 1.0), report.gain > 1.0 ? "brighter" : "darker"));
  }
  if (report.pulse && report.pulse->matters) {
    const std::string lamps = report.pulse->lamp_hz
                                  ? fmt::format("lamps on {:.0f} Hz mains", *report.pulse->lamp_hz / 2.0)
                                  : std::string(report.pulse->fits_lamps ? "lamps" : "the light");
    add(
        fmt::format("{} flicker by {:.0f} %; set an exposure time that is a multiple of the lamps' pulse, or "
                    "method = \"adaptive\"",
                    lamps, 100.0 * report.pulse->amplitude_share));
  }
  return advice;
}

}  // namespace elbowroom::recon
