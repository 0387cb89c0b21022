#include "app/control/frame_result.h"

namespace elbowroom::control {

SkipCount& SkipCount::operator+=(const SkipCount& other) {
  segmentation += other.segmentation;
  hull.unchanged_silhouettes += other.hull.unchanged_silhouettes;
  hull.empty_silhouettes += other.hull.empty_silhouettes;
  hull.untraced_silhouettes += other.hull.untraced_silhouettes;
  unchanged_parts += other.unchanged_parts;
  triangles_in_all += other.triangles_in_all;
  triangles_skipped += other.triangles_skipped;
  queries += other.queries;
  clearances_by_contact += other.clearances_by_contact;
  clearances_by_ball += other.clearances_by_ball;
  clearance_queries += other.clearance_queries;
  pairs += other.pairs;
  return *this;
}

}  // namespace elbowroom::control
