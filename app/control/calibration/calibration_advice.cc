#include "app/control/calibration/calibration_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>

namespace elbowroom::control {
namespace {

using recon::CalibrationInput;
using recon::CalibrationResult;

constexpr int kAcross = 3;  // parts of a picture, each way
constexpr std::array<const char*, kAcross* kAcross> kParts = {
    "the upper left", "the top",        "the upper right", "the left side",  "the middle",
    "the right side", "the lower left", "the bottom",      "the lower right"};
constexpr int kFewPointsInAPart = 8;
constexpr int kFewViews = 10;
constexpr int kFewShared = 5;

bool IsUsed(const CalibrationResult& result, std::size_t view) { return result.views[view].is_used; }

std::string Listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

// Parts of the camera's picture in which hardly any point of the board was.
std::vector<std::string> UnseenParts(const CalibrationInput& input, const CalibrationResult& result,
                                     int camera) {
  const recon::CalibrationCamera& of_input = input.cameras[static_cast<std::size_t>(camera)];
  std::array<int, kAcross * kAcross> counts{};
  for (std::size_t i = 0; i < input.views.size(); ++i) {
    if (input.views[i].camera != camera || !IsUsed(result, i)) continue;
    for (const recon::SightedPoint& point : input.views[i].sighting.points) {
      const auto part = [](double at, int size) {
        return std::clamp(static_cast<int>(at / size * kAcross), 0, kAcross - 1);
      };
      const int x = part(point.pixel.x() + 0.5, of_input.width_px),
                y = part(point.pixel.y() + 0.5, of_input.height_px);
      ++counts[static_cast<std::size_t>(y * kAcross + x)];
    }
  }
  std::vector<std::string> unseen;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] < kFewPointsInAPart) unseen.emplace_back(kParts[i]);
  return unseen;
}

int SetsSharedBy(const CalibrationInput& input, const CalibrationResult& result, int a, int b) {
  std::set<int> of_a, of_both;
  for (const int camera : {a, b}) {
    for (std::size_t i = 0; i < input.views.size(); ++i) {
      const recon::CalibrationView& view = input.views[i];
      if (view.camera != camera || !view.set || !IsUsed(result, i)) continue;
      if (camera == a) of_a.insert(*view.set);
      if (camera == b && of_a.contains(*view.set)) of_both.insert(*view.set);
    }
  }
  return static_cast<int>(of_both.size());
}

}  // namespace

std::vector<std::string> AdviceFor(const CalibrationInput& input, const CalibrationResult& result) {
  std::vector<std::string> advice;
  const int cameras = static_cast<int>(input.cameras.size());
  for (int camera = 0; camera < cameras; ++camera) {
    const auto at = static_cast<std::size_t>(camera);
    const std::string& name = input.cameras[at].name;
    if (input.cameras[at].known) continue;  // its lens needs no pictures
    if (const std::vector<std::string> unseen = UnseenParts(input, result, camera); !unseen.empty()) {
      advice.push_back(
          unseen.size() == kParts.size()
              ? fmt::format("camera '{}' hasn't seen the board enough anywhere; hold it all over its picture",
                            name)
              : fmt::format("camera '{}' hasn't seen the board in {}; hold it there", name, Listed(unseen)));
    }
    if (result.cameras[at].views_used < kFewViews) {
      advice.push_back(
          fmt::format("camera '{}' has {} views; take {} or more, the board tilted this way and that", name,
                      result.cameras[at].views_used, kFewViews));
    }
  }
  if (input.world.kind == recon::CalibrationWorld::Kind::kBoardOfSet && cameras > 1) {
    for (int camera = 0; camera < cameras; ++camera) {
      int most = 0;
      for (int other = 0; other < cameras; ++other)
        if (other != camera) most = std::max(most, SetsSharedBy(input, result, camera, other));
      if (most < kFewShared) {
        advice.push_back(fmt::format(
            "camera '{}' shares {} with any other camera; show the board to it and to a neighbour at once, "
            "{} "
            "times or more",
            input.cameras[static_cast<std::size_t>(camera)].name,
            most == 1 ? std::string("one instant") : fmt::format("{} instants", most), kFewShared));
      }
    }
  }
  return advice;
}

}  // namespace elbowroom::control
