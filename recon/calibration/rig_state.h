// A rig while it is being calibrated: what is known of every camera, set and view.
#pragma once

#include <string>
#include <vector>

#include "recon/calibration/adjustment.h"
#include "recon/calibration/bundle.h"
#include "recon/calibration/calibration_input.h"
#include "recon/calibration/planar_pose.h"

namespace elbowroom::recon {

struct RigView {
  int camera = 0;
  int set = -1;  // place in RigState::sets; -1: for the lens alone
  double time_s = 0.0;
  std::vector<AdjustedPoint> points;  // numbered after the half turn, if there is one
  bool is_half_turned = false;
  bool is_used = false;
  bool is_final = false;  // not taken back
  std::string reason;
  core::RigidTransform cam_from_board;  // of views that have a board for themselves
  bool has_pose = false;
  // Whether it takes part by the board of its set. Else the board of this view is a parameter of its own, and
  // the view tells about the lens alone.
  bool shares_board = false;
  int adjusted = -1;  // place in the last Adjustment; -1: not in it
};

struct RigSet {
  int number = 0;       // in the input
  double time_s = 0.0;  // instant of its board: the first camera's stamp, or else the mean of all
  core::RigidTransform rig_from_board;
  bool has_pose = false;
  std::vector<int> views;  // places in RigState::views
  int adjusted = -1;       // its board in the last Adjustment
};

struct RigState {
  const CalibrationInput* input = nullptr;
  const BoardSurface* surface = nullptr;
  std::vector<AdjustedCamera> cameras;
  Eigen::Vector3d flatness_mm = Eigen::Vector3d::Zero();
  bool is_flatness_fixed = true;
  bool has_motion = false;     // the board's motion between the instants of a set is modelled
  int world_set = -1;          // place in sets; -1: the world is a camera
  std::vector<RigSet> sets;    // in the order of time
  std::vector<RigView> views;  // as in the input
  std::vector<std::string> warnings;

  [[nodiscard]] int UsedViewsOf(const RigSet& set) const;
};

// Sets and views as in the input, without poses. Throws: Error{kCamera} if the world's set has no view.
[[nodiscard]] RigState StateOf(const CalibrationInput& input, const BoardSurface& surface,
                               const std::vector<LensParameters>& lenses);

// The numbers to adjust: used views that have a pose, and what they show. Sets of two views and more come
// first, in the order of time. Keeps in the state where everything went.
//
// A view of another instant than its set's needs three sets in a row, none more than 3.5 frame periods from
// the next, that several cameras confirm, and its instant must be between them. Where there are none, the
// view is taken for its lens alone; the board of the world's set is taken as still.
[[nodiscard]] Adjustment AdjustmentOf(RigState* state);

// Brings what the adjustment found back into the state.
void TakeOver(const Adjustment& adjustment, RigState* state);

// The share of the sets with several views whose motion can be modelled, by what is used at present.
[[nodiscard]] double ShareOfMovingSets(const RigState& state);

// The used points of a view, moved to where they are at its set's instant, so that one pose fits all of a
// set's views.
[[nodiscard]] PosedView PosedAtSetInstant(const Adjustment& adjustment, const AdjustedView& view);

// Changes the frame of the fit: x_in_new = new_from_rig * x_in_rig. By value: it may be a pose of the state.
void ChangeFrame(core::RigidTransform new_from_rig, RigState* state);

}  // namespace elbowroom::recon
