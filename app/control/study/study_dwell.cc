#include "app/control/study/study_dwell.h"

#include <algorithm>
#include <utility>

namespace elbowroom::control {
namespace {

bool IsSameSurface(const core::TriangleMesh& a, const core::TriangleMesh& b) {
  return &a == &b || (a.triangles == b.triangles && a.vertices_mm == b.vertices_mm);
}

}  // namespace

void DwellSum::Add(const sessions::SessionReader& session) {
  if (!session.has_outcome()) return;
  for (core::HeatMap& map : session.heat_maps()) {
    const core::Part& part = session.header().layout.parts[map.part];
    const auto place = std::ranges::lower_bound(parts_, part.name, {}, &PartDwell::part);
    if (place == parts_.end() || place->part != part.name) {
      parts_.insert(place, {part.name, part.mesh, std::move(map), 1});
      continue;
    }
    core::HeatMap& sum = place->map;
    if (sum.patch_mm != map.patch_mm || sum.dwell_s.size() != map.dwell_s.size() ||
        !IsSameSurface(*place->mesh, *part.mesh)) {
      ++left_out_;
      continue;
    }
    ++place->sessions;
    for (std::size_t i = 0; i < sum.dwell_s.size(); ++i) {
      sum.dwell_s[i] += map.dwell_s[i];
      sum.peak_depth_mm[i] = std::max(sum.peak_depth_mm[i], map.peak_depth_mm[i]);
    }
  }
}

}  // namespace elbowroom::control
