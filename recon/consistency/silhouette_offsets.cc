#include "recon/consistency/silhouette_offsets.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/error.h"
#include "recon/consistency/angle_track.h"
#include "recon/consistency/tangencies.h"
#include "recon/consistency/tangency_response.h"

namespace elbowroom::recon {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// One pair and side, in both cameras.
struct BothTracks {
  std::size_t pair = 0;
  TangentSide side = TangentSide::kLowest;
  core::CameraIndex a = 0, b = 0;
  AngleTrack in_a, in_b;
};

AngleTrack TrackOf(std::span<const StampedTangents> footage, core::CameraIndex other, std::size_t side) {
  std::vector<AngleSample> samples;
  for (const StampedTangents& stamped : footage) {
    const auto* const tangent = std::get_if<Tangent>(&stamped.tangents.of_other[other][side]);
    if (tangent == nullptr || (!stamped.tangents.is_whole && !tangent->is_seen_by_other)) continue;
    samples.push_back({stamped.stamp_s, *tangent});
  }
  return AngleTrack(std::move(samples));
}

// A comparison at a stamp of a, in px, with its derivative by the offset of a less that of b.
struct Residual {
  double stamp_s = 0.0, px = 0.0, px_per_s = 0.0, sigma_px = 1.0;
  const Tangent* in_a = nullptr;
  const Tangent* in_b = nullptr;
};

std::vector<Residual> ResidualsAt(const BothTracks& tracks, double difference_s) {
  std::vector<Residual> residuals;
  residuals.reserve(tracks.in_a.samples().size());
  for (const AngleSample& sample : tracks.in_a.samples()) {
    const std::optional<AngleAtTime> b = tracks.in_b.At(sample.stamp_s + difference_s);
    if (!b) continue;
    const Tangent& a = sample.tangent;
    const double rad_per_px = std::hypot(1.0 / a.px_per_rad, 1.0 / b->nearest->px_per_rad);
    residuals.push_back({sample.stamp_s, (a.angle_rad - b->angle_rad) / rad_per_px,
                         -b->rate_rad_s / rad_per_px,
                         std::hypot(a.sigma_rad(), b->nearest->sigma_rad()) / rad_per_px, &a, b->nearest});
  }
  return residuals;
}

double MedianPx(const std::vector<Residual>& residuals) {
  std::vector<double> px;
  for (const Residual& residual : residuals) px.push_back(residual.px);
  const auto middle = px.begin() + static_cast<std::ptrdiff_t>(px.size() / 2);
  std::nth_element(px.begin(), middle, px.end());
  return *middle;
}

// What a difference of two cameras' offsets costs: the mean of the residuals' squares about their median,
// those beyond 5 px counted as 5 px. Infinite where too little can be compared.
double CoarseCost(const BothTracks& tracks, double difference_s) {
  constexpr double kMostPx = 5.0;
  constexpr std::size_t kFewest = 30;
  const std::vector<Residual> residuals = ResidualsAt(tracks, difference_s);
  if (residuals.size() < kFewest) return std::numeric_limits<double>::infinity();
  const double median_px = MedianPx(residuals);
  double sum = 0.0;
  for (const Residual& residual : residuals)
    sum += std::pow(std::min(std::abs(residual.px - median_px), kMostPx), 2);
  return sum / static_cast<double>(residuals.size());
}

// The difference with the least cost by the grid, and the cost's second difference there: how sure it is.
struct CoarseDifference {
  core::CameraIndex a = 0, b = 0;
  double difference_s = 0.0, weight = 0.0;
};

std::optional<CoarseDifference> SearchCoarsely(const BothTracks& tracks,
                                               const SilhouetteOffsetOptions& options) {
  const auto steps = static_cast<int>(std::ceil(options.search_s / options.search_step_s));
  std::vector<double> costs;
  for (int i = -steps; i <= steps; ++i) costs.push_back(CoarseCost(tracks, i * options.search_step_s));
  const auto least = std::ranges::min_element(costs);
  if (!std::isfinite(*least)) return std::nullopt;
  const auto at = static_cast<int>(least - costs.begin());
  const double most = *std::ranges::max_element(costs);
  const double weight = std::isfinite(most) ? most - *least : 0.0;
  return CoarseDifference{tracks.a, tracks.b, (at - steps) * options.search_step_s, weight + 1e-12};
}

// Offsets of all cameras that explain the coarse differences best; camera 0 has 0. Nothing: some camera isn't
// compared with the others.
std::optional<VectorXd> OffsetsFrom(const std::vector<CoarseDifference>& differences, std::size_t cameras) {
  VectorXd offsets = VectorXd::Zero(static_cast<Eigen::Index>(cameras));
  std::vector<bool> is_known(cameras, false);
  is_known[0] = true;
  // A tree of the surest differences, from camera 0 on.
  for (std::size_t known = 1; known < cameras; ++known) {
    const CoarseDifference* best = nullptr;
    for (const CoarseDifference& d : differences)
      if (is_known[d.a] != is_known[d.b] && (best == nullptr || d.weight > best->weight)) best = &d;
    if (best == nullptr) return std::nullopt;
    const auto a = static_cast<Eigen::Index>(best->a), b = static_cast<Eigen::Index>(best->b);
    if (is_known[best->a]) {
      offsets[b] = offsets[a] - best->difference_s;
    } else {
      offsets[a] = offsets[b] + best->difference_s;
    }
    is_known[best->a] = is_known[best->b] = true;
  }
  return offsets;
}

// Normal equations of one block of time.
struct BlockEquations {
  MatrixXd information;
  VectorXd score;
};

// The fit's unknowns: the offsets of cameras 1, 2, ..., a steady residual for each track, and what each
// camera's pose is off.
class OffsetFit {
 public:
  OffsetFit(const EpipolarPairs& pairs, const std::vector<BothTracks>& tracks,
            const SilhouetteOffsetOptions& options, const VectorXd& offsets_s)
      : pairs_(pairs),
        tracks_(tracks),
        options_(options),
        offsets_(offsets_s.size() - 1),
        unknowns_(
            VectorXd::Zero(offsets_ + static_cast<Eigen::Index>(tracks.size()) + 6 * offsets_s.size())) {
    unknowns_.head(offsets_) = offsets_s.tail(offsets_);
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      const std::vector<Residual> residuals = ResidualsAt(tracks[i], Difference(tracks[i]));
      if (!residuals.empty()) unknowns_[Steady(i)] = MedianPx(residuals);
    }
  }

