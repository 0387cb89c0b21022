#include "review/contact_heat.h"

#include <algorithm>
#include <map>

#include "core/error.h"
#include "core/part_distance.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using recon::BallAnswer;

// Goes down the part's tree to the patches that the hull may reach.
class PatchSearch {
 public:
  PatchSearch(const recon::VisualHull& hull, const core::TriangleTree& part,
              const core::RigidTransform& world_from_part, const core::SurfacePatches& patches)
      : hull_(hull), part_(part), world_from_part_(world_from_part), patches_(patches) {}

  void VisitNode(std::uint32_t index, recon::UndecidedCameras open) {
    const core::TriangleTree::Node& node = part_.nodes()[index];
    if (hull_.Classify(world_from_part_ * node.ball.center, node.ball.radius_mm, &open) ==
        BallAnswer::kOutside)
      return;
    if (node.left != 0) {
      VisitNode(node.left, open);
      VisitNode(node.left + 1, open);
      return;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) VisitTriangle(part_.order()[i], open);
  }

  void Touch(std::size_t patch, const Vector3d& x_in_world, const recon::UndecidedCameras& open = {}) {
    if (!hull_.Contains(x_in_world, open)) return;
    double& depth_mm = depth_mm_.try_emplace(patch, 0.0).first->second;
    depth_mm = std::max(depth_mm, hull_.Probe(x_in_world).radius_mm);
  }

  [[nodiscard]] std::vector<TouchedPatch> Touched() const {
    std::vector<TouchedPatch> touched;
    for (const auto& [patch, depth_mm] : depth_mm_) touched.push_back({patch, depth_mm});
    return touched;
  }

 private:
  void VisitTriangle(std::size_t triangle, const recon::UndecidedCameras& open) {
    std::size_t patch = patches_.FirstOf(triangle);
    for (const core::SurfacePatches::Corners& corners : patches_.CornersOf(triangle))
      Touch(patch++, world_from_part_ * corners.Centre(), open);
  }

  const recon::VisualHull& hull_;
  const core::TriangleTree& part_;
  const core::RigidTransform& world_from_part_;
  const core::SurfacePatches& patches_;
  std::map<std::size_t, double> depth_mm_;
};

}  // namespace

std::vector<TouchedPatch> FindTouchedPatches(const recon::VisualHull& hull, const core::TriangleTree& part,
                                             const core::RigidTransform& world_from_part,
                                             const core::SurfacePatches& patches,
                                             const core::PartContact& contact) {
  if (part.nodes().empty() || hull.IsEmpty()) return {};
  PatchSearch search(hull, part, world_from_part, patches);
  search.VisitNode(0, {});
  const core::RigidTransform part_from_world = world_from_part.Inverse();
  const auto touch_point = [&](const core::ContactPoint& point) {
    const Vector3d x_in_part = part_from_world * point.position_in_world_mm;
    const std::uint32_t triangle = FindNearest(part, {.center = x_in_part}).triangle;
    search.Touch(patches.PatchAt(triangle, x_in_part), point.position_in_world_mm);
  };
  for (const core::ContactPoint& point : contact.points) touch_point(point);
  if (contact.deepest) touch_point(*contact.deepest);
  return search.Touched();
}

ContactHeat::ContactHeat(std::span<const core::TriangleTree> parts) : trees_(parts), parts_(parts.size()) {}

void ContactHeat::Add(double time_s, const std::shared_ptr<const recon::VisualHull>& hull,
                      std::span<const core::RigidTransform> world_from_parts,
                      std::span<const core::PartContact> contacts) {
  core::Require(world_from_parts.size() == parts_.size() && contacts.size() == parts_.size(),
                "one pose and one contact a part");
  if (frames_++ == 0) first_time_s_ = last_time_s_ = time_s;
  const double lasted_s = time_s - last_time_s_;
  for (core::PartIndex i = 0; i < parts_.size(); ++i) {
    PartHeat& heat = parts_[i];
    for (const TouchedPatch& touched : heat.touched) heat.dwell_s[touched.patch] += lasted_s;
    const bool is_unchanged = hull_ == hull && heat.world_from_part == world_from_parts[i];
    heat.world_from_part = world_from_parts[i];
    if (contacts[i].verdict != core::Verdict::kContact) {
      heat.touched.clear();
      continue;
    }
    if (is_unchanged && !heat.touched.empty()) continue;
    if (!heat.patches) {
      heat.patches =
          std::make_shared<const core::SurfacePatches>(trees_[i].shared_mesh(), core::kHeatPatchMm);
      heat.dwell_s.assign(heat.patches->size(), 0.0);
      heat.peak_depth_mm.assign(heat.patches->size(), 0.0);
    }
    heat.touched = FindTouchedPatches(*hull, trees_[i], world_from_parts[i], *heat.patches, contacts[i]);
    for (const TouchedPatch& touched : heat.touched) {
      double& peak_mm = heat.peak_depth_mm[touched.patch];
      peak_mm = std::max(peak_mm, touched.depth_mm);
    }
  }
  hull_ = hull;
  last_time_s_ = time_s;
}

core::HeatMap ContactHeat::MapOf(const PartHeat& heat, core::PartIndex part, double last_frame_s) {
  core::HeatMap map;
  map.part = part;
  std::vector<double> dwell_s = heat.dwell_s;
  for (const TouchedPatch& touched : heat.touched) dwell_s[touched.patch] += last_frame_s;
  const auto narrowed = [](const std::vector<double>& values) {
    std::vector<float> floats;
    floats.reserve(values.size());
    for (const double value : values) floats.push_back(static_cast<float>(value));
    return floats;
  };
  map.dwell_s = narrowed(dwell_s);
  map.peak_depth_mm = narrowed(heat.peak_depth_mm);
  return map;
}

std::vector<core::HeatMap> ContactHeat::Maps() const {
  const double last_frame_s =
      frames_ > 1 ? (last_time_s_ - first_time_s_) / static_cast<double>(frames_ - 1) : 0.0;
  std::vector<core::HeatMap> maps;
  for (core::PartIndex i = 0; i < parts_.size(); ++i) {
    if (parts_[i].patches) maps.push_back(MapOf(parts_[i], i, last_frame_s));
  }
  return maps;
}

}  // namespace elbowroom::review
