// The plane sweep the slow, obviously right way: every pixel, every plane, every camera, in double precision,
// with an opinion on what rounding may decide.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "recon/paper_methods/plane_sweep.h"
#include "tests/recon/hull/sure.h"
#include "tests/recon/scenes/grid_oracle.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {

// How far an implementation may be off before a label is wrong (docs/plane_sweep.md, "Rounding").
struct SweepBand {
  double roundings = 32.0;       // of single precision, on the way to a position
  double filter_coverage = 0.0;  // of the interpolation, in shares of a pixel
  double corner_px = 0.0;        // by which a grid's corners are moved when they are drawn
};

inline constexpr double kGlFilterCoverage = 4.0 / 256.0;

// The volume query of a point, in double precision.
class PointOracle {
 public:
  // Keeps a reference to the rig. One mask a camera.
  PointOracle(const core::Rig& rig, std::span<const core::SoftMask> masks, const SweepBand& band);

  // Whether the point is in the hull. `size_mm`: of the numbers that it was computed from.
  [[nodiscard]] Sure InHull(const Eigen::Vector3d& x_in_world, double size_mm) const;

  // The same where each camera sees the point at one of these positions instead of through its lens;
  // nothing: in its exterior.
  using PositionsOfCamera =
      std::function<std::vector<std::optional<PicturePosition>>(const core::CameraModel& camera)>;
  [[nodiscard]] Sure InHullAt(const Eigen::Vector3d& x_in_world, double size_mm,
                              const PositionsOfCamera& positions) const;

 private:
  struct Opinion {
    Sure seen, object;
  };
  [[nodiscard]] double CoverageAt(std::size_t camera, const Eigen::Vector2d& pixel) const;
  [[nodiscard]] Opinion OpinionOf(std::size_t camera, const Eigen::Vector3d& x_in_world,
                                  double size_mm) const;
  // Of a position of the camera's picture plane.
  [[nodiscard]] Opinion OpinionAt(std::size_t camera, const PicturePosition& position) const;
  [[nodiscard]] Opinion OpinionOfAny(std::size_t camera,
                                     std::span<const std::optional<PicturePosition>> positions) const;
  // What all cameras' opinions make of a point of the workspace.
  [[nodiscard]] Sure Decide(const Eigen::Vector3d& x_in_world, double size_mm,
                            const std::function<Opinion(std::size_t)>& opinion_of) const;

  const core::Rig& rig_;
  std::vector<std::vector<double>> coverages_;  // 0 to 1, row-major, one a camera
  SweepBand band_;
};

struct SweepCheck {
  int wrong_pixels = 0;   // a hit where the oracle is sure of none, or past a plane where it is sure of one
  int unsure_pixels = 0;  // some plane up to the answer is within the band
  int hit_pixels = 0;
  std::string first_wrong;  // what and where
};

[[nodiscard]] SweepCheck CheckSweep(const core::Rig& rig, std::span<const core::SoftMask> masks,
                                    const core::CameraModel& view, const PlaneSweepOptions& options,
                                    const DepthMap& picture, const SweepBand& band);

// The mask with random levels along its boundary.
[[nodiscard]] core::SoftMask WithRandomLevels(Random* random, core::BitMask mask);

// Somewhere around the workspace, towards it; its lens of any kind.
[[nodiscard]] core::CameraModel RandomView(Random* random, LensKind kind, const core::Rig& rig);

}  // namespace elbowroom::recon
