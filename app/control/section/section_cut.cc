#include "app/control/section/section_cut.h"

#include <algorithm>

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

// The part of a segment, in shares of its length, where an affine value isn't above 0.
class Share {
 public:
  void KeepWhereNotAbove0(double at_begin, double at_end) {
    const double step = at_end - at_begin;
    if (step == 0.0) {
      if (at_begin > 0.0) enters_ = 2.0;
    } else if (step > 0.0) {
      leaves_ = std::min(leaves_, -at_begin / step);
    } else {
      enters_ = std::max(enters_, -at_begin / step);
    }
  }
  [[nodiscard]] bool is_empty() const { return enters_ > leaves_; }

 private:
  double enters_ = 0.0, leaves_ = 1.0;
};

}  // namespace

bool SectionCut::Keeps(const Vector3d& x_in_world) const {
  return std::ranges::all_of(
      kept, [&](const recon::HalfSpace& half_space) { return half_space.BeyondMm(x_in_world) <= 0.0; });
}

BoxKept KeptOf(const SectionCut& cut, const Eigen::AlignedBox3d& box_in_world) {
  if (box_in_world.isEmpty()) return BoxKept::kNothing;
  BoxKept kept = BoxKept::kAll;
  for (const recon::HalfSpace& half_space : cut.kept) {
    const double middle_mm = half_space.BeyondMm(box_in_world.center());
    const double reach_mm = half_space.outward.cwiseAbs().dot(0.5 * box_in_world.sizes());
    if (middle_mm - reach_mm >= 0.0) return BoxKept::kNothing;
    if (middle_mm + reach_mm > 0.0) kept = BoxKept::kMaybeCut;
  }
  return kept;
}

bool MeetsKept(const SectionCut& cut, const Eigen::AlignedBox3d& box_in_world, const Vector3d& from_in_world,
               const Vector3d& to_in_world) {
  Share share;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    share.KeepWhereNotAbove0(box_in_world.min()[axis] - from_in_world[axis],
                             box_in_world.min()[axis] - to_in_world[axis]);
    share.KeepWhereNotAbove0(from_in_world[axis] - box_in_world.max()[axis],
                             to_in_world[axis] - box_in_world.max()[axis]);
  }
  for (const recon::HalfSpace& half_space : cut.kept)
    share.KeepWhereNotAbove0(half_space.BeyondMm(from_in_world), half_space.BeyondMm(to_in_world));
  return !share.is_empty();
}

}  // namespace elbowroom::control
