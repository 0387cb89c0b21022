#include "tests/recon/segmentation/boundary_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace elbowroom::recon {
namespace {

using Place = cv::Point;
using Bgr = std::array<float, 3>;

float Dot(const Bgr& p, const Bgr& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
Bgr Minus(const Bgr& p, const Bgr& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }
Bgr Times(float s, const Bgr& p) { return {s * p[0], s * p[1], s * p[2]}; }

// One picture; single precision throughout, in the order of coverage_kernel.cc, so that it rounds alike.
class Oracle {
 public:
  Oracle(const core::BitMask& detected, const cv::Mat& image_bgr, const cv::Mat& packed_mean, double contrast)
      : detected_(detected),
        image_bgr_(image_bgr),
        packed_mean_(packed_mean),
        contrast2_(static_cast<float>(contrast * contrast)) {}

  // Nothing where object and background are too alike.
  [[nodiscard]] std::optional<std::uint8_t> Level(Place place) const {
    const Place direction = Inwards(place);
    const float light = Light(place, direction);
    const Bgr object = Object(place, direction, light);
    const float contrast2 = Dot(object, object);
    if (!(contrast2 > 0.0F) || contrast2 < contrast2_) return std::nullopt;
    const float per_contrast2 = 1.0F / contrast2;
    const auto alpha_of = [&](Place at) {
      const Bgr difference = Minus(Image(at), Times(light, Mean(at)));
      return std::clamp(Dot(difference, object) * per_contrast2, 0.0F, 1.0F);
    };
    const Place axis = std::abs(direction.x) >= std::abs(direction.y) ? Place(1, 0) : Place(0, 1);
    const auto or_itself = [&](Place at) { return IsPixel(at) ? at : place; };
    const float alpha = alpha_of(place);
    const float sum_px = alpha + alpha_of(or_itself(place - axis)) + alpha_of(or_itself(place + axis)) - 1.5F;
    const bool is_object = alpha >= 0.5F;
    const float inside_px = is_object != (sum_px > 0.0F) ? alpha - 0.5F : sum_px;
    const float level = 128.0F + 127.5F * std::clamp(inside_px, -1.0F, 0.999F);
    return static_cast<std::uint8_t>(is_object ? std::max(level, 128.0F) : std::min(level, 127.0F));
  }

 private:
  [[nodiscard]] bool IsPixel(Place p) const { return p.inside({{0, 0}, image_bgr_.size()}); }
  [[nodiscard]] bool IsObject(Place p) const { return IsPixel(p) && detected_.At(p.x, p.y); }
  [[nodiscard]] Bgr Image(Place p) const {
    const auto& levels = image_bgr_.at<cv::Vec3b>(p);
    return {static_cast<float>(levels[0]), static_cast<float>(levels[1]), static_cast<float>(levels[2])};
  }
  [[nodiscard]] Bgr Mean(Place p) const {
    const auto packed = static_cast<unsigned>(packed_mean_.at<std::int32_t>(p));
    const auto quarters = [&](unsigned shift) { return static_cast<float>((packed >> shift) & 1023U); };
    return {quarters(0) / 4.0F, quarters(10) / 4.0F, quarters(20) / 4.0F};
  }

  // The first moments of the labels of 5 x 5 pixels; the picture's edge is repeated.
  [[nodiscard]] Place Inwards(Place place) const {
    Place moment;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx)
        if (detected_.At(std::clamp(place.x + dx, 0, detected_.width_px() - 1),
                         std::clamp(place.y + dy, 0, detected_.height_px() - 1)))
          moment += Place(dx, dy);
    return moment;
  }

  static Place Step(Place direction, int steps) {
    const double length = std::hypot(direction.x, direction.y);
    return {static_cast<int>(std::lround(steps * direction.x / length)),
            static_cast<int>(std::lround(steps * direction.y / length))};
  }

  // The share of light that is left two and three pixels outwards.
  [[nodiscard]] float Light(Place place, Place direction) const {
    float im = 0.0F, mm = 0.0F;
    for (const int steps : {2, 3}) {
      if (direction == Place()) break;
      const Place at = place - Step(direction, steps);
      if (!IsPixel(at) || IsObject(at)) break;
      im += Dot(Image(at), Mean(at)), mm += Dot(Mean(at), Mean(at));
    }
    return mm > 0.0F ? std::clamp(im / mm, 0.3F, 1.5F) : 1.0F;
  }

  // The whole object's colour less the background's.
  [[nodiscard]] Bgr Object(Place place, Place direction, float light) const {
    const Bgr background = Times(light, Mean(place));
    const int first = detected_.At(place.x, place.y) ? 1 : 2;
    if (direction == Place() || !IsObject(place + Step(direction, first)))
      return Minus(Strongest(place), background);
    const Place at = place + Step(direction, first), further = place + Step(direction, first + 1);
    const Bgr near = Minus(Image(at), background);
    const Bgr far = Minus(Image(IsObject(further) ? further : at), background);
    return Dot(near, far) >= 0.85F * Dot(far, far) ? near : far;
  }

  // The first of 3 x 3 object pixels with the strongest difference.
  [[nodiscard]] Bgr Strongest(Place place) const {
    Bgr strongest = Image(place);
    float most = -1.0F;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Place at = place + Place(dx, dy);
        if (!IsObject(at)) continue;
        const Bgr difference = Minus(Image(at), Mean(at));  // in quarters: exact in single precision
        if (Dot(difference, difference) > most) most = Dot(difference, difference), strongest = Image(at);
      }
    }
    return strongest;
  }

  const core::BitMask& detected_;
  const cv::Mat& image_bgr_;
  const cv::Mat& packed_mean_;
  float contrast2_;
};

template <typename Visit>
void ForEachBoundaryPixel(const core::BitMask& mask, Visit visit) {
  const core::BitMask boundary = core::BoundaryPixels(mask);
  for (int y = 0; y < mask.height_px(); ++y)
    for (int x = 0; x < mask.width_px(); ++x)
      if (boundary.At(x, y)) visit(x, y);
}

}  // namespace

core::SoftMask LocateBoundarySlowly(const core::BitMask& detected, const cv::Mat& image_bgr,
                                    const cv::Mat& packed_mean, double least_contrast_levels) {
  const Oracle oracle(detected, image_bgr, packed_mean, least_contrast_levels);
  core::SoftMask located{detected, {}};
  std::map<std::pair<int, int>, int> levels;
  const auto level_of = [&](int x, int y) {
    const int otherwise = located.mask.At(x, y) ? 191 : 64;
    const auto [found, is_new] = levels.try_emplace({x, y}, 0);
    if (is_new) found->second = oracle.Level({x, y}).value_or(otherwise);
    return found->second;
  };
  for (int round = 0; round < 2; ++round) {
    const core::BitMask before = located.mask;
    ForEachBoundaryPixel(before, [&](int x, int y) {
      if (levels.contains({x, y}) || (round == 0 && !before.At(x, y))) return;
      located.mask.Set(x, y, level_of(x, y) >= 128);
    });
  }
  ForEachBoundaryPixel(located.mask, [&](int x, int y) {
    const int level = level_of(x, y);
    located.levels.push_back(
        static_cast<std::uint8_t>(located.mask.At(x, y) ? std::max(level, 128) : std::min(level, 127)));
  });
  return located;
}

}  // namespace elbowroom::recon
