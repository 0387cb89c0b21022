#include "recon/hull_mesh/point_labels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace elbowroom::recon {
namespace {

static_assert(std::endian::native == std::endian::little, "bit i of a group's byte is bit i of its word");

// Points that wait for their labels, and their bits. Once there are enough, they are labelled together.
class Waiting {
 public:
  Waiting(const GridView& grid, const ContourCellsView& cells, const GridPoint& corner, BlockBits* bits)
      : grid_(grid),
        cells_(cells),
        corner_{double(corner.x()), double(corner.y()), double(corner.z())},
        bits_(*bits) {}

  void Add(std::size_t bit) {
    const std::array<std::uint8_t, 3>& in_block = BlockBits::kPoints[bit];
    for (std::size_t axis = 0; axis < 3; ++axis)
      points_.at[axis][points_.count] = corner_[axis] + in_block[axis];
    bits_of_points_[points_.count] = static_cast<std::uint16_t>(bit);
    if (++points_.count == GridPoints::kMost) Settle();
  }

  void Settle() {
    const std::uint64_t object = LabelPoints(grid_, cells_, points_);
    const std::uint64_t all =
        points_.count == 0 ? 0 : ~std::uint64_t{0} >> (GridPoints::kMost - points_.count);
    for (std::uint64_t outside = all & ~object; outside != 0; outside &= outside - 1) {
      const unsigned bit = bits_of_points_[static_cast<std::size_t>(std::countr_zero(outside))];
      bits_.groups[bit / 8] = static_cast<std::uint8_t>(bits_.groups[bit / 8] & ~(1U << bit % 8));
    }
    points_.count = 0;
  }

 private:
  const GridView& grid_;
  const ContourCellsView& cells_;
  const std::array<double, 3> corner_;
  BlockBits& bits_;
  GridPoints points_;
  std::array<std::uint16_t, GridPoints::kMost> bits_of_points_;
};

// Calls visit(bit) for the bits that both have.
template <typename Visit>
void VisitCommon(const BlockBits& a, const BlockBits& b, const Visit& visit) {
  constexpr std::size_t kWordGroups = sizeof(std::uint64_t);
  for (std::size_t group = 0; group < a.groups.size(); group += kWordGroups) {
    const std::size_t size = std::min(kWordGroups, a.groups.size() - group);
    std::uint64_t in_a = 0, in_b = 0;
    std::memcpy(&in_a, &a.groups[group], size);
    std::memcpy(&in_b, &b.groups[group], size);
    for (std::uint64_t left = in_a & in_b; left != 0; left &= left - 1)
      visit(8 * group + static_cast<std::size_t>(std::countr_zero(left)));
  }
}

}  // namespace

GridView ViewGrid(const core::CameraModel& camera, double focal_px, const HullGrid& grid) {
  const Eigen::Vector3d scale(focal_px, focal_px, 1.0);
  const core::RigidTransform& cam_from_world = camera.cam_from_world();
  const Eigen::Vector3d origin = scale.cwiseProduct(cam_from_world * grid.origin_in_world);
  const Eigen::Matrix3d steps = scale.asDiagonal() * cam_from_world.rotation * grid.edge_mm;
  GridView view;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    view.origin[i] = origin[row];
    for (std::size_t axis = 0; axis < 3; ++axis)
      view.steps[axis][i] = steps(row, static_cast<Eigen::Index>(axis));
  }
  return view;
}

void SettleMixed(const GridView& grid, const ContourCellsView& cells, const GridPoint& corner,
                 const BlockBits& mixed, BlockBits* bits) {
  Waiting waiting(grid, cells, corner, bits);
  VisitCommon(mixed, BlockBits(*bits), [&](std::size_t bit) { waiting.Add(bit); });
  waiting.Settle();
}

}  // namespace elbowroom::recon
