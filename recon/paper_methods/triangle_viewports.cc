#include "recon/paper_methods/triangle_viewports.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <tuple>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr int kMostPx = 400;
constexpr int kSixteenths = 16;
constexpr double kEighths = 8.0;

// A side of the triangle as base, lying from `p` to `q` below `apex`.
struct Based {
  Vector3d p, q, apex;
  double foot = 0.0;  // of the apex on the base, a share of it
  double step_mm = 0.0;
};

// Nothing where the apex doesn't stand above the side, by more than the viewport rounds it anyway.
std::optional<Based> OnBase(const Vector3d& p, const Vector3d& q, const Vector3d& apex,
                            const TriangleViewportOptions& options) {
  const Vector3d base = q - p, side = apex - p;
  const double length_mm = base.norm();
  if (!(length_mm > 0.0)) return std::nullopt;
  const double foot = side.dot(base) / (length_mm * length_mm);
  const double tolerance = 1.0 / (kSixteenths * options.width_px);
  if (!(foot >= -tolerance && foot <= 1.0 + tolerance)) return std::nullopt;  // nor where squares underflow
  const double height_mm = side.cross(base).norm() / length_mm;
  return Based{p, q, apex, foot, std::max(length_mm / options.width_px, height_mm / options.height_px)};
}

Based BestBase(const std::array<Vector3d, 3>& corners_mm, const TriangleViewportOptions& options) {
  std::optional<Based> best;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto based = OnBase(corners_mm[i], corners_mm[(i + 1) % 3], corners_mm[(i + 2) % 3], options);
    if (based && (!best || based->step_mm < best->step_mm)) best = based;
  }
  // Without any extent there is no side to stand on.
  return best.value_or(Based{corners_mm[0], corners_mm[1], corners_mm[2], 0.0, 0.0});
}

auto KeyOf(const ViewportContact& contact) {
  return std::tuple(contact.triangle, contact.row, contact.column);
}

}  // namespace

void TriangleViewportOptions::Validate() const {
  core::Require(width_px >= 2 && width_px <= kMostPx, "a triangle's viewport is 2 to 400 pixels wide");
  core::Require(height_px >= 2 && height_px <= kMostPx, "a triangle's viewport is 2 to 400 pixels high");
}

TriangleViewport::TriangleViewport(const std::array<Vector3d, 3>& corners_mm,
                                   const TriangleViewportOptions& options)
    : width_px_(options.width_px), height_px_(options.height_px) {
  const Based based = BestBase(corners_mm, options);
  const double eighths = based.foot * options.width_px * kEighths;
  apex_sixteenths_ =
      2 * static_cast<int>(std::clamp(std::floor(eighths), 0.0, kEighths * options.width_px - 1.0)) + 1;
  origin_mm_ = based.p;
  along_x_mm_ = (based.q - based.p) / options.width_px;
  along_y_mm_ = (based.apex - based.p - apex_x_px() * along_x_mm_) / options.height_px;
  step_mm_ = based.step_mm;
}

// In sixteenths: an odd number against even ones, so that no centre is on an edge and rounding down is exact.
TriangleViewport::Columns TriangleViewport::ColumnsOf(int row) const {
  const int y = kSixteenths * row + kSixteenths / 2;
  const int width = kSixteenths * width_px_, height = kSixteenths * height_px_;
  const int left = apex_sixteenths_ * y, right = width * height - (width - apex_sixteenths_) * y;
  const int half = height * kSixteenths / 2;
  return {(left + half) / (2 * half), (right + half) / (2 * half)};
}

std::vector<TriangleViewport> MakeViewports(const core::TriangleMesh& part,
                                            const core::RigidTransform& world_from_part,
                                            const TriangleViewportOptions& options) {
  options.Validate();
  std::vector<TriangleViewport> viewports;
  viewports.reserve(part.triangles.size());
  for (const auto& triangle : part.triangles) {
    std::array<Vector3d, 3> corners_mm;
    for (std::size_t i = 0; i < 3; ++i)
      corners_mm[i] = world_from_part * part.vertices_mm[static_cast<std::size_t>(triangle[i])];
    viewports.emplace_back(corners_mm, options);
  }
  return viewports;
}

SampledContacts CountSamples(std::span<const TriangleViewport> viewports, std::size_t cameras,
                             const TriangleViewportOptions& options) {
  SampledContacts result;
  for (const TriangleViewport& viewport : viewports) {
    for (int row = 0; row < options.height_px; ++row) {
      const TriangleViewport::Columns columns = viewport.ColumnsOf(row);
      result.samples += columns.end - columns.begin;
    }
    result.coarsest_step_mm = std::max(result.coarsest_step_mm, viewport.StepMm());
  }
  result.work.triangles = static_cast<std::int64_t>(cameras * viewports.size());
  result.work.pixels = static_cast<std::int64_t>(cameras) * result.samples;
  return result;
}

SampledContacts SampleTriangles(const CoverageHull& hull, const core::TriangleMesh& part,
                                const core::RigidTransform& world_from_part,
                                const TriangleViewportOptions& options) {
  const std::vector<TriangleViewport> viewports = MakeViewports(part, world_from_part, options);
  std::vector<std::vector<ViewportContact>> found(viewports.size());
  tbb::parallel_for(std::size_t{0}, viewports.size(), [&](std::size_t i) {
    for (int row = 0; row < options.height_px; ++row) {
      const TriangleViewport::Columns columns = viewports[i].ColumnsOf(row);
      for (int column = columns.begin; column < columns.end; ++column) {
        const Vector3d x_in_world = viewports[i].PositionOf(column, row);
        if (hull.Contains(x_in_world))
          found[i].push_back({static_cast<std::uint32_t>(i), column, row, x_in_world});
      }
    }
  });
  SampledContacts result = CountSamples(viewports, hull.cameras().size(), options);
  for (const auto& of_triangle : found)
    result.contacts.insert(result.contacts.end(), of_triangle.begin(), of_triangle.end());
  return result;
}

SampleComparison CompareSamples(const CoverageHull& hull, const SampledContacts& a,
                                const SampledContacts& b) {
  std::vector<ViewportContact> differing;
  const auto is_before = [](const ViewportContact& x, const ViewportContact& y) {
    return KeyOf(x) < KeyOf(y);
  };
  std::set_symmetric_difference(a.contacts.begin(), a.contacts.end(), b.contacts.begin(), b.contacts.end(),
                                std::back_inserter(differing), is_before);
  SampleComparison comparison;
  comparison.differing_samples = static_cast<std::int64_t>(differing.size());
  comparison.unexplained_samples = std::count_if(
      differing.begin(), differing.end(),
      [&](const ViewportContact& contact) { return !hull.IsMatterOfRounding(contact.position_in_world_mm); });
  return comparison;
}

}  // namespace elbowroom::recon