  // Gauss-Newton with Cauchy weights.
  void Run() {
    constexpr int kMostSteps = 30;
    constexpr double kConvergedS = 1e-7;
    for (int step = 0; step < kMostSteps; ++step) {
      Assemble();
      const VectorXd change = total_.information.ldlt().solve(total_.score);
      unknowns_ += change;
      if (change.head(offsets_).cwiseAbs().maxCoeff() < kConvergedS) break;
    }
    Assemble();
  }

  [[nodiscard]] VectorXd offsets_s() const { return unknowns_.head(offsets_); }
  [[nodiscard]] std::size_t residuals() const { return residuals_; }
  [[nodiscard]] std::size_t blocks() const { return blocks_.size(); }
  [[nodiscard]] double motion_px_s() const { return std::sqrt(motion_px2_s2_ / std::max(weights_, 1e-300)); }
  [[nodiscard]] double rms_px() const { return std::sqrt(squares_px2_ / std::max(weights_, 1e-300)); }

  // The jackknife: each block is left out in turn, and one step of the fit taken. What that changes has the
  // residuals' own scatter in it, whatever correlates them within a block. If blocks twice or four times as
  // long say more, all is enlarged to that; few long blocks wouldn't tell how the offsets' errors hang
  // together. So few blocks don't know their own scatter well: an error in units of it has Student's
  // distribution, whose variance is that of freedom / (freedom - 2).
  [[nodiscard]] MatrixXd Covariance() const {
    const MatrixXd covariance = Jackknife(1);
    double factor = 1.0;
    auto freedom = static_cast<double>(blocks_.size()) - 1.0;
    for (const long at_once : {2L, 4L}) {
      if (static_cast<long>(blocks_.size()) < at_once * options_.least_blocks) break;
      factor = std::max(factor, Jackknife(at_once).trace() / covariance.trace());
      freedom = static_cast<double>(blocks_.size()) / static_cast<double>(at_once) - 1.0;
    }
    return factor * freedom / (freedom - 2.0) * covariance;
  }

