#include "recon/consistency/blink_offsets.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "core/error.h"
#include "recon/consistency/blink_likelihood.h"
#include "recon/consistency/blink_matching.h"

namespace elbowroom::recon {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeastExposureS = 5e-5;

// The unknowns: the offsets of cameras 1, 2, ..., then the exposures that aren't known.
class BlinkPosterior {
 public:
  BlinkPosterior(std::vector<SharedEdge> edges, BlinkNoise noise, BlinkTiming start,
                 std::vector<bool> is_exposure_known, double longest_exposure_s)
      : edges_(std::move(edges)),
        noise_(std::move(noise)),
        start_(std::move(start)),
        longest_exposure_s_(longest_exposure_s) {
    for (std::size_t i = 0; i < is_exposure_known.size(); ++i)
      if (!is_exposure_known[i]) unknown_exposures_.push_back(static_cast<Eigen::Index>(i));
  }

  [[nodiscard]] Eigen::Index offsets() const { return start_.offset_s.size() - 1; }
  [[nodiscard]] VectorXd Start() const {
    VectorXd at(offsets() + static_cast<Eigen::Index>(unknown_exposures_.size()));
    at.head(offsets()) = start_.offset_s.tail(offsets());
    for (std::size_t i = 0; i < unknown_exposures_.size(); ++i)
      at[offsets() + static_cast<Eigen::Index>(i)] = start_.exposure_s[unknown_exposures_[i]];
    return at;
  }
  [[nodiscard]] BlinkTiming TimingAt(const VectorXd& at) const {
    BlinkTiming timing = start_;
    timing.offset_s.tail(offsets()) = at.head(offsets());
    for (std::size_t i = 0; i < unknown_exposures_.size(); ++i)
      timing.exposure_s[unknown_exposures_[i]] = at[offsets() + static_cast<Eigen::Index>(i)];
    return timing;
  }
  // The prior is even, for exposures between their limits.
  [[nodiscard]] double LogAt(const VectorXd& at, double blur_s) const {
    for (Eigen::Index i = offsets(); i < at.size(); ++i)
      if (at[i] < kLeastExposureS || at[i] > longest_exposure_s_) return -1e300;
    return LogLikelihood(edges_, noise_, TimingAt(at), blur_s);
  }

 private:
  std::vector<SharedEdge> edges_;
  BlinkNoise noise_;
  BlinkTiming start_;
  double longest_exposure_s_;
  std::vector<Eigen::Index> unknown_exposures_;
};

// Steps along one unknown at a time, with less and less blur.
VectorXd Climb(const BlinkPosterior& posterior) {
  VectorXd at = posterior.Start();
  for (const double blur_s : {4e-3, 1.5e-3, 5e-4, 1.5e-4, 0.0}) {
    double best = posterior.LogAt(at, blur_s);
    constexpr double kLeastStepS = 1e-5;
    constexpr int kMostRounds = 60;
    double step_s = std::max(2.0 * blur_s, 2e-4);
    for (int round = 0; round < kMostRounds && step_s >= kLeastStepS; ++round) {
      bool is_better = false;
      for (Eigen::Index i = 0; i < at.size(); ++i)
        for (const double way_s : {step_s, -step_s}) {
          VectorXd next = at;
          next[i] += way_s;
          const double value = posterior.LogAt(next, blur_s);
          if (value <= best) continue;
          best = value, at = next, is_better = true;
        }
      if (!is_better) step_s *= 0.5;
    }
  }
  return at;
}

struct Draws {
  VectorXd mean;
  MatrixXd covariance;
};

// A Metropolis walk through the posterior.
class MetropolisWalk {
 public:
  MetropolisWalk(const BlinkPosterior& posterior, VectorXd start, std::uint64_t seed)
      : posterior_(posterior), at_(std::move(start)), value_(posterior.LogAt(at_, 0.0)), random_(seed) {}

  // Draws with steps of this covariance, times a factor that is adapted, if wanted, until about a quarter of
  // the steps are taken (Roberts et al. 1997).
  Draws Run(int draws, const MatrixXd& step_covariance, bool is_adapting) {
    constexpr int kAdaptEvery = 50;
    MatrixXd covariance = step_covariance;
    covariance.diagonal().array() += 1e-14;  // s^2: what hardly moves still does
    const MatrixXd step = covariance.llt().matrixL();
    const VectorXd from = at_;
    VectorXd sum = VectorXd::Zero(from.size());
    MatrixXd squares = MatrixXd::Zero(from.size(), from.size());
    int taken = 0;
    for (int draw = 1; draw <= draws; ++draw) {
      if (Step(step)) ++taken;
      const VectorXd way = at_ - from;
      sum += way, squares += way * way.transpose();
      if (!is_adapting || draw % kAdaptEvery != 0) continue;
      scale_ *= std::exp(2.0 * (static_cast<double>(taken) / kAdaptEvery - 0.25));
      taken = 0;
    }
    const VectorXd mean = sum / draws;
    return {from + mean, squares / draws - mean * mean.transpose()};
  }

 private:
  bool Step(const MatrixXd& step) {
    VectorXd noise(at_.size());
    for (double& value : noise) value = normal_(random_);
    VectorXd next = at_ + scale_ * (step * noise);
    const double next_value = posterior_.LogAt(next, 0.0);
    if (std::log(uniform_(random_)) >= next_value - value_) return false;
    at_ = std::move(next), value_ = next_value;
    return true;
  }

