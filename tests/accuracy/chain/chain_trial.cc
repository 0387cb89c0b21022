#include "tests/accuracy/chain/chain_trial.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "app/control/frame_judge.h"
#include "app/control/frame_pipeline.h"
#include "app/control/trial_rules.h"
#include "core/error.h"
#include "recon/synthetic/sensor_noise.h"
#include "tests/accuracy/chain/chain_parts.h"
#include "tests/accuracy/chain/verdict_tally.h"
#include "tests/oracles/solid_distance.h"

namespace elbowroom::accuracy {
namespace {

using recon::Random;

constexpr int kFirstFrames = 4;
constexpr double kTrueToleranceMm = 0.05;
constexpr double kTrueFarMm = VerdictTally::kFarthestMm;

review::PartReviewOptions ReviewWith(const ChainRig& rig, double required_mm) {
  core::TrialInfo trial;
  trial.required_clearance_mm = required_mm;
  return control::ReviewOptionsOf(trial, rig.estimate, rig.quality);
}

recon::SegmentationOptions Adaptive() {
  recon::SegmentationOptions options;
  options.method = recon::SegmentationMethod::kAdaptive;
  return options;
}

// All of the object is in all pictures and in the workspace, as a set-up must see to.
bool IsSeenWhole(const core::Rig& rig, const ChainMotion& motion, double from_s, double to_s) {
  constexpr double kStepS = 0.1, kMarginPx = 4.0;
  for (double time_s = from_s; time_s <= to_s; time_s += kStepS) {
    for (const recon::Solid& solid : SolidsAt(motion, time_s)) {
      const recon::BoundingSphere sphere = recon::BoundingSphereOf(solid);
      const Eigen::Vector3d reach = Eigen::Vector3d::Constant(sphere.radius_mm);
      if (!rig.workspace_mm.contains(
              Eigen::AlignedBox3d(sphere.center_in_world - reach, sphere.center_in_world + reach)))
        return false;
      for (const core::CameraModel& camera : rig.cameras) {
        const auto middle = camera.Project(sphere.center_in_world);
        const double away_mm = (sphere.center_in_world - camera.center_in_world()).norm();
        const double room_px =
            kMarginPx + camera.calibration().camera_matrix(0, 0) * sphere.radius_mm / away_mm;
        if (!middle || middle->minCoeff() < room_px || middle->x() > camera.width_px() - room_px ||
            middle->y() > camera.height_px() - room_px)
          return false;
      }
    }
  }
  return true;
}

ChainMotion DrawSeenMotion(const core::Rig& rig, ChainObject object, double to_s, Random* random) {
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    ChainMotion motion =
        DrawChainMotion(object, ChainMiddleInWorld(), static_cast<std::uint64_t>(random->Whole(0, 1 << 30)));
    if (IsSeenWhole(rig, motion, 0.0, to_s)) return motion;
  }
  throw core::PreconditionError("a rig that sees all of a hand's motion");
}

// How far a part shall be from the object at some time.
double DrawDistanceMm(Random* random) {
  constexpr std::array<std::array<double, 2>, 4> kRangesMm{
      {{-10.0, 0.0}, {0.0, 10.0}, {10.0, 30.0}, {30.0, 100.0}}};
  const auto& [from, to] = kRangesMm[static_cast<std::size_t>(random->Whole(0, 3))];
  return random->Uniform(from, to);
}

core::Layout DrawLayout(const ChainMotion& motion, double to_s, Random* random) {
  const std::vector<core::SharedMesh> meshes = ChainPartMeshes();
  std::vector<std::vector<recon::Solid>> objects;
  std::vector<double> distances_mm;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    objects.push_back(SolidsAt(motion, random->Uniform(0.0, to_s)));
    distances_mm.push_back(DrawDistanceMm(random));
  }
  return DrawChainLayout(meshes, objects, distances_mm, random);
}

double FastestMmPerS(const ChainMotion& motion, double time_s) {
  constexpr double kStepS = 1e-3;
  const std::vector<recon::Solid> before = SolidsAt(motion, time_s - kStepS);
  const std::vector<recon::Solid> after = SolidsAt(motion, time_s + kStepS);
  double way_mm = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i)
    way_mm = std::max(way_mm, (recon::BoundingSphereOf(after[i]).center_in_world -
                               recon::BoundingSphereOf(before[i]).center_in_world)
                                  .norm());
  return way_mm / (2.0 * kStepS);
}

double MostSkewS(const ChainClock::Set& set) {
  double most_s = 0.0;
  for (const ChainClock::Instant& camera : set.cameras)
    most_s = std::max(most_s, std::abs(camera.true_s - set.time_s));
  return most_s;
}

