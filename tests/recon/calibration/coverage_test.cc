// Whether the truth is in the stated regions as often as they say, and how near it is.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/error.h"
#include "recon/calibration/calibrate.h"
#include "recon/calibration/rotation.h"
#include "tests/recon/calibration/calibration_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
// Quantiles of chi squared for 3 and 1 degrees of freedom at 68 % and 95 %.
constexpr double k68Of3 = 3.506, k95Of3 = 7.815, k68Of1 = 0.989, k95Of1 = 3.841;

struct Share {
  double share = 0.0;
  double sigma = 0.0;  // standard error; the cameras of a rig are right or wrong together
};

// How many of each rig's cameras are inside.
class Tally {
 public:
  void Add(const std::vector<double>& chi2, double limit_68, double limit_95) {
    const auto inside = [&](double limit) {
      return static_cast<double>(std::ranges::count_if(chi2, [&](double c) { return c <= limit; }));
    };
    in_68_.push_back(inside(limit_68));
    in_95_.push_back(inside(limit_95));
    counts_.push_back(static_cast<double>(chi2.size()));
  }
  // The wanted share, by so much and three standard errors.
  void Expect(const char* what, double slack_68, double slack_95) const {
    const Share share_68 = ShareOf(in_68_), share_95 = ShareOf(in_95_);
    EXPECT_NEAR(share_68.share, 0.68, slack_68 + 3.0 * share_68.sigma) << what;
    EXPECT_NEAR(share_95.share, 0.95, slack_95 + 3.0 * share_95.sigma) << what;
  }

  void Print(const char* what) const {
    const Share share_68 = ShareOf(in_68_), share_95 = ShareOf(in_95_);
    std::printf("  %-32s 68 %%: %.1f +- %.1f   95 %%: %.1f +- %.1f\n", what, 100.0 * share_68.share,
                100.0 * share_68.sigma, 100.0 * share_95.share, 100.0 * share_95.sigma);
  }

 private:
  // A ratio of sums, with rigs as the independent cases.
  [[nodiscard]] Share ShareOf(const std::vector<double>& inside) const {
    double in = 0.0, all = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < inside.size(); ++i) {
      in += inside[i];
      all += counts_[i];
    }
    if (all == 0.0) return {};
    for (std::size_t i = 0; i < inside.size(); ++i) squares += std::pow(inside[i] - in / all * counts_[i], 2);
    return {in / all, std::sqrt(squares) / all};
  }

  std::vector<double> in_68_, in_95_, counts_;
};

double QuantileOf(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(share * (static_cast<double>(values.size()) - 1.0) + 0.5);
  std::ranges::nth_element(values, values.begin() + at);
  return values[static_cast<std::size_t>(at)];
}

void PrintErrors(const char* what, const char* unit, const std::vector<double>& values) {
  std::printf("  %-32s median %.4f   95 %%: %.4f   worst %.4f %s\n", what, QuantileOf(values, 0.5),
              QuantileOf(values, 0.95), QuantileOf(values, 1.0), unit);
}

// Boards that stand far from the truth. A board that looks the same after half a turn may be numbered from
// its other end where a run of frames begins; that isn't a flip.
int FlippedBoards(const CalibrationScene& scene, const CalibrationResult& result) {
  constexpr double kFarRad = 0.05;
  int flipped = 0;
  for (const BoardPose& board : result.boards) {
    const Eigen::Matrix3d& truth = scene.world_from_board[static_cast<std::size_t>(board.set)].rotation;
    const auto angle_to = [&](const Eigen::Matrix3d& rotation) {
      return VectorFromRotation(board.world_from_board.rotation.transpose() * rotation).norm();
    };
    double angle_rad = angle_to(truth);
    if (PointAfterHalfTurn(scene.input.board, 0))
      angle_rad = std::min(angle_rad, angle_to(truth * Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal()));
    flipped += angle_rad > kFarRad ? 1 : 0;
  }
  return flipped;
}

struct RigOutcome {
  std::string refusal;
  std::vector<CameraError> cameras;
  std::vector<double> turn_to_first_deg, distance_to_first_mm;  // errors of each camera against the first
  std::vector<double> center_sigma_mm, rotation_sigma_deg;
  std::vector<bool> has_true_model;
  bool is_enlarged = false;
  int flipped = 0, other_models = 0, wrong_used = 0, right_left_out = 0, views = 0;
  double seconds = 0.0;
};

