#include "recon/boundary.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

struct Bgr {
  float b = 0.0F, g = 0.0F, r = 0.0F;
};
Bgr operator-(const Bgr& p, const Bgr& q) { return {p.b - q.b, p.g - q.g, p.r - q.r}; }
Bgr operator*(float s, const Bgr& p) { return {s * p.b, s * p.g, s * p.r}; }
float Dot(const Bgr& p, const Bgr& q) { return p.b * q.b + p.g * q.g + p.r * q.r; }

struct Offset {
  int x = 0, y = 0;
  bool operator==(const Offset&) const = default;
};
// One to three pixels along a direction, rounded to pixels; zero without a direction.
struct Steps {
  Offset one, two, three;
};

// A pixel's share of object, and how far inside the boundary its centre lies along a row or column.
struct Coverage {
  float alpha = 0.0F;
  float inside_px = 0.0F;
};

class Scene {
 public:
  Scene(const core::BitMask& detected, const cv::Mat& image_bgr, const cv::Mat& mean_bgr,
        float least_contrast_levels)
      : detected_(detected),
        image_(image_bgr.data),
        image_stride_(image_bgr.step[0]),
        mean_(mean_bgr.ptr<float>()),
        mean_stride_(mean_bgr.step[0] / sizeof(float)),
        width_(detected.width_px()),
        height_(detected.height_px()),
        least_contrast2_(least_contrast_levels * least_contrast_levels) {}

  // Nothing where object and background are too alike.
  [[nodiscard]] std::optional<Coverage> At(int x, int y) const;

 private:
  [[nodiscard]] bool IsPixel(int x, int y) const { return x >= 0 && x < width_ && y >= 0 && y < height_; }
  [[nodiscard]] Bgr Image(int x, int y) const {
    const std::uint8_t* p = image_ + static_cast<std::size_t>(y) * image_stride_ + 3 * x;
    return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
  }
  [[nodiscard]] Bgr Mean(int x, int y) const {
    const float* p = mean_ + static_cast<std::size_t>(y) * mean_stride_ + 3 * x;
    return {p[0], p[1], p[2]};
  }
  [[nodiscard]] Offset Inwards(int x, int y) const;
  [[nodiscard]] Bgr ObjectColor(int x, int y, const Steps& steps, const Bgr& background) const;
  [[nodiscard]] float BackgroundLight(int x, int y, const Steps& steps) const;
  [[nodiscard]] Bgr StrongestAround(int x, int y) const;

  const core::BitMask& detected_;
  const std::uint8_t* image_;
  std::size_t image_stride_;
  const float* mean_;
  std::size_t mean_stride_;
  int width_, height_;
  float least_contrast2_;
};

// Five pixels of a row as bits; those beyond the picture repeat its edge.
unsigned FiveOf(const std::uint64_t* row, int x, int width) {
  if (x >= 2 && x + 2 < width) {
    const auto first = static_cast<unsigned>(x - 2);
    const unsigned shift = first & 63U;
    std::uint64_t bits = row[first >> 6U] >> shift;
    if (shift > 59U) bits |= row[(first >> 6U) + 1] << (64U - shift);
    return static_cast<unsigned>(bits) & 31U;
  }
  unsigned bits = 0;
  for (int i = 0; i < 5; ++i) {
    const auto at = static_cast<unsigned>(std::clamp(x - 2 + i, 0, width - 1));
    bits |= (static_cast<unsigned>(row[at >> 6U] >> (at & 63U)) & 1U) << static_cast<unsigned>(i);
  }
  return bits;
}

constexpr std::array<int, 32> kMomentOfFive = [] {
  std::array<int, 32> moments{};
  for (int bits = 0; bits < 32; ++bits) {
    for (int i = 0; i < 5; ++i) moments[static_cast<std::size_t>(bits)] += ((bits >> i) & 1) * (i - 2);
  }
  return moments;
}();

// The direction from background to object: first moments of the labels of 5 x 5 pixels.
Offset Scene::Inwards(int x, int y) const {
  Offset gradient;
  for (int dy = -2; dy <= 2; ++dy) {
    const auto at = static_cast<std::size_t>(std::clamp(y + dy, 0, height_ - 1));
    const unsigned five = FiveOf(detected_.words().data() + at * detected_.words_per_row(), x, width_);
    gradient.x += kMomentOfFive[five];
    gradient.y += dy * std::popcount(five);
  }
  return gradient;
}