// The pipeline of a trial with the usual rule; the other rules judge the same hulls.
class ChainJudges {
 public:
  ChainJudges(const ChainRig& rig, const core::Layout& layout,
              const std::vector<recon::BackgroundReference>& backgrounds)
      : pipeline_(rig.estimate, layout, backgrounds, Adaptive(), ReviewWith(rig, kRequiredMm[kUsualRule])),
        touch_(*pipeline_.layout(), ReviewWith(rig, kRequiredMm[kTouchRule])),
        closest_(*pipeline_.layout(), ReviewWith(rig, kRequiredMm[kClosestRule])) {}

  using Results = std::array<control::SharedFrameResult, kRequiredMm.size()>;
  [[nodiscard]] const Results& Judge(recon::FrameSet frames) {
    const control::SharedFrameResult usual = pipeline_.Process(std::move(frames), {});
    last_[kTouchRule] = JudgedBy(touch_, *usual, last_[kTouchRule]);
    last_[kClosestRule] = JudgedBy(closest_, *usual, last_[kClosestRule]);
    last_[kUsualRule] = usual;
    return last_;
  }

 private:
  static control::SharedFrameResult JudgedBy(control::FrameJudge& judge, const control::FrameResult& usual,
                                             const control::SharedFrameResult& last) {
    const auto result = std::make_shared<control::FrameResult>(usual);
    judge.Judge(last.get(), result.get());
    return result;
  }

  control::FramePipeline pipeline_;
  control::FrameJudge touch_, closest_;
  Results last_;
};

}  // namespace

std::vector<JudgedPart> RunChainTrial(const ChainRig& rig, const ChainCameras& cameras,
                                      const std::vector<recon::BackgroundReference>& backgrounds,
                                      const ChainTrialOptions& options) {
  constexpr double kRateHz = 30.0, kMostDrift = 0.15, kMostDriftPerS = 0.01;
  Random random(options.seed);
  const double end_s = (options.frames + kFirstFrames + 3) / kRateHz;
  const ChainMotion motion = DrawSeenMotion(rig.truth, options.object, end_s, &random);
  const core::Layout layout = DrawLayout(motion, end_s, &random);
  const ChainLight light{random.Uniform(0.0, 2.0 * std::numbers::pi),
                         1.0 + random.Uniform(-kMostDrift, kMostDrift),
                         random.Uniform(-kMostDriftPerS, kMostDriftPerS)};
  ChainClock clock(rig.truth.cameras.size(), options.seed);
  ChainJudges judges(rig, layout, backgrounds);
  std::vector<JudgedPart> judged;
  for (int frame = 0; frame < options.frames + kFirstFrames; ++frame) {
    const ChainClock::Set set = clock.Next();
    recon::FrameSet frames;
    frames.index = frame;
    frames.time_s = set.time_s;
    frames.cameras.resize(set.cameras.size());
    tbb::parallel_for(std::size_t{0}, set.cameras.size(), [&](std::size_t i) {
      const double at_s = set.cameras[i].true_s;
      const std::uint64_t noise = recon::StreamSeed(options.seed, frame, i, 2);
      frames.cameras[i].image_bgr = cameras.Take(i, SolidsAt(motion, at_s), light.GainAt(at_s), noise);
      frames.cameras[i].stamp = set.cameras[i].stamp;
    });
    const ChainJudges::Results& results = judges.Judge(std::move(frames));
    if (frame < kFirstFrames) continue;
    const std::vector<recon::Solid> solids = SolidsAt(motion, set.time_s);
    const double fastest_mm_per_s = FastestMmPerS(motion, set.time_s);
    for (core::PartIndex part = 0; part < layout.parts.size(); ++part) {
      JudgedPart one;
      one.fastest_mm_per_s = fastest_mm_per_s;
      one.most_skew_s = MostSkewS(set);
      one.true_mm = oracles::SolidDistanceMm(*layout.parts[part].mesh, layout.parts[part].world_from_part,
                                             solids, kTrueToleranceMm, kTrueFarMm);
      for (std::size_t rule = 0; rule < results.size(); ++rule)
        one.verdicts[rule] = results[rule]->record.contacts[part].verdict;
      const core::PartContact& usual = results[kUsualRule]->record.contacts[part];
      if (usual.verdict != core::Verdict::kContact && usual.clearance && usual.clearance->budget)
        one.bounds = {usual.clearance->interval.lower_mm, usual.clearance->interval.upper_mm,
                      usual.clearance->has_witnesses, *usual.clearance->budget};
      judged.push_back(one);
    }
  }
  return judged;
}

}  // namespace elbowroom::accuracy
