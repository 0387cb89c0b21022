// Seeded rigs around a table and a board that moves before them: the ground on which calibration is tested.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera_model.h"
#include "core/rigid_transform.h"
#include "recon/calibration/calibration_input.h"
#include "recon/calibration/calibration_result.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {

struct CalibrationSceneOptions {
  int cameras = 4;
  int runs = 30;          // of frames that follow each other, spread over a minute of motion
  int frames_of_run = 3;  // 1: the board is still at each instant
  double rest_s = 0.0;    // how long the board lies still at first; its pictures then are one view, the mean
  int lens_photos = 0;    // of each camera, for its lens alone
  double noise_px = 0.3;
  double sigma_px = 0.2;          // what the sightings say of it
  double wrong_share = 0.1;       // of the views: other correspondences, shifted points, mirrored poses
  double occluded_share = 0.2;    // of the views: half of the board is hidden
  double most_offset = 1.0;       // in frame periods, either way; 0: cameras are synchronous
  double bend_mm = 0.0;           // of the board, at most
  bool gives_models = false;      // else the lens's model is left to the fit
  bool has_plain_lenses = false;  // all plumb_bob, of little distortion
  Board board{BoardKind::kCharuco, 11, 8, 60.0, 40.0, "DICT_5X5_100"};  // A2 and a little more
};

// No two frames follow each other, so the board counts as still at each; no wrong views; the lenses' models
// are given.
[[nodiscard]] inline CalibrationSceneOptions StillBoardOptions() {
  CalibrationSceneOptions options;
  options.frames_of_run = 1;
  options.most_offset = 0.0;
  options.wrong_share = 0.0;
  options.gives_models = true;
  return options;
}

struct CalibrationScene {
  CalibrationInput input;
  std::vector<core::CameraCalibration> cameras;        // true
  std::vector<double> offsets_s;                       // true; of the first camera 0
  std::vector<core::RigidTransform> world_from_board;  // true, by number of set, at the first camera's stamp
  std::vector<bool> is_wrong;                          // by view
  std::vector<bool> is_mirrored;                       // by view: shows the board in its mirrored pose
};

// The world is the board in set 0, where it lies on the table. The same for the same seed and options.
[[nodiscard]] CalibrationScene MakeCalibrationScene(const CalibrationSceneOptions& options,
                                                    std::uint64_t seed);

// Options as a soak draws them: 3 to 8 cameras, and all that calibration must stand. Little data: 60 to 120
// sets and nothing else.
[[nodiscard]] CalibrationSceneOptions RandomSceneOptions(std::uint64_t seed);
// The same, recorded as docs/user_guide.md says: a board of small squares at rest for 1 to 2 s, 51 to 99 sets
// of motion, and 30 to 40 photos for each lens.
[[nodiscard]] CalibrationSceneOptions RecommendedSceneOptions(std::uint64_t seed);

// Adds noise to the true positions of a scene without noise or wrong views.
void AddNoise(double noise_px, Random* random, CalibrationInput* input);

// A camera's error against what the result states of it.
struct CameraError {
  double center_mm = 0.0;
  double rotation_rad = 0.0;
  double offset_s = 0.0;
  double center_chi2 = 0.0;  // squared Mahalanobis distances: 3, 3 and 1 degrees of freedom
  double rotation_chi2 = 0.0;
  double offset_chi2 = 0.0;
  bool has_offset = false;
};
[[nodiscard]] CameraError ErrorOfCamera(const CalibrationScene& scene, const CalibrationResult& result,
                                        int camera);

}  // namespace elbowroom::recon