Steps StepsAlong(Offset direction) {
  if (direction.x == 0 && direction.y == 0) return {};
  const auto x = static_cast<float>(direction.x), y = static_cast<float>(direction.y);
  const float unit = 1.0F / std::sqrt(x * x + y * y);
  const auto rounded = [](float v) { return static_cast<int>(v + (v < 0.0F ? -0.5F : 0.5F)); };
  return {{rounded(x * unit), rounded(y * unit)},
          {rounded(2.0F * x * unit), rounded(2.0F * y * unit)},
          {rounded(3.0F * x * unit), rounded(3.0F * y * unit)}};
}

// Of the object pixels among 3 x 3 the one that differs most: for objects without an interior.
Bgr Scene::StrongestAround(int x, int y) const {
  Bgr strongest = Image(x, y);
  float most = -1.0F;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height_ - 1); ++v) {
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width_ - 1); ++u) {
      if (!detected_.At(u, v)) continue;
      const Bgr difference = Image(u, v) - Mean(u, v);
      if (Dot(difference, difference) <= most) continue;
      most = Dot(difference, difference);
      strongest = Image(u, v);
    }
  }
  return strongest;
}

// As near to the boundary as pixels are wholly object, since shading changes towards an object's rim: a pixel
// that is much weaker than the next one inwards is taken for a mixture.
Bgr Scene::ObjectColor(int x, int y, const Steps& steps, const Bgr& background) const {
  constexpr float kLeastShare = 0.85F;
  const auto is_object = [&](Offset o) {
    return IsPixel(x + o.x, y + o.y) && detected_.At(x + o.x, y + o.y);
  };
  const bool is_inside = detected_.At(x, y);
  const Offset first = is_inside ? steps.one : steps.two, second = is_inside ? steps.two : steps.three;
  if (first == Offset{} || !is_object(first)) return StrongestAround(x, y);
  const Bgr near = Image(x + first.x, y + first.y);
  if (!is_object(second)) return near;
  const Bgr far = Image(x + second.x, y + second.y), whole = far - background;
  return Dot(near - background, whole) >= kLeastShare * Dot(whole, whole) ? near : far;
}

// The share of the background's light that reaches the pixels outwards: shade, or a change of exposure.
float Scene::BackgroundLight(int x, int y, const Steps& steps) const {
  constexpr float kDarkest = 0.3F, kBrightest = 1.5F;
  if (steps.two == Offset{}) return 1.0F;
  float im = 0.0F, mm = 0.0F;
  for (const Offset& step : {steps.two, steps.three}) {
    const int u = x - step.x, v = y - step.y;
    if (!IsPixel(u, v) || detected_.At(u, v)) break;
    const Bgr mean = Mean(u, v);
    im += Dot(Image(u, v), mean), mm += Dot(mean, mean);
  }
  return mm > 0.0F ? std::clamp(im / mm, kDarkest, kBrightest) : 1.0F;
}

std::optional<Coverage> Scene::At(int x, int y) const {
  const Offset gradient = Inwards(x, y);
  const Steps steps = StepsAlong(gradient);
  const float light = BackgroundLight(x, y, steps);
  const Bgr background = light * Mean(x, y);
  const Bgr whole = ObjectColor(x, y, steps, background) - background;
  const float contrast2 = Dot(whole, whole);
  if (contrast2 < least_contrast2_ || !(contrast2 > 0.0F)) return std::nullopt;
  const Bgr per_whole = (1.0F / contrast2) * whole;
  const auto alpha_at = [&](int u, int v) {
    return std::clamp(Dot(Image(u, v) - light * Mean(u, v), per_whole), 0.0F, 1.0F);
  };
  Coverage coverage;
  coverage.alpha = alpha_at(x, y);
  // Across the boundary: along the axis that it is steeper to. Past the picture's edge it goes on as here.
  const bool is_along_x = std::abs(gradient.x) >= std::abs(gradient.y);
  const Offset axis{is_along_x ? 1 : 0, is_along_x ? 0 : 1};
  float sum = coverage.alpha;
  for (const int side : {-1, 1}) {
    const int u = x + side * axis.x, v = y + side * axis.y;
    sum += IsPixel(u, v) ? alpha_at(u, v) : coverage.alpha;
  }
  coverage.inside_px = sum - 1.5F;
  // Both sides fall off (or rise): a line a pixel wide, half of it on either side of the centre.
  const bool is_object = coverage.alpha >= 0.5F;
  if (is_object != (coverage.inside_px > 0.0F)) coverage.inside_px = coverage.alpha - 0.5F;
  return coverage;
}

