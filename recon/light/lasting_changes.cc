#include "recon/light/lasting_changes.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

// A majority that is this sure is replaced only after as long a time with another colour; together they are
// kLastingS.
constexpr float kSureS = static_cast<float>(0.5 * LastingChanges::kLastingS);
// Another colour: in one channel by this many levels and this share of the background's.
constexpr float kLeastLevels = 10.0F, kLeastShare = 0.12F;
constexpr float kMostRestless = 0.05F;       // of a changed square
constexpr float kRestlessBeside = 0.03F;     // from here on something moves in a square
constexpr double kMostRestlessAround = 0.1;  // share of such squares around a change
constexpr double kAverageS = 20.0;           // over which a majority's colour is averaged

}  // namespace

LastingChanges::LastingChanges(const BackgroundReference& background, const core::BitMask& ignore)
    : size_(background.mean_bgr.size()), across_(size_.width / kSquarePx), down_(size_.height / kSquarePx) {
  core::Require(background.mean_bgr.type() == CV_32FC3 && !background.mean_bgr.empty() &&
                    background.sigma_bgr.type() == CV_32FC3 && background.sigma_bgr.size() == size_,
                "a background reference has mean and sigma, CV_32FC3 of one size");
  core::Require(
      ignore.width_px() == 0 || (ignore.width_px() == size_.width && ignore.height_px() == size_.height),
      "an ignore mask is of its background's size");
  for (int row = 0; row < down_; ++row) {
    for (int column = 0; column < across_; ++column) {
      Square square;
      square.place = {column * kSquarePx + kSquarePx / 2, row * kSquarePx + kSquarePx / 2};
      const auto &mean = background.mean_bgr.at<cv::Vec3f>(square.place),
                 &sigma = background.sigma_bgr.at<cv::Vec3f>(square.place);
      for (std::size_t c = 0; c < 3; ++c) {
        square.background[c] = square.majority[c] = mean[static_cast<int>(c)];
        const float noise = sigma[static_cast<int>(c)];
        square.tolerance[c] = 4.0F * std::sqrt(noise * noise + 1.0F) + 4.0F;
      }
      square.weight_s = kSureS;
      square.is_ignored = ignore.width_px() != 0 && ignore.At(square.place.x, square.place.y);
      squares_.push_back(square);
    }
  }
}

void LastingChanges::Add(const cv::Mat& image_bgr, const core::BitMask& mask, const ExposureChange& exposure,
                         double passed_s) {
  const auto passed = static_cast<float>(std::clamp(passed_s, 0.0, 1.0));
  const auto fade = static_cast<float>(1.0 - std::exp(-static_cast<double>(passed) / kSureS));
  const auto follow = static_cast<float>(1.0 - std::exp(-static_cast<double>(passed) / kAverageS));
  std::array<float, 3> per_gain{}, offset{};
  for (std::size_t c = 0; c < 3; ++c) {
    per_gain[c] = static_cast<float>(1.0 / std::max(exposure.gain[c], kLeastGain));
    offset[c] = static_cast<float>(exposure.offset_levels[c]);
  }
  for (Square& square : squares_) {
    if (square.is_ignored) continue;
    const auto& pixel = image_bgr.at<cv::Vec3b>(square.place);
    std::array<float, 3> color{};
    bool is_majority = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const float level = pixel[static_cast<int>(c)];
      color[c] = (level - offset[c]) * per_gain[c];
      // A clipped level stands for any beyond it.
      const bool is_beyond = (level >= 255.0F && color[c] < square.majority[c]) ||
                             (level <= 0.0F && color[c] > square.majority[c]);
      is_majority &= is_beyond || std::abs(color[c] - square.majority[c]) <= square.tolerance[c];
      if (is_beyond) color[c] = square.majority[c];
    }
    square.restless += fade * ((is_majority ? 0.0F : 1.0F) - square.restless);
    square.object += fade * ((mask.At(square.place.x, square.place.y) ? 1.0F : 0.0F) - square.object);
    if (is_majority) {
      square.weight_s = std::min(square.weight_s + passed, kSureS);
      for (std::size_t c = 0; c < 3; ++c) square.majority[c] += follow * (color[c] - square.majority[c]);
    } else {
      square.weight_s -= passed;
      if (square.weight_s > 0.0F) continue;
      square.majority = color, square.weight_s = 0.0F;
      square.restless = 1.0F;
    }
  }
}

bool LastingChanges::IsOther(const Square& square) {
  for (std::size_t c = 0; c < 3; ++c) {
    const float least = std::max(kLeastLevels, kLeastShare * square.background[c]);
    if (std::abs(square.majority[c] - square.background[c]) > least) return true;
  }
  return false;
}

bool LastingChanges::HasChanged(const Square& square) {
  return !square.is_ignored && square.weight_s >= kSureS && square.restless <= kMostRestless &&
         IsOther(square);
}

bool LastingChanges::IsQuietBackground(const Square& square) {
  return square.is_ignored ||
         (square.weight_s >= kSureS && square.restless <= kRestlessBeside && !IsOther(square));
}

std::vector<std::size_t> LastingChanges::Around(std::size_t square) const {
  const int x = static_cast<int>(square) % across_, y = static_cast<int>(square) / across_;
  std::vector<std::size_t> around;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, down_ - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, across_ - 1); ++u)
      if (u != x || v != y) around.push_back(static_cast<std::size_t>(v * across_ + u));
  return around;
}

std::vector<LastingChange> LastingChanges::Changes() const {
  std::vector<std::uint8_t> is_waiting(squares_.size());
  for (std::size_t i = 0; i < squares_.size(); ++i) is_waiting[i] = HasChanged(squares_[i]) ? 1 : 0;
  const std::vector<std::uint8_t> has_changed = is_waiting;
  std::vector<LastingChange> changes;
  for (std::size_t first = 0; first < squares_.size(); ++first) {
    if (is_waiting[first] == 0) continue;
    is_waiting[first] = 0;
    std::vector<std::size_t> group{first}, beside;
    LastingChange change;
    for (std::size_t next = 0; next < group.size(); ++next) {
      const Square& square = squares_[group[next]];
      change.box_px |=
          cv::Rect(square.place.x - kSquarePx / 2, square.place.y - kSquarePx / 2, kSquarePx, kSquarePx);
      change.object_share += static_cast<double>(square.object);
      for (const std::size_t other : Around(group[next])) {
        if (is_waiting[other] != 0) is_waiting[other] = 0, group.push_back(other);
        if (has_changed[other] == 0) beside.push_back(other);
      }
    }
    std::ranges::sort(beside);
    beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
    const auto restless =
        std::ranges::count_if(beside, [&](std::size_t i) { return !IsQuietBackground(squares_[i]); });
    if (group.size() < kLeastSquares ||
        static_cast<double>(restless) > kMostRestlessAround * static_cast<double>(beside.size()))
      continue;
    change.object_share /= static_cast<double>(group.size());
    change.share = static_cast<double>(group.size()) / static_cast<double>(squares_.size());
    changes.push_back(change);
  }
  std::ranges::sort(changes, std::greater<>(), &LastingChange::share);
  return changes;
}

}  // namespace elbowroom::recon
