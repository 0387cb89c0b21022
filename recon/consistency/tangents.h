// The outermost tangents of one camera's silhouette from the epipoles of the other cameras.
#pragma once

#include <Eigen/Core>
#include <array>
#include <variant>
#include <vector>

#include "core/ids.h"
#include "core/soft_mask.h"
#include "recon/consistency/epipolar_pairs.h"
#include "recon/contours/contour.h"

namespace elbowroom::recon {

// Why a tangent, or a comparison of two, can't be used.
enum class TangencySkip {
  kNothingSeen,   // no object in the picture
  kAtEpipole,     // the silhouette surrounds the epipole, or is too near to it
  kAtBorder,      // the tangent touches where the picture ends
  kUneven,        // the boundary has a corner there, or too few points
  kMaybeHidden,   // the silhouette is cut, and the other camera may not see what the tangent touches
  kContradicted,  // far off, where two other pairs of each of the two cameras agree
};
inline constexpr std::size_t kTangencySkips = 6;

struct TangentOptions {
  double boundary_sigma_px = 0.2;  // noise of the boundary across itself; core::kBoundarySigmaPx; > 0
  double correlation_px = 3.0;     // along the boundary, its integral over one side and the other; >= 0
  double depth_px = 1.0;           // the boundary counts as far as this from the tangent; > 0
  double reach_px = 10.0;          // ... and this to either side; > 0
  double border_px = 3.0;          // a tangent nearer to the picture's border is kAtBorder; >= 0
  double least_px_per_rad = 25.0;  // a tangent that touches nearer to the epipole is kAtEpipole; > 0

  // Throws: PreconditionError naming the field out of range.
  void Validate() const;
};

// The epipolar plane that touches a silhouette, as one camera sees it.
struct Tangent {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();         // where it touches: UndistortedPlane units
  Eigen::Vector3d sight_in_world = Eigen::Vector3d::UnitZ();  // unit: through that position
  double angle_rad = 0.0;                                     // of the plane, as EpipolarPair has it
  double sigma_px = 0.0;          // standard uncertainty across the tangent, in the camera's picture
  double px_per_rad = 1.0;        // the picture's pixels that the tangent moves by when the plane turns
  bool is_seen_by_other = false;  // the pair's other camera sees all of the sight within the workspace

  [[nodiscard]] double sigma_rad() const { return sigma_px / px_per_rad; }
};

using TangentOrSkip = std::variant<Tangent, TangencySkip>;

enum class TangentSide : std::size_t { kLowest = 0, kHighest = 1 };  // by the plane's angle
inline constexpr std::size_t kTangentSides = 2;

struct CameraTangents {
  // The object doesn't touch the picture's border.
  bool is_whole = true;
  // [other camera][side]; those of the camera itself, and of cameras that make no pair with it, are
  // kNothingSeen.
  std::vector<std::array<TangentOrSkip, kTangentSides>> of_other;
};

// The tangents of a silhouette. A vertex of the contour with the least or largest angle says where, and a
// parabola through the boundary around it says how far, so that noise doesn't push the tangent outwards
// (docs/consistency.md; tangents_test holds it to solids and to a search over all boundary points).
// `contour`: as TraceContour makes it with a background exterior. Throws: PreconditionError for a mask that
// hasn't the camera's size. Thread: any.
[[nodiscard]] CameraTangents FindTangents(const EpipolarPairs& pairs, core::CameraIndex camera,
                                          const core::SoftMask& mask, const Contour& contour,
                                          const TangentOptions& options = {});
[[nodiscard]] CameraTangents FindTangents(const EpipolarPairs& pairs, core::CameraIndex camera,
                                          const core::SoftMask& mask, const TangentOptions& options = {});

}  // namespace elbowroom::recon