// The levels of SoftMask: 127.5 at the boundary, 127.5 more or less a pixel away.
std::uint8_t LevelOf(float inside_px) {
  return static_cast<std::uint8_t>(128.0F + 127.5F * std::clamp(inside_px, -1.0F, 0.999F));
}

// Calls visit(x, y, word, bit) for each object pixel of `mask`, row by row from the left.
template <typename Visit>
void ForEachPixel(const core::BitMask& mask, Visit visit) {
  const std::size_t per_row = mask.words_per_row();
  std::size_t word = 0;
  for (int y = 0; y < mask.height_px(); ++y) {
    for (std::size_t i = 0; i < per_row; ++i, ++word) {
      for (std::uint64_t bits = mask.words()[word]; bits != 0; bits &= bits - 1) {
        visit(static_cast<int>(i * 64) + std::countr_zero(bits), y, word, bits & (~bits + 1));
      }
    }
  }
}

}  // namespace

core::SoftMask LocateBoundary(const core::BitMask& detected, const cv::Mat& image_bgr,
                              const cv::Mat& mean_bgr, double least_contrast_levels) {
  constexpr int kRounds = 2;          // each moves the boundary by a pixel at most
  constexpr float kHalfwayPx = 0.5F;  // where coverage can't be had
  core::Require(image_bgr.type() == CV_8UC3 && mean_bgr.type() == CV_32FC3 &&
                    image_bgr.size() == cv::Size(detected.width_px(), detected.height_px()) &&
                    mean_bgr.size() == image_bgr.size(),
                "a boundary is located in an 8-bit BGR picture of its mask's size");
  const Scene scene(detected, image_bgr, mean_bgr, static_cast<float>(least_contrast_levels));
  const auto width = static_cast<std::size_t>(detected.width_px());
  core::SoftMask located{detected, {}};
  core::BitMask known(detected.width_px(), detected.height_px());
  // Not cleared, since only those of known pixels are read.
  const auto levels =
      std::make_unique_for_overwrite<std::uint8_t[]>(width * static_cast<std::size_t>(detected.height_px()));
  const auto measure = [&](int x, int y, std::size_t word, std::uint64_t bit, bool may_move) {
    if ((known.words()[word] & bit) != 0) return;
    known.words()[word] |= bit;
    const bool was_object = (located.mask.words()[word] & bit) != 0;
    const auto coverage = scene.At(x, y);
    levels[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] =
        LevelOf(coverage ? coverage->inside_px : (was_object ? kHalfwayPx : -kHalfwayPx));
    if (coverage && may_move && was_object != (coverage->alpha >= 0.5F)) located.mask.words()[word] ^= bit;
  };
  // First what was detected along the boundary: thresholds err outwards. Then both sides of where that leads.
  core::BitMask boundary = core::BoundaryPixels(detected);
  for (std::size_t i = 0; i < boundary.words().size(); ++i) boundary.words()[i] &= detected.words()[i];
  for (int round = 0; round < kRounds; ++round) {
    ForEachPixel(boundary,
                 [&](int x, int y, std::size_t word, std::uint64_t bit) { measure(x, y, word, bit, true); });
    boundary = core::BoundaryPixels(located.mask);
  }
  located.levels.reserve(boundary.CountObjectPixels());
  ForEachPixel(boundary, [&](int x, int y, std::size_t word, std::uint64_t bit) {
    measure(x, y, word, bit, false);
    const std::uint8_t level = levels[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
    const bool is_object = (located.mask.words()[word] & bit) != 0;
    located.levels.push_back(is_object ? std::max<std::uint8_t>(level, 128)
                                       : std::min<std::uint8_t>(level, 127));
  });
  return located;
}

}  // namespace elbowroom::recon
