// Sightings of a board in the pictures of true cameras, and how they go wrong.
#pragma once

#include <vector>

#include "core/camera_model.h"
#include "core/rigid_transform.h"
#include "recon/boards/board_sighting.h"
#include "recon/calibration/board_surface.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {

enum class Fault { kNone, kMirrored, kConfused, kPointsShifted, kViewShifted };

// A printed board as it is: bent or not.
struct TrueBoard {
  BoardSurface surface;
  std::vector<Eigen::Vector3d> points;

  TrueBoard(const Board& board, const Eigen::Vector3d& bend_mm);
};

[[nodiscard]] double NormalNumber(Random* random);

void AddNoiseTo(double noise_px, Random* random, BoardSighting* sighting);

// The points in the camera's picture. Empty: too few, from behind, or too much aslant.
[[nodiscard]] BoardSighting Look(const core::CameraModel& camera,
                                 const core::RigidTransform& world_from_board,
                                 const std::vector<Eigen::Vector3d>& points, double sigma_px);

// The points on one side of a line through the middle, at a random angle.
void HideHalf(const std::vector<Eigen::Vector3d>& points, Random* random, BoardSighting* sighting);

// One of the faults with this probability.
[[nodiscard]] Fault DrawFault(double share, Random* random);
// All of them but kMirrored.
void Disturb(Fault fault, Random* random, BoardSighting* sighting);
// The board as a flip would have it, which is what kMirrored shows.
[[nodiscard]] core::RigidTransform MirroredFor(const core::CameraModel& camera,
                                               const core::RigidTransform& world_from_board,
                                               const Eigen::Vector3d& center_in_board);

void NumberFromOtherEnd(const BoardSurface& surface, BoardSighting* sighting);

// The board held before the camera for a photo of its lens: its middle anywhere in the inner 60 % of
// the picture, as long as 80 to 150 % of the picture is wide, tilted by 15 to 50 degrees in any direction,
// and turned by any angle.
[[nodiscard]] core::RigidTransform DrawLensPhoto(const core::CameraModel& camera, const TrueBoard& board,
                                                 Random* random);

}  // namespace elbowroom::recon
