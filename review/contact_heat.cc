#include "review/contact_heat.h"

#include <algorithm>
#include <span>

#include "core/error.h"
#include "core/part_distance.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using recon::BallAnswer;

// The middles of fewer patches are asked one by one: a ball that holds them costs as much.
constexpr std::size_t kPatchesWithoutBall = 4;

// Goes down the part's tree, and down the halves of its triangles, to the patches that the hull may reach.
class PatchSearch {
 public:
  PatchSearch(const recon::VisualHull& hull, const core::TriangleTree& part,
              const core::RigidTransform& world_from_part, const core::SurfacePatches& patches,
              std::span<const double> known_mm)
      : hull_(hull), part_(part), world_from_part_(world_from_part), patches_(patches), known_mm_(known_mm) {}

  // The patches are found in order of number but for those of the contact's points.
  void Search() {
    VisitNode(0, {});
    std::ranges::sort(triangles_, {}, &Triangle::index);
    for (const Triangle& triangle : triangles_) VisitPiece(patches_.PieceOf(triangle.index), triangle.open);
  }

  void TouchPoint(std::size_t patch, const Vector3d& x_in_world) {
    if (hull_.Contains(x_in_world, {})) of_points_.push_back({patch, DepthMm(patch, x_in_world)});
  }

  [[nodiscard]] std::vector<TouchedPatch> TakeTouched() const {
    std::vector<TouchedPatch> touched = of_middles_;
    touched.insert(touched.end(), of_points_.begin(), of_points_.end());
    const auto points = touched.begin() + static_cast<std::ptrdiff_t>(of_middles_.size());
    const auto deepest_first = [](const TouchedPatch& p, const TouchedPatch& q) {
      return p.patch != q.patch ? p.patch < q.patch : p.depth_mm > q.depth_mm;
    };
    std::sort(points, touched.end(), deepest_first);
    std::inplace_merge(touched.begin(), points, touched.end(), deepest_first);
    const auto twice = std::ranges::unique(touched, {}, &TouchedPatch::patch);
    touched.erase(twice.begin(), twice.end());
    return touched;
  }

 private:
  struct Triangle {
    std::uint32_t index = 0;
    recon::UndecidedCameras open;
  };

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
    for (std::uint32_t i = node.begin; i < node.end; ++i) triangles_.push_back({part_.order()[i], open});
  }

  void VisitPiece(const core::SurfacePatches::Piece& piece, recon::UndecidedCameras open) {
    if (piece.is_patch()) {
      const Vector3d middle = world_from_part_ * piece.corners.Centre();
      if (hull_.Contains(middle, open)) TouchMiddle(piece.first, middle);
      return;
    }
    if (piece.end - piece.first >= kPatchesWithoutBall) {
      const core::Ball ball = core::BallOf(piece.corners.a, piece.corners.b, piece.corners.c);
      const BallAnswer answer = hull_.Classify(world_from_part_ * ball.center, ball.radius_mm, &open);
      if (answer == BallAnswer::kOutside) return;
      if (answer == BallAnswer::kInside) return TouchAll(piece);
    }
    for (const core::SurfacePatches::Piece& half : patches_.HalvesOf(piece)) VisitPiece(half, open);
  }

  void TouchAll(const core::SurfacePatches::Piece& piece) {
    if (piece.is_patch()) return TouchMiddle(piece.first, world_from_part_ * piece.corners.Centre());
    for (const core::SurfacePatches::Piece& half : patches_.HalvesOf(piece)) TouchAll(half);
  }

  void TouchMiddle(std::size_t patch, const Vector3d& x_in_world) {
    of_middles_.push_back({patch, DepthMm(patch, x_in_world)});
  }

  // Of a point in the hull.
  [[nodiscard]] double DepthMm(std::size_t patch, const Vector3d& x_in_world) {
    const bool is_known = !known_mm_.empty() && !hull_.MayBeDeeper(x_in_world, known_mm_[patch], &likely_);
    return is_known ? 0.0 : hull_.Probe(x_in_world).radius_mm;
  }

  const recon::VisualHull& hull_;
  const core::TriangleTree& part_;
  const core::RigidTransform& world_from_part_;
  const core::SurfacePatches& patches_;
  std::span<const double> known_mm_;
  core::CameraIndex likely_ = 0;
  std::vector<Triangle> triangles_;
  std::vector<TouchedPatch> of_middles_;  // in order of number
  std::vector<TouchedPatch> of_points_;
};

}  // namespace

std::vector<TouchedPatch> FindTouchedPatches(const recon::VisualHull& hull, const core::TriangleTree& part,
                                             const core::RigidTransform& world_from_part,
                                             const core::SurfacePatches& patches,
                                             const core::PartContact& contact,
                                             std::span<const double> known_mm) {
  core::Require(known_mm.empty() || known_mm.size() == patches.size(),
                "a known depth for each patch, or none");
  if (part.nodes().empty() || hull.IsEmpty()) return {};
  PatchSearch search(hull, part, world_from_part, patches, known_mm);
  search.Search();
  const core::RigidTransform part_from_world = world_from_part.Inverse();
  const auto touch_point = [&](const core::ContactPoint& point) {
    const Vector3d x_in_part = part_from_world * point.position_in_world_mm;
    const std::uint32_t triangle = FindNearest(part, {.center = x_in_part}).triangle;
    search.TouchPoint(patches.PatchAt(triangle, x_in_part), point.position_in_world_mm);
  };
  for (const core::ContactPoint& point : contact.points) touch_point(point);
  if (contact.deepest) touch_point(*contact.deepest);
  return search.TakeTouched();
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
    const bool was_touched = !heat.touched.empty();
    if (was_touched || contacts[i].verdict == core::Verdict::kContact) ++heat.changes;
    const bool is_unchanged = hull_ == hull && heat.world_from_part == world_from_parts[i];
    heat.world_from_part = world_from_parts[i];
    if (contacts[i].verdict != core::Verdict::kContact) {
      heat.touched.clear();
      continue;
    }
    if (is_unchanged && was_touched) continue;
    if (!heat.patches) {
      heat.patches =
          std::make_shared<const core::SurfacePatches>(trees_[i].shared_mesh(), core::kHeatPatchMm);
      heat.dwell_s.assign(heat.patches->size(), 0.0);
      heat.peak_depth_mm.assign(heat.patches->size(), 0.0);
    }
    heat.touched = FindTouchedPatches(*hull, trees_[i], world_from_parts[i], *heat.patches, contacts[i],
                                      heat.peak_depth_mm);
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

double ContactHeat::LastFrameS() const {
  return frames_ > 1 ? (last_time_s_ - first_time_s_) / static_cast<double>(frames_ - 1) : 0.0;
}

core::HeatMap ContactHeat::MapOf(core::PartIndex part) const {
  core::Require(parts_[part].patches != nullptr, "the map of a part that was touched");
  return MapOf(parts_[part], part, LastFrameS());
}

std::vector<core::HeatMap> ContactHeat::Maps() const {
  const double last_frame_s = LastFrameS();
  std::vector<core::HeatMap> maps;
  for (core::PartIndex i = 0; i < parts_.size(); ++i) {
    if (parts_[i].patches) maps.push_back(MapOf(parts_[i], i, last_frame_s));
  }
  return maps;
}

}  // namespace elbowroom::review