 private:
  [[nodiscard]] double Offset(core::CameraIndex camera) const {
    return camera == 0 ? 0.0 : unknowns_[static_cast<Eigen::Index>(camera) - 1];
  }
  [[nodiscard]] MatrixXd Jackknife(long at_once) const {
    std::map<long, BlockEquations> merged;
    for (const auto& [number, block] : blocks_) {
      const auto [at, is_new] = merged.try_emplace(number / at_once, block);
      if (is_new) continue;
      at->second.information += block.information;
      at->second.score += block.score;
    }
    const auto count = static_cast<double>(merged.size());
    VectorXd mean = VectorXd::Zero(offsets_);
    std::vector<VectorXd> changes;
    for (const auto& [number, block] : merged) {
      const VectorXd change =
          (total_.information - block.information).ldlt().solve(total_.score - block.score);
      changes.emplace_back(change.head(offsets_));
      mean += changes.back() / count;
    }
    MatrixXd covariance = MatrixXd::Zero(offsets_, offsets_);
    for (const VectorXd& change : changes) covariance += (change - mean) * (change - mean).transpose();
    return covariance * ((count - 1.0) / count);
  }
  [[nodiscard]] double Difference(const BothTracks& tracks) const {
    return Offset(tracks.a) - Offset(tracks.b);
  }
  [[nodiscard]] Eigen::Index Pose(core::CameraIndex camera) const {
    return offsets_ + static_cast<Eigen::Index>(tracks_.size() + 6 * camera);
  }
  [[nodiscard]] Eigen::Index Steady(std::size_t track) const {
    return offsets_ + static_cast<Eigen::Index>(track);
  }

  void Assemble() {
    const Eigen::Index size = unknowns_.size();
    blocks_.clear();
    residuals_ = 0, squares_px2_ = 0.0, weights_ = 0.0, motion_px2_s2_ = 0.0;
    for (std::size_t i = 0; i < tracks_.size(); ++i) AddTrack(i);
    total_ = {MatrixXd::Zero(size, size), VectorXd::Zero(size)};
    const VectorXd prior = PriorInformation();
    total_.information.diagonal() = prior;
    total_.score = -prior.cwiseProduct(unknowns_);
    for (const auto& [number, block] : blocks_) {
      total_.information += block.information;
      total_.score += block.score;
    }
  }

  // Of offsets nothing is known; all else is 0 within its sigma.
  [[nodiscard]] VectorXd PriorInformation() const {
    VectorXd prior = VectorXd::Zero(unknowns_.size());
    prior.segment(offsets_, static_cast<Eigen::Index>(tracks_.size()))
        .setConstant(std::pow(options_.steady_sigma_px, -2));
    for (core::CameraIndex camera = 0; camera < pairs_.camera_count(); ++camera) {
      const UndistortedPlane& plane = pairs_.plane(camera);
      const double distance_mm = (pairs_.workspace_mm().center() - plane.camera().center_in_world()).norm();
      const double sigma_rad = options_.calibration_sigma_px / plane.focal_px();
      prior.segment<3>(Pose(camera)).setConstant(std::pow(sigma_rad, -2));
      prior.segment<3>(Pose(camera) + 3).setConstant(std::pow(sigma_rad * distance_mm, -2));
    }
    return prior;
  }

  void AddTrack(std::size_t track) {
    constexpr double kCauchySigmas = 3.0;
    const BothTracks& tracks = tracks_[track];
    for (const Residual& residual : ResidualsAt(tracks, Difference(tracks))) {
      const Row row = RowOf(track, residual);
      double px = residual.px;
      for (std::size_t i = 2; i < row.at.size(); ++i) px += row.value[i] * unknowns_[row.at[i]];
      const double in_cauchy = px / (kCauchySigmas * residual.sigma_px);
      const double weight = 1.0 / (residual.sigma_px * residual.sigma_px * (1.0 + in_cauchy * in_cauchy));
      Add(BlockAt(residual.stamp_s), row, px, weight);
      squares_px2_ += weight * px * px, weights_ += weight;
      motion_px2_s2_ += weight * residual.px_per_s * residual.px_per_s;
      ++residuals_;
    }
  }

  BlockEquations& BlockAt(double stamp_s) {
    const auto number = static_cast<long>(std::floor(stamp_s / options_.block_s));
    const auto [at, is_new] = blocks_.try_emplace(number);
    if (is_new) {
      at->second = {MatrixXd::Zero(unknowns_.size(), unknowns_.size()), VectorXd::Zero(unknowns_.size())};
    }
    return at->second;
  }

  // What is left of a residual, px + px_per_s (offset a - offset b) - steady - poses, by the unknowns. The
  // first two places are the offsets of a and b; that of camera 0 isn't unknown, and has the place -1.
  struct Row {
    std::array<Eigen::Index, 15> at;
    std::array<double, 15> value;
  };

