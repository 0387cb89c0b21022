#include "recon/block_surface.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "recon/camera_query.h"
#include "recon/cube_table.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr int kPoints = kBlockCells + 1;  // grid points on a side
constexpr int kPairs = kBlockCells / 2;
constexpr int kBisections = 40;
// Vertices keep this share of an edge away from its ends, so that no two of them fall together: in float32
// too, while the workspace is less than some 8000 edges long.
constexpr double kEndShare = 1.0 / 2048;

class Cutter {
 public:
  Cutter(const VisualHull& hull, const HullGrid& grid, const HullBlock& block)
      : hull_(hull), grid_(grid), block_(block) {
    labels_.fill(kUnknown);
    for (auto& vertices : vertices_) vertices.fill(-1);
  }

  BlockSurface Cut() {
    for (std::size_t i = 0; i < block_.mixed.size(); ++i) {
      if (!block_.mixed[i]) continue;
      const auto pair = static_cast<int>(i);
      const GridPoint corner(pair % kPairs * 2, pair / kPairs % kPairs * 2, pair / (kPairs * kPairs) * 2);
      for (int cell = 0; cell < 8; ++cell) CutCell(corner + CornerOffset(cell));
    }
    return std::move(surface_);
  }

 private:
  static constexpr std::uint8_t kUnknown = 2;

  static GridPoint CornerOffset(int corner) { return {corner & 1, (corner >> 1) & 1, corner >> 2}; }
  static std::size_t Index(const GridPoint& p) {
    return static_cast<std::size_t>(p.x() + kPoints * (p.y() + kPoints * p.z()));
  }

  void CutCell(const GridPoint& cell) {
    if (((block_.corner + cell).array() >= grid_.cells.array()).any()) return;
    ++surface_.cells;
    unsigned inside = 0;
    for (int corner = 0; corner < 8; ++corner)
      inside |= static_cast<unsigned>(IsInside(cell + CornerOffset(corner))) << static_cast<unsigned>(corner);
    for (const std::array<std::uint8_t, 3>& triangle : CubeTable()[inside])
      surface_.triangles.push_back(
          {VertexOn(cell, triangle[0]), VertexOn(cell, triangle[1]), VertexOn(cell, triangle[2])});
  }

  bool IsInside(const GridPoint& p) {
    std::uint8_t& label = labels_[Index(p)];
    if (label == kUnknown) label = ContainsAt(grid_.At(block_.corner + p)) ? 1 : 0;
    return label != 0;
  }

  // VisualHull::Contains, of a point in the block.
  bool ContainsAt(const Vector3d& x) {
    ++surface_.queries;
    if (!block_.is_in_workspace && !hull_.rig().workspace_mm.contains(x)) return false;
    for (const std::uint8_t i : block_.cameras) {
      const Silhouette& silhouette = *hull_.silhouettes()[i];
      if (!IsObjectTo(hull_.rig().cameras[i], silhouette.plane().focal_px(), silhouette.labels(), x))
        return false;
    }
    return block_.is_seen || IsSeen(x);
  }

  [[nodiscard]] bool IsSeen(const Vector3d& x) const {
    for (std::size_t i = 0; i < hull_.silhouettes().size(); ++i) {
      const PicturePlane& plane = hull_.silhouettes()[i]->plane();
      if (IsObjectTo(hull_.rig().cameras[i], plane.focal_px(), plane.outline(), x)) return true;
    }
    return false;
  }

  std::int32_t VertexOn(const GridPoint& cell, std::size_t cube_edge) {
    const int axis = static_cast<int>(cube_edge / 4);
    const GridPoint low = cell + CornerOffset(kCubeEdges[cube_edge].low);
    std::int32_t& vertex = vertices_[static_cast<std::size_t>(axis)][Index(low)];
    if (vertex >= 0) return vertex;
    const GridPoint high = low + GridPoint(GridPoint::Unit(axis));
    vertex = static_cast<std::int32_t>(surface_.vertices_in_world.size());
    const bool low_is_inside = IsInside(low);
    surface_.vertices_in_world.push_back(Crossing(grid_.At(block_.corner + (low_is_inside ? low : high)),
                                                  grid_.At(block_.corner + (low_is_inside ? high : low))));
    bool is_shared = false;
    for (int other = 0; other < 3; ++other)
      is_shared = is_shared || (other != axis && (low[other] == 0 || low[other] == kBlockCells));
    surface_.shared_edges.push_back(is_shared ? EdgeKey(block_.corner + low, axis) : 0);
    return vertex;
  }

  Vector3d Crossing(const Vector3d& inside, const Vector3d& outside) {
    ++surface_.queries;
    const std::optional<double> exact = block_.is_seen ? FirstExit(inside, outside) : std::nullopt;
    const double share = exact ? *exact : BisectedExit(inside, outside);
    return inside + std::clamp(share, kEndShare, 1.0 - kEndShare) * (outside - inside);
  }

  // Share of the way where the first camera sees the hull end, or the workspace does.
  [[nodiscard]] std::optional<double> FirstExit(const Vector3d& inside, const Vector3d& outside) const {
    std::optional<double> first;
    const auto offer = [&](double share) { first = std::min(first.value_or(share), share); };
    if (!block_.is_in_workspace) {
      const Eigen::AlignedBox3d& box = hull_.rig().workspace_mm;
      for (int axis = 0; axis < 3; ++axis) {
        const double way = outside[axis] - inside[axis];
        if (outside[axis] > box.max()[axis]) offer((box.max()[axis] - inside[axis]) / way);
        if (outside[axis] < box.min()[axis]) offer((box.min()[axis] - inside[axis]) / way);
      }
    }
    for (const std::uint8_t i : block_.cameras) {
      const core::RigidTransform& cam_from_world = hull_.rig().cameras[i].cam_from_world();
      const Vector3d from = cam_from_world * inside, to = cam_from_world * outside;
      if (!(from.z() > 0.0) || !(to.z() > 0.0)) return std::nullopt;
      const double focal_px = hull_.silhouettes()[i]->plane().focal_px();
      const std::optional<double> in_picture = hull_.silhouettes()[i]->labels().FirstCrossing(
          from.head<2>() * (focal_px / from.z()), to.head<2>() * (focal_px / to.z()));
      // From a share of the way in the picture to one of the way in space.
      if (in_picture) offer(*in_picture * from.z() / (to.z() + *in_picture * (from.z() - to.z())));
    }
    return first;
  }

  double BisectedExit(const Vector3d& inside, const Vector3d& outside) {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (ContainsAt(inside + middle * (outside - inside)) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  const VisualHull& hull_;
  const HullGrid& grid_;
  const HullBlock& block_;
  std::array<std::uint8_t, kPoints * kPoints * kPoints> labels_;
  std::array<std::array<std::int32_t, kPoints * kPoints * kPoints>, 3> vertices_;  // by axis and lower end
  BlockSurface surface_;
};

}  // namespace

std::uint64_t EdgeKey(const GridPoint& low, int axis) {
  return (static_cast<std::uint64_t>(axis + 1) << 60U) | (static_cast<std::uint64_t>(low.z()) << 40U) |
         (static_cast<std::uint64_t>(low.y()) << 20U) | static_cast<std::uint64_t>(low.x());
}

BlockSurface CutBlock(const VisualHull& hull, const HullGrid& grid, const HullBlock& block) {
  return Cutter(hull, grid, block).Cut();
}

}  // namespace elbowroom::recon
