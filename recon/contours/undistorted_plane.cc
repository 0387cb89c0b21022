#include "recon/contours/undistorted_plane.h"

#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "recon/contours/contour.h"
#include "recon/contours/contour_map.h"
#include "recon/contours/node_table_kernel.h"

namespace elbowroom::recon {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Cubic interpolation between nodes this far apart is exact enough for ordinary lenses. The step is halved
// until it is so for this one. In cells where even the narrowest step isn't, the table isn't used.
constexpr int kWidestStepPx = 16;
constexpr int kNarrowestStepPx = 4;
constexpr double kTableErrorPx = 5e-6;

}  // namespace

UndistortedPlane::UndistortedPlane(const core::CameraModel& camera) : camera_(camera) {
  const core::CameraCalibration& calibration = camera_.calibration();
  const Eigen::Matrix2d scale = calibration.camera_matrix.topLeftCorner<2, 2>();
  focal_px_ = std::max(scale(0, 0), scale(1, 1));
  is_ideal_ = camera_.is_ideal();
  principal_px_ = calibration.camera_matrix.topRightCorner<2, 1>();
  plane_from_pixel_ = focal_px_ * scale.inverse();
  if (is_ideal_) return;
  for (int step_px = kWidestStepPx;; step_px /= 2) {
    FillTable(step_px);
    FindBentCells();
    if (step_px == kNarrowestStepPx || bent_cells_.CountObjectPixels() == 0) break;
  }
  const bool is_whole =
      std::none_of(table_.begin(), table_.end(), [](const Eigen::Vector2d& p) { return std::isnan(p.x()); });
  if (is_whole) return;
  core::BitMask unseen = FindUnseenPixels();
  if (unseen.CountObjectPixels() > 0) unseen_pixels_ = std::move(unseen);
}

UndistortedPlane::~UndistortedPlane() = default;

const ContourMap& UndistortedPlane::outline() const {
  std::call_once(once_, [this] {
    core::SoftMask all{core::BitMask(camera_.width_px(), camera_.height_px()), {}};
    for (int y = 0; y < camera_.height_px(); ++y)
      for (int x = 0; x < camera_.width_px(); ++x) all.mask.Set(x, y, true);
    outline_ = std::make_unique<const ContourMap>(TraceContour(all, false, *this), false);
  });
  return *outline_;
}

std::optional<Eigen::Vector2d> UndistortedPlane::Exactly(const Eigen::Vector2d& pixel,
                                                         const Eigen::Vector2d& nearby) const {
  const std::optional<Eigen::Vector2d> normalised =
      std::isnan(nearby.x()) ? camera_.NormalisedFromPixel(pixel)
                             : camera_.NormalisedFromPixel(pixel, nearby / focal_px_);
  if (!normalised) return std::nullopt;
  return *normalised * focal_px_;
}

void UndistortedPlane::FillTable(int step_px) {
  const Eigen::Vector2i size(camera_.width_px(), camera_.height_px());
  // At least the four nodes of one cubic; the outermost stand on the picture's border.
  const Eigen::Vector2i nodes = ((size.array() + step_px - 1) / step_px + 1).max(4);
  const Eigen::Vector2d pixels_per_node = size.cast<double>().array() / (nodes.array() - 1).cast<double>();
  std::vector<Eigen::Vector2d> table;
  table.reserve(static_cast<std::size_t>(nodes.x()) * static_cast<std::size_t>(nodes.y()));
  for (int y = 0; y < nodes.y(); ++y) {
    Eigen::Vector2d last = Eigen::Vector2d::Constant(kNaN);
    for (int x = 0; x < nodes.x(); ++x) {
      const Eigen::Vector2d pixel =
          Eigen::Vector2d(x, y).cwiseProduct(pixels_per_node) - Eigen::Vector2d::Constant(0.5);
      // The solver starts from the coarser table, which is hardly off, or without one from the last node.
      Eigen::Vector2d nearby = table_.empty() ? last : FromTable(NodesAt(pixel));
      if (std::isnan(nearby.x())) nearby = last;
      const std::optional<Eigen::Vector2d> exact = Exactly(pixel, nearby);
      if (exact) last = *exact;
      table.push_back(exact.value_or(Eigen::Vector2d::Constant(kNaN)));
    }
  }
  nodes_ = nodes;
  nodes_per_pixel_ = pixels_per_node.cwiseInverse();
  pixels_per_node_ = pixels_per_node;
  table_ = std::move(table);
}

Eigen::Vector2d UndistortedPlane::NodesAt(const Eigen::Vector2d& pixel) const {
  return (pixel + Eigen::Vector2d::Constant(0.5)).cwiseProduct(nodes_per_pixel_);
}

