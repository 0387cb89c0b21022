#include "recon/consistency/blink_edges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr std::size_t kFewestOfALevel = 10;
constexpr double kLeastSigma = 0.002;  // of a share: levels are whole numbers
constexpr double kMostSigma = 0.1;     // noisier curves tell dark from lit, but no shares
constexpr double kLostPeriods = 1.6;

double MiddleOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The median of the values, and their scatter by the median distance from it.
std::pair<double, double> LevelOf(const std::vector<double>& values) {
  const double level = MiddleOf(values);
  std::vector<double> distances;
  for (const double value : values) distances.push_back(std::abs(value - level));
  return {level, 1.4826 * MiddleOf(distances)};
}

struct BlinkShares {
  std::vector<double> share;
  double sigma = 0.0;
};

// Nothing: the curve has no two levels.
std::optional<BlinkShares> SharesOf(const BlinkCurve& curve) {
  BlinkShares shares;
  const auto [least, most] = std::ranges::minmax(curve.brightness);
  std::vector<double> dark, lit;
  for (const double value : curve.brightness) (value < 0.5 * (least + most) ? dark : lit).push_back(value);
  if (dark.size() < kFewestOfALevel || lit.size() < kFewestOfALevel) return std::nullopt;
  const auto [dark_level, dark_sigma] = LevelOf(dark);
  const auto [lit_level, lit_sigma] = LevelOf(lit);
  if (lit_level <= dark_level) return std::nullopt;
  shares.sigma = std::max(kLeastSigma, std::max(dark_sigma, lit_sigma) / (lit_level - dark_level));
  if (shares.sigma > kMostSigma) return std::nullopt;
  for (const double value : curve.brightness)
    shares.share.push_back((value - dark_level) / (lit_level - dark_level));
  return shares;
}

}  // namespace

std::optional<BlinkEdges> FindBlinkEdges(const BlinkCurve& curve, double longest_gap_s) {
  core::Require(curve.stamp_s.size() == curve.brightness.size(), "there is one stamp a brightness");
  if (curve.stamp_s.size() < 2 * kFewestOfALevel) return std::nullopt;
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < curve.stamp_s.size(); ++i) {
    steps_s.push_back(curve.stamp_s[i] - curve.stamp_s[i - 1]);
    core::Require(steps_s.back() > 0.0, "a curve's stamps ascend");
  }
  BlinkEdges found;
  found.period_s = MiddleOf(steps_s);
  std::optional<BlinkShares> shares = SharesOf(curve);
  if (!shares) return std::nullopt;
  found.share = std::move(shares->share), found.share_sigma = shares->sigma;

  enum class Shows { kDark, kLit, kPartly };
  const auto shows = [&](std::size_t i) {
    const double slack = kUnnoticedSigmas * found.share_sigma;
    if (found.share[i] < slack) return Shows::kDark;
    return found.share[i] > 1.0 - slack ? Shows::kLit : Shows::kPartly;
  };
  const std::vector<double>& t = curve.stamp_s;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const Shows here = shows(i), next = shows(i + 1);
    if (here == Shows::kPartly) continue;
    if (next != Shows::kPartly) {
      if (next == here || t[i + 1] - t[i] > longest_gap_s) continue;
      found.edges.push_back({next == Shows::kLit, std::nullopt, 0.5 * (t[i] + t[i + 1]), t[i], t[i + 1]});
      continue;
    }
    if (i + 2 >= t.size() || t[i + 2] - t[i] > 2.0 * kLostPeriods * found.period_s) continue;
    const Shows last = shows(i + 2);
    if (last == Shows::kPartly || last == here) continue;
    found.edges.push_back({last == Shows::kLit, found.share[i + 1], t[i + 1], t[i], t[i + 2]});
  }
  return found;
}

}  // namespace elbowroom::recon