void CompareWithFirst(const CalibrationScene& scene, const CalibrationResult& result, RigOutcome* outcome) {
  const auto first_from = [](const core::CameraCalibration& first, const core::CameraCalibration& other) {
    return first.cam_from_world * other.cam_from_world.Inverse();
  };
  for (std::size_t i = 1; i < scene.cameras.size(); ++i) {
    const core::RigidTransform truth = first_from(scene.cameras[0], scene.cameras[i]),
                               found =
                                   first_from(result.cameras[0].calibration, result.cameras[i].calibration);
    outcome->turn_to_first_deg.push_back(
        VectorFromRotation(truth.rotation * found.rotation.transpose()).norm() / kDegree);
    outcome->distance_to_first_mm.push_back(
        std::abs(truth.translation_mm.norm() - found.translation_mm.norm()));
  }
}

RigOutcome OutcomeOfRig(const CalibrationSceneOptions& options, std::uint64_t seed) {
  const CalibrationScene scene = MakeCalibrationScene(options, seed);
  RigOutcome outcome;
  CalibrationResult result;
  const auto start = std::chrono::steady_clock::now();
  try {
    result = Calibrate(scene.input);
  } catch (const core::Error& error) {
    outcome.refusal = error.what();
    return outcome;
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.flipped = FlippedBoards(scene, result);
  outcome.is_enlarged = result.uncertainty_scale > 1.0;
  for (int i = 0; i < static_cast<int>(scene.cameras.size()); ++i) {
    const auto at = static_cast<std::size_t>(i);
    outcome.cameras.push_back(ErrorOfCamera(scene, result, i));
    outcome.center_sigma_mm.push_back(CenterSigmaMm(result, i));
    outcome.rotation_sigma_deg.push_back(RotationSigmaRad(result, i) / kDegree);
    outcome.has_true_model.push_back(result.cameras[at].calibration.distortion_model ==
                                     scene.cameras[at].distortion_model);
    outcome.other_models += outcome.has_true_model.back() ? 0 : 1;
  }
  outcome.views = static_cast<int>(result.views.size());
  for (std::size_t i = 0; i < result.views.size(); ++i) {
    outcome.wrong_used += scene.is_wrong[i] && result.views[i].is_used ? 1 : 0;
    outcome.right_left_out += !scene.is_wrong[i] && !result.views[i].is_used ? 1 : 0;
  }
  CompareWithFirst(scene, result, &outcome);
  return outcome;
}

// What all rigs of a series say together.
class Series {
 public:
  void Add(std::uint64_t seed, const RigOutcome& rig) {
    ++rigs_;
    if (!rig.refusal.empty()) {
      ++refused_;
      EXPECT_NE(rig.refusal.find("cam"), std::string::npos) << rig.refusal;
      EXPECT_NE(rig.refusal.find("next"), std::string::npos) << rig.refusal;
      std::printf("  rig %d refused: %s\n", static_cast<int>(seed), rig.refusal.c_str());
      return;
    }
    AddCameras(seed, rig);
    const auto append = [](const std::vector<double>& from, std::vector<double>* to) {
      to->insert(to->end(), from.begin(), from.end());
    };
    append(rig.turn_to_first_deg, &turn_to_first_deg_);
    append(rig.distance_to_first_mm, &distance_to_first_mm_);
    append(rig.center_sigma_mm, &center_sigma_mm_);
    append(rig.rotation_sigma_deg, &rotation_sigma_deg_);
    flipped_ += rig.flipped;
    enlarged_ += rig.is_enlarged ? 1 : 0;
    other_models_ += rig.other_models;
    wrong_used_ += rig.wrong_used;
    right_left_out_ += rig.right_left_out;
    views_ += rig.views;
    seconds_.push_back(rig.seconds);
  }

  void Print() const {
    std::printf("  %d rigs, %d refused; %d cameras, %d with another model; %d boards flipped\n", rigs_,
                refused_, static_cast<int>(center_mm_.size()), other_models_, flipped_);
    std::printf("  %d rigs whose uncertainties are enlarged\n", enlarged_);
    std::printf("  of %d views, %d wrong ones used and %d right ones left out\n", views_, wrong_used_,
                right_left_out_);
    PrintErrors("centre", "mm", center_mm_);
    PrintErrors("rotation", "deg", rotation_deg_);
    PrintErrors("offset", "ms", offset_ms_);
    PrintErrors("turn to the first camera", "deg", turn_to_first_deg_);
    PrintErrors("distance to the first camera", "mm", distance_to_first_mm_);
    PrintErrors("stated sigma of centre", "mm", center_sigma_mm_);
    PrintErrors("stated sigma of rotation", "deg", rotation_sigma_deg_);
    PrintErrors("time", "s", seconds_);
    centers_.Print("centre");
    rotations_.Print("rotation");
    rotations_of_true_models_.Print("rotation, the lens's own model");
    rotations_of_others_.Print("rotation, another model");
    offsets_.Print("offset");
  }

  void Expect(double most_center_mm, double most_rotation_deg) const {
    centers_.Expect("centre", 0.05, 0.03);
    rotations_.Expect("rotation", 0.05, 0.03);
    offsets_.Expect("offset", 0.05, 0.03);
    EXPECT_LE(QuantileOf(center_mm_, 0.5), most_center_mm);
    EXPECT_LE(QuantileOf(rotation_deg_, 0.5), most_rotation_deg);
    EXPECT_LE(QuantileOf(offset_ms_, 0.5), 1.0);
    EXPECT_EQ(flipped_, 0);
    EXPECT_EQ(enlarged_, 0) << "the noise here is independent";
    EXPECT_LE(refused_, rigs_ / 20);  // every rig can be calibrated
  }

 private:
  void AddCameras(std::uint64_t seed, const RigOutcome& rig) {
    std::vector<double> centers, rotations, offsets, of_true_models, of_others;
    for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
      const CameraError& error = rig.cameras[i];
      centers.push_back(error.center_chi2);
      rotations.push_back(error.rotation_chi2);
      (rig.has_true_model[i] ? of_true_models : of_others).push_back(error.rotation_chi2);
      center_mm_.push_back(error.center_mm);
      rotation_deg_.push_back(error.rotation_rad / kDegree);
      if (error.has_offset) {
        offsets.push_back(error.offset_chi2);
        offset_ms_.push_back(1000.0 * std::abs(error.offset_s));
      }
      constexpr double kStrange = 25.0;
      if (std::max({error.center_chi2, error.rotation_chi2, error.offset_chi2}) > kStrange)
        std::printf("  rig %d, camera %zu: squared distances %.0f, %.0f, %.0f\n", static_cast<int>(seed),
                    i + 1, error.center_chi2, error.rotation_chi2, error.offset_chi2);
    }
    centers_.Add(centers, k68Of3, k95Of3);
    rotations_.Add(rotations, k68Of3, k95Of3);
    rotations_of_true_models_.Add(of_true_models, k68Of3, k95Of3);
    rotations_of_others_.Add(of_others, k68Of3, k95Of3);
    offsets_.Add(offsets, k68Of1, k95Of1);
  }

  int rigs_ = 0, refused_ = 0, flipped_ = 0, enlarged_ = 0, other_models_ = 0, wrong_used_ = 0,
      right_left_out_ = 0, views_ = 0;
  Tally centers_, rotations_, rotations_of_true_models_, rotations_of_others_, offsets_;
  std::vector<double> center_mm_, rotation_deg_, offset_ms_, turn_to_first_deg_, distance_to_first_mm_,
      center_sigma_mm_, rotation_sigma_deg_, seconds_;
};