  const BlinkPosterior& posterior_;
  VectorXd at_;
  double value_, scale_ = 1.0;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

// Haario et al. 2001: the steps' covariance is that of what was drawn before. The first half doesn't count.
Draws DrawPosterior(const BlinkPosterior& posterior, const VectorXd& start, int draws, std::uint64_t seed) {
  constexpr double kFirstStepS = 3e-5;
  MetropolisWalk walk(posterior, start, seed);
  const MatrixXd first = kFirstStepS * kFirstStepS * MatrixXd::Identity(start.size(), start.size());
  // Along a ridge, each round makes the steps longer.
  constexpr int kRounds = 8;
  MatrixXd covariance = first;
  for (int round = 0; round < kRounds; ++round)
    covariance = walk.Run(draws / (2 * kRounds), covariance, true).covariance;
  return walk.Run(draws / 2, covariance, false);
}

// Of the light's edges, so many fall into an exposure that a period has of it.
double ExposureByCount(const BlinkEdges& edges) {
  const auto partly =
      std::ranges::count_if(edges.edges, [](const auto& edge) { return edge.share.has_value(); });
  const double share =
      static_cast<double>(partly) / std::max<double>(1.0, static_cast<double>(edges.edges.size()));
  return std::clamp(share * edges.period_s, 5.0 * kLeastExposureS, 0.9 * edges.period_s);
}

// What the curves say by themselves.
struct ReadCurves {
  std::vector<BlinkEdges> cameras;
  std::vector<double> coarse_s;
  BlinkNoise noise;
  BlinkTiming start;
  std::vector<bool> is_exposure_known;
  double longest_exposure_s = 0.0;
};

std::optional<ReadCurves> ReadAll(std::span<const BlinkCurve> curves, const BlinkOffsetOptions& options) {
  const auto count = static_cast<Eigen::Index>(curves.size());
  ReadCurves read;
  read.noise.stamp_jitter_s = options.stamp_jitter_s, read.noise.wrong_share = options.wrong_share;
  read.start = {VectorXd::Zero(count), VectorXd::Zero(count)};
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (!curves[i].is_linear) return std::nullopt;
    std::optional<BlinkEdges> edges = FindBlinkEdges(curves[i], 1.8 * options.shortest_blink_s);
    if (!edges) return std::nullopt;
    const std::optional<double> offset_s =
        i == 0 ? 0.0 : CoarseOffset(curves[0], read.cameras[0], curves[i], *edges, options.search_s);
    if (!offset_s) return std::nullopt;
    read.coarse_s.push_back(*offset_s);
    read.noise.share_sigma.push_back(edges->share_sigma);
    const bool is_known = i < options.exposure_s.size() && options.exposure_s[i] > 0.0;
    read.is_exposure_known.push_back(is_known);
    const auto at = static_cast<Eigen::Index>(i);
    read.start.offset_s[at] = *offset_s;
    read.start.exposure_s[at] = is_known ? options.exposure_s[i] : ExposureByCount(*edges);
    read.longest_exposure_s = std::max(read.longest_exposure_s, edges->period_s);
    read.cameras.push_back(std::move(*edges));
  }
  return read;
}

}  // namespace

void BlinkOffsetOptions::Validate() const {
  core::Require(std::ranges::none_of(exposure_s, [](double s) { return s < 0.0; }),
                "an exposure isn't negative");
  core::Require(search_s > 0.0, "search_s is positive");
  core::Require(shortest_blink_s > 0.0, "shortest_blink_s is positive");
  core::Require(stamp_jitter_s > 0.0, "stamp_jitter_s is positive");
  core::Require(wrong_share > 0.0 && wrong_share < 1.0, "wrong_share is between 0 and 1");
  core::Require(draws >= 1000, "draws is 1000 or more");
}

std::optional<BlinkOffsets> FindBlinkOffsets(std::span<const BlinkCurve> curves,
                                             const BlinkOffsetOptions& options) {
  constexpr std::size_t kFewestEdges = 10;
  core::Require(curves.size() >= 2, "offsets are between two cameras or more");
  options.Validate();
  std::optional<ReadCurves> read = ReadAll(curves, options);
  if (!read) return std::nullopt;
  std::vector<SharedEdge> shared = MatchEdges(read->cameras, read->coarse_s, options.shortest_blink_s);
  BlinkOffsets found;
  found.edges = shared.size();
  std::vector<std::size_t> seen(curves.size(), 0);
  for (const SharedEdge& edge : shared)
    for (const SharedEdge::Seen& one : edge.seen) {
      ++seen[one.camera];
      if (one.edge.share) ++found.shares;
    }
  if (*std::ranges::min_element(seen) < kFewestEdges) return std::nullopt;

  const BlinkPosterior posterior(std::move(shared), std::move(read->noise), std::move(read->start),
                                 std::move(read->is_exposure_known), read->longest_exposure_s);
  const Draws drawn = DrawPosterior(posterior, Climb(posterior), options.draws, options.seed);
  const Eigen::Index offsets = posterior.offsets();
  const BlinkTiming timing = posterior.TimingAt(drawn.mean);
  found.covariance_s2 = drawn.covariance.topLeftCorner(offsets, offsets);
  found.offset_s.assign(timing.offset_s.begin(), timing.offset_s.end());
  found.exposure_s.assign(timing.exposure_s.begin(), timing.exposure_s.end());
  found.sigma_s = {0.0};
  for (Eigen::Index i = 0; i < offsets; ++i) found.sigma_s.push_back(std::sqrt(found.covariance_s2(i, i)));
  return found;
}

}  // namespace elbowroom::recon
