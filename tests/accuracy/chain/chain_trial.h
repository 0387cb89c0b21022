// A short trial of the simulated chain: one motion, judged frame by frame as the program does, beside the
// truth.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/contact.h"
#include "core/error_budget.h"
#include "recon/footage/frame_set.h"
#include "tests/accuracy/chain/chain_cameras.h"
#include "tests/accuracy/chain/chain_objects.h"
#include "tests/accuracy/chain/chain_rig.h"

namespace elbowroom::accuracy {

// The required clearances that each frame is judged by. With 0, as a trial has it that says nothing, only
// touches are judged, and no error is allowed for.
inline constexpr std::array kRequiredMm = {0.0, 1.0, 10.0};
inline constexpr std::size_t kTouchRule = 0, kClosestRule = 1, kUsualRule = 2;

// A part in a frame.
struct JudgedPart {
  double true_mm = 0.0;  // oracles::SolidDistanceMm at the frame's time; 0.05 mm above the exact one at most
  std::array<core::Verdict, kRequiredMm.size()> verdicts{};
  // Of the usual rule: the bounds of the distance to the hull, and what its verdict allows for. Nothing: hull
  // and part meet.
  struct Bounds {
    double lower_mm = 0.0;
    double upper_mm = 0.0;
    bool has_witnesses = false;  // else the search ended where the part was sure to be far enough away
    core::ErrorBudget budget;
  };
  std::optional<Bounds> bounds;
  double fastest_mm_per_s = 0.0;  // of what is real, the middle of its fastest solid
  double most_skew_s = 0.0;       // of the cameras: how far from the frame's time one took its picture
};

struct ChainTrialOptions {
  ChainObject object = ChainObject::kOpenHand;
  int frames = 50;
  std::uint64_t seed = 1;
};

// `cameras`: those of `rig.truth`. All parts of all frames, in order, but for the first frames of the trial,
// in which the program doesn't know yet how fast anything moves. The same for the same seed. Thread: any.
[[nodiscard]] std::vector<JudgedPart> RunChainTrial(
    const ChainRig& rig, const ChainCameras& cameras,
    const std::vector<recon::BackgroundReference>& backgrounds, const ChainTrialOptions& options);

}  // namespace elbowroom::accuracy