// In portions, so that a long soak shows how far it is.
Series RunSeries(const char* name, int rigs, CalibrationSceneOptions (*options_of)(std::uint64_t)) {
  constexpr int kPortion = 20;
  std::printf("%s\n", name);
  Series series;
  for (int first = 0; first < rigs; first += kPortion) {
    std::vector<RigOutcome> outcomes(static_cast<std::size_t>(std::min(kPortion, rigs - first)));
    tbb::parallel_for(std::size_t{0}, outcomes.size(), [&](std::size_t i) {
      const auto seed = static_cast<std::uint64_t>(first) + i;
      outcomes[i] = OutcomeOfRig(options_of(seed), seed);
    });
    for (std::size_t i = 0; i < outcomes.size(); ++i)
      series.Add(static_cast<std::uint64_t>(first) + i, outcomes[i]);
    if (first > 0 && first % (5 * kPortion) == 0) series.Print();
    std::fflush(stdout);
  }
  series.Print();
  return series;
}

TEST(CalibrationCoverage, OfARecordingAsTheUserGuideSays) {
  RunSeries("as the user guide says", 10 * test_support::SoakScale(), RecommendedSceneOptions)
      .Expect(0.5, 0.02);
}

TEST(CalibrationCoverage, OfLittleData) {
  RunSeries("little data", 10 * test_support::SoakScale(), RandomSceneOptions).Expect(1.5, 0.15);
}

}  // namespace
}  // namespace elbowroom::recon