  [[nodiscard]] Row RowOf(std::size_t track, const Residual& residual) const {
    const BothTracks& tracks = tracks_[track];
    Tangency tangency;
    tangency.pair = tracks.pair, tangency.side = tracks.side;
    tangency.in_a = *residual.in_a, tangency.in_b = *residual.in_b;
    const TangencyResponse response = ResponseOf(pairs_, tangency);
    Row row;
    row.at[0] = static_cast<Eigen::Index>(tracks.a) - 1, row.value[0] = residual.px_per_s;
    row.at[1] = static_cast<Eigen::Index>(tracks.b) - 1, row.value[1] = -residual.px_per_s;
    row.at[2] = Steady(track), row.value[2] = -1.0;
    for (std::size_t i = 0; i < 6; ++i) {
      const auto entry = static_cast<Eigen::Index>(i);
      row.at[3 + i] = Pose(tracks.a) + entry, row.value[3 + i] = -response.by_pose_a[entry];
      row.at[9 + i] = Pose(tracks.b) + entry, row.value[9 + i] = -response.by_pose_b[entry];
    }
    return row;
  }

  static void Add(BlockEquations& block, const Row& row, double px, double weight) {
    for (std::size_t i = 0; i < row.at.size(); ++i) {
      if (row.at[i] < 0) continue;
      block.score[row.at[i]] -= weight * row.value[i] * px;
      for (std::size_t j = 0; j < row.at.size(); ++j)
        if (row.at[j] >= 0) block.information(row.at[i], row.at[j]) += weight * row.value[i] * row.value[j];
    }
  }

  const EpipolarPairs& pairs_;
  const std::vector<BothTracks>& tracks_;
  const SilhouetteOffsetOptions& options_;
  const Eigen::Index offsets_;
  VectorXd unknowns_;
  std::map<long, BlockEquations> blocks_;
  BlockEquations total_;
  std::size_t residuals_ = 0;
  double squares_px2_ = 0.0, weights_ = 0.0, motion_px2_s2_ = 0.0;
};

}  // namespace

void SilhouetteOffsetOptions::Validate() const {
  core::Require(search_s > 0.0 && search_step_s > 0.0, "search_s and search_step_s are positive");
  core::Require(steady_sigma_px > 0.0 && calibration_sigma_px > 0.0,
                "steady_sigma_px and calibration_sigma_px are positive");
  core::Require(block_s > 0.0, "block_s is positive");
  core::Require(least_motion_px_s > 0.0, "least_motion_px_s is positive");
  core::Require(least_blocks >= 5, "least_blocks is 5 or more");
}

std::optional<SilhouetteOffsets> FindSilhouetteOffsets(const EpipolarPairs& pairs,
                                                       std::span<const std::vector<StampedTangents>> footage,
                                                       const SilhouetteOffsetOptions& options) {
  core::Require(footage.size() == pairs.camera_count(), "there is one footage a camera");
  options.Validate();
  std::vector<BothTracks> tracks;
  std::vector<CoarseDifference> differences;
  for (std::size_t i = 0; i < pairs.pairs().size(); ++i)
    for (std::size_t side = 0; side < kTangentSides; ++side) {
      const EpipolarPair& pair = pairs.pairs()[i];
      BothTracks both{i,      static_cast<TangentSide>(side),         pair.a,
                      pair.b, TrackOf(footage[pair.a], pair.b, side), TrackOf(footage[pair.b], pair.a, side)};
      const auto coarse = SearchCoarsely(both, options);
      if (!coarse) continue;
      differences.push_back(*coarse);
      tracks.push_back(std::move(both));
    }
  const std::optional<VectorXd> start_s = OffsetsFrom(differences, footage.size());
  if (!start_s) return std::nullopt;
  OffsetFit fit(pairs, tracks, options, *start_s);
  fit.Run();
  if (fit.blocks() < static_cast<std::size_t>(options.least_blocks)) return std::nullopt;
  if (fit.motion_px_s() < options.least_motion_px_s) return std::nullopt;

  SilhouetteOffsets found;
  found.covariance_s2 = fit.Covariance();
  found.residuals = fit.residuals();
  found.rms_px = fit.rms_px();
  found.offset_s = {0.0}, found.sigma_s = {0.0};
  const VectorXd offsets_s = fit.offsets_s();
  for (Eigen::Index i = 0; i < offsets_s.size(); ++i) {
    found.offset_s.push_back(offsets_s[i]);
    found.sigma_s.push_back(std::sqrt(found.covariance_s2(i, i)));
    if (!(found.sigma_s.back() < options.search_s / 4.0)) return std::nullopt;
  }
  return found;
}

}  // namespace elbowroom::recon