NodeTable UndistortedPlane::Table() const { return {table_.data(), nodes_.x(), nodes_.y()}; }

Eigen::Vector2d UndistortedPlane::FromTable(const Eigen::Vector2d& at_nodes) const {
  Eigen::Vector2d found;
  InterpolateNodes(Table(), {&at_nodes, 1}, &found);
  return found;
}

void UndistortedPlane::FindBentCells() {
  bent_cells_ = core::BitMask(nodes_.x() - 1, nodes_.y() - 1);
  for (int y = 0; y + 1 < nodes_.y(); ++y) {
    for (int x = 0; x + 1 < nodes_.x(); ++x) {
      const Eigen::Vector2d pixel =
          Eigen::Vector2d(x + 0.5, y + 0.5).cwiseProduct(pixels_per_node_) - Eigen::Vector2d::Constant(0.5);
      const Eigen::Vector2d found = FromTable(NodesAt(pixel));
      if (std::isnan(found.x())) continue;
      const std::optional<Eigen::Vector2d> exact = Exactly(pixel, found);
      if (exact && (*exact - found).norm() <= kTableErrorPx) continue;
      // Its neighbours too: where a lens is about to fold, the error grows fast.
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, nodes_.y() - 2); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, nodes_.x() - 2); ++u)
          bent_cells_.Set(u, v, true);
    }
  }
}

core::BitMask UndistortedPlane::FindUnseenPixels() const {
  // In cells where the cubic is used, all pixels are seen; each pixel of the other cells is looked at.
  core::BitMask doubtful(nodes_.x() - 1, nodes_.y() - 1);
  for (int y = 0; y + 1 < nodes_.y(); ++y) {
    for (int x = 0; x + 1 < nodes_.x(); ++x)
      doubtful.Set(x, y, bent_cells_.At(x, y) || std::isnan(FromTable({x + 0.5, y + 0.5}).x()));
  }
  core::BitMask unseen(camera_.width_px(), camera_.height_px());
  for (int y = 0; y < camera_.height_px(); ++y) {
    for (int x = 0; x < camera_.width_px(); ++x) {
      const Eigen::Vector2i cell = CellOf(NodesAt({x, y}));
      if (doubtful.At(cell.x(), cell.y())) unseen.Set(x, y, !FromPixel({x, y}));
    }
  }
  return unseen;
}

Eigen::Vector2i UndistortedPlane::CellOf(const Eigen::Vector2d& at_nodes) const {
  return {std::clamp(static_cast<int>(at_nodes.x()), 0, nodes_.x() - 2),
          std::clamp(static_cast<int>(at_nodes.y()), 0, nodes_.y() - 2)};
}

std::optional<Eigen::Vector2d> UndistortedPlane::FromPixel(const Eigen::Vector2d& pixel) const {
  Eigen::Vector2d position;
  FromPixels({&pixel, 1}, &position);
  if (std::isnan(position.x())) return std::nullopt;
  return position;
}

void UndistortedPlane::FromPixels(std::span<const Eigen::Vector2d> pixels, Eigen::Vector2d* positions) const {
  if (is_ideal_) {
    for (const Eigen::Vector2d& pixel : pixels) *positions++ = plane_from_pixel_ * (pixel - principal_px_);
    return;
  }
  constexpr std::size_t kAtOnce = 64;
  std::array<Eigen::Vector2d, kAtOnce> places;
  for (; !pixels.empty(); pixels = pixels.subspan(std::min(kAtOnce, pixels.size()))) {
    const std::size_t count = std::min(kAtOnce, pixels.size());
    for (std::size_t i = 0; i < count; ++i) places[i] = NodesAt(pixels[i]);
    InterpolateNodes(Table(), {places.data(), count}, positions);
    for (std::size_t i = 0; i < count; ++i, ++positions) {
      const Eigen::Vector2i cell = CellOf(places[i]);
      if (!std::isnan(positions->x()) && !bent_cells_.At(cell.x(), cell.y())) continue;
      *positions = Exactly(pixels[i], *positions).value_or(Eigen::Vector2d::Constant(kNaN));
    }
  }
}

UndistortedPlanes MakeUndistortedPlanes(const core::Rig& rig) {
  UndistortedPlanes planes(rig.cameras.size());
  tbb::parallel_for(std::size_t{0}, planes.size(), [&](std::size_t i) {
    planes[i] = std::make_shared<const UndistortedPlane>(rig.cameras[i]);
  });
  return planes;
}

}  // namespace elbowroom::recon
