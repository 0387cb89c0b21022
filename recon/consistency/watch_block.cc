#include "recon/consistency/watch_block.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "recon/consistency/tangency_response.h"

namespace elbowroom::recon {
namespace {

// One pair and side through a block.
struct Track {
  std::vector<double> time_s;
  std::vector<const Tangency*> tangency;
};

struct AngleRates {
  double in_a_rad_s = 0.0, in_b_rad_s = 0.0;
};

// From the frames beside it.
std::optional<AngleRates> RatesAt(const Track& track, std::size_t i) {
  constexpr double kLongestGapS = 0.25;
  const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, track.time_s.size() - 1);
  const double gap_s = track.time_s[after] - track.time_s[before];
  if (before == after || gap_s <= 0.0 || gap_s > kLongestGapS) return std::nullopt;
  const Tangency &from = *track.tangency[before], &to = *track.tangency[after];
  return AngleRates{(to.in_a.angle_rad - from.in_a.angle_rad) / gap_s,
                    (to.in_b.angle_rad - from.in_b.angle_rad) / gap_s};
}

double MedianResidualPx(const Track& track) {
  std::vector<double> residuals;
  residuals.reserve(track.tangency.size());
  for (const Tangency* tangency : track.tangency) residuals.push_back(tangency->residual_px);
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return *middle;
}

// A residual as a row over the state and the block's own unknowns: few entries aren't 0.
struct SparseRow {
  static constexpr int kEntries = 18;
  std::array<Eigen::Index, kEntries> at;
  Eigen::Matrix<double, kEntries, 1> value;
};

SparseRow RowOf(const EpipolarPairs& pairs, const WatchLayout& layout, const Tangency& tangency,
                const AngleRates& rates) {
  const EpipolarPair& pair = pairs.pairs()[tangency.pair];
  const TangencyResponse response = ResponseOf(pairs, tangency);
  const auto cameras = static_cast<Eigen::Index>(layout.cameras());
  const auto a = static_cast<Eigen::Index>(pair.a), b = static_cast<Eigen::Index>(pair.b);
  SparseRow row;
  for (Eigen::Index i = 0; i < 6; ++i) {
    row.at[static_cast<std::size_t>(i)] = layout.Pose(pair.a) + i;
    row.at[static_cast<std::size_t>(6 + i)] = layout.Pose(pair.b) + i;
  }
  row.at[12] = layout.Steady(tangency.pair, tangency.side);
  row.at[13] = layout.size() + a, row.at[14] = layout.size() + b;
  row.at[15] = layout.size() + cameras + a, row.at[16] = layout.size() + cameras + b;
  row.at[17] = row.at[12] - layout.steady_begin() + layout.size() + 2 * cameras;
  row.value << response.by_pose_a, response.by_pose_b, 1.0, response.by_dilation_a, response.by_dilation_b,
      response.by_angle_a * rates.in_a_rad_s, response.by_angle_b * rates.in_b_rad_s, 1.0;
  return row;
}

struct FullEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd score;
  int residuals = 0;
};

void AddTrack(const EpipolarPairs& pairs, const WatchLayout& layout, const Track& track,
              const BlockUnknowns& unknowns, FullEquations* equations) {
  constexpr double kSlackSigmas = 5.0, kSlackPx = 1.0, kSlackSkews = 3.0;
  const double median_px = MedianResidualPx(track);
  for (std::size_t i = 0; i < track.tangency.size(); ++i) {
    const std::optional<AngleRates> rates = RatesAt(track, i);
    if (!rates) continue;
    const Tangency& tangency = *track.tangency[i];
    const SparseRow row = RowOf(pairs, layout, tangency, *rates);
    const double px_per_s = std::hypot(row.value[15], row.value[16]);
    const double slack_px =
        std::max({kSlackSigmas * tangency.sigma_px, kSlackPx, kSlackSkews * unknowns.skew_s * px_per_s});
    if (std::abs(tangency.residual_px - median_px) > slack_px) continue;
    const double jitter_px = unknowns.stamp_jitter_s * px_per_s;
    const double weight = 1.0 / (tangency.sigma_px * tangency.sigma_px + jitter_px * jitter_px);
    for (std::size_t j = 0; j < row.at.size(); ++j) {
      const double weighted = weight * row.value[static_cast<Eigen::Index>(j)];
      equations->score[row.at[j]] += weighted * tangency.residual_px;
      for (std::size_t k = 0; k < row.at.size(); ++k)
        equations->information(row.at[j], row.at[k]) += weighted * row.value[static_cast<Eigen::Index>(k)];
    }
    ++equations->residuals;
  }
}

}  // namespace

Evidence Evidence::None(const WatchLayout& layout) {
  return {Eigen::MatrixXd::Zero(layout.size(), layout.size()), Eigen::VectorXd::Zero(layout.size()), 0};
}

Evidence& Evidence::operator+=(const Evidence& other) {
  information += other.information;
  score += other.score;
  residuals += other.residuals;
  return *this;
}

Evidence EvidenceOf(const EpipolarPairs& pairs, const WatchLayout& layout,
                    std::span<const StampedTangencies> frames, const BlockUnknowns& unknowns) {
  std::vector<Track> tracks(kTangentSides * pairs.pairs().size());
  for (const StampedTangencies& stamped : frames)
    for (const Tangency& tangency : stamped.frame.found) {
      Track& track = tracks[kTangentSides * tangency.pair + static_cast<std::size_t>(tangency.side)];
      track.time_s.push_back(stamped.time_s);
      track.tangency.push_back(&tangency);
    }
  const auto cameras = static_cast<Eigen::Index>(layout.cameras());
  const auto steady = layout.size() - layout.steady_begin();
  const Eigen::Index own = 2 * cameras + steady;
  const Eigen::Index all = layout.size() + own;
  FullEquations full{Eigen::MatrixXd::Zero(all, all), Eigen::VectorXd::Zero(all), 0};
  for (const Track& track : tracks)
    if (!track.tangency.empty()) AddTrack(pairs, layout, track, unknowns, &full);
  // Takes the block's own unknowns out (Schur complement); what is expected of them keeps them small.
  Eigen::MatrixXd inner = full.information.bottomRightCorner(own, own);
  inner.diagonal().head(cameras).array() += 1.0 / (unknowns.dilation_px * unknowns.dilation_px);
  inner.diagonal().segment(cameras, cameras).array() += 1.0 / (unknowns.skew_s * unknowns.skew_s);
  inner.diagonal().tail(steady).array() += 1.0 / (unknowns.place_px * unknowns.place_px);
  const Eigen::MatrixXd mixed = full.information.topRightCorner(layout.size(), own);
  const Eigen::LDLT<Eigen::MatrixXd> solver(inner);
  return {
      full.information.topLeftCorner(layout.size(), layout.size()) - mixed * solver.solve(mixed.transpose()),
      full.score.head(layout.size()) - mixed * solver.solve(full.score.tail(own)), full.residuals};
}

}  // namespace elbowroom::recon
