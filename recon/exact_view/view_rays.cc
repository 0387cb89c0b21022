#include "recon/exact_view/view_rays.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/error.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/exact_view/tile_cast.h"

namespace elbowroom::recon {
namespace {

constexpr int kBoxPx = 8;

}  // namespace

ViewRays::ViewRays(const core::CameraModel& view, Projection projection)
    : projection_(projection),
      width_px_(view.width_px()),
      height_px_(view.height_px()),
      view_from_world_(view.cam_from_world()) {
  if (projection == Projection::kOrthographic && !view.is_ideal()) {
    throw core::Error(
        core::ErrorKind::kCamera,
        fmt::format("camera '{}': an orthographic view has no lens; leave out its distortion", view.name()));
  }
  const Eigen::Matrix3d& matrix = view.calibration().camera_matrix;
  uv_from_pixel_ = matrix.topLeftCorner<2, 2>().inverse();
  uv_of_origin_ = -uv_from_pixel_ * matrix.topRightCorner<2, 1>();
  if (!view.is_ideal()) lens_ = LensOf(view);
}

ViewRays ViewRays::From(const core::RigidTransform& view_from_world) const {
  ViewRays rays = *this;
  rays.view_from_world_ = view_from_world;
  return rays;
}

ViewRays ViewRays::Within(std::vector<HalfSpace> half_spaces) const {
  ViewRays rays = *this;
  rays.half_spaces_ = std::move(half_spaces);
  return rays;
}

bool ViewRays::HasSameRays(const ViewRays& other) const {
  return projection_ == other.projection_ && width_px_ == other.width_px_ && height_px_ == other.height_px_ &&
         uv_from_pixel_ == other.uv_from_pixel_ && uv_of_origin_ == other.uv_of_origin_ &&
         lens_ == other.lens_;
}

void ViewRays::FillTile(int x, int y, float* u, float* v) const {
  const bool is_whole = x + kTilePx <= width_px_ && y + kTilePx <= height_px_;
  if (is_whole && lens_ == nullptr) {
    using Row = Eigen::Array<double, kTilePx, 1>;
    const Row columns = Row::LinSpaced(x, x + kTilePx - 1);
    const Eigen::Matrix2d& m = uv_from_pixel_;
    const Row u_of_columns = m(0, 0) * columns, v_of_columns = m(1, 0) * columns;
    for (int row = 0; row < kTilePx; ++row) {
      const double u_of_row = m(0, 1) * (y + row), v_of_row = m(1, 1) * (y + row);
      Eigen::Map<Eigen::Array<float, kTilePx, 1>>(u + row * kTilePx) =
          (u_of_columns + u_of_row + uv_of_origin_.x()).cast<float>();
      Eigen::Map<Eigen::Array<float, kTilePx, 1>>(v + row * kTilePx) =
          (v_of_columns + v_of_row + uv_of_origin_.y()).cast<float>();
    }
    return;
  }
  for (int i = 0; i < kTileRays; ++i) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    const int at_x = x + i % kTilePx, at_y = y + i / kTilePx;
    const bool is_pixel = at_x < width_px_ && at_y < height_px_;
    const Eigen::Vector2d uv = is_pixel ? At(at_x, at_y) : Eigen::Vector2d(kNaN, kNaN);
    u[i] = static_cast<float>(uv.x());
    v[i] = static_cast<float>(uv.y());
  }
}

std::shared_ptr<const ViewRays::Lens> ViewRays::LensOf(const core::CameraModel& view) {
  const UndistortedPlane plane(view);
  const auto width = static_cast<std::size_t>(view.width_px());
  const int tiles_across = (view.width_px() + kBoxPx - 1) / kBoxPx;
  const int tiles_down = (view.height_px() + kBoxPx - 1) / kBoxPx;
  auto lens = std::make_shared<Lens>();
  lens->by_pixel.resize(width * static_cast<std::size_t>(view.height_px()));
  lens->tile_boxes.resize(static_cast<std::size_t>(tiles_across) * static_cast<std::size_t>(tiles_down));
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  tbb::parallel_for(0, tiles_down, [&](int tile_y) {
    for (int y = tile_y * kBoxPx; y < std::min((tile_y + 1) * kBoxPx, view.height_px()); ++y) {
      for (int x = 0; x < view.width_px(); ++x) {
        const std::optional<Eigen::Vector2d> position = plane.FromPixel({x, y});
        Eigen::Vector2d& uv =
            lens->by_pixel[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
        uv = position ? Eigen::Vector2d(*position / plane.focal_px()) : Eigen::Vector2d(kNaN, kNaN);
        const auto tile = static_cast<std::size_t>(tile_y * tiles_across + x / kBoxPx);
        if (position) lens->tile_boxes[tile].extend(uv);
      }
    }
  });
  return lens;
}

Eigen::AlignedBox2d ViewRays::BoundsOf(int x0, int y0, int x1, int y1) const {
  Eigen::AlignedBox2d box;
  if (lens_ == nullptr) {
    for (const int x : {x0, x1 - 1})
      for (const int y : {y0, y1 - 1}) box.extend(At(x, y));
    return box;
  }
  const int tiles_across = (width_px_ + kBoxPx - 1) / kBoxPx;
  for (int y = y0 / kBoxPx; y * kBoxPx < y1; ++y)
    for (int x = x0 / kBoxPx; x * kBoxPx < x1; ++x)
      box.extend(lens_->tile_boxes[static_cast<std::size_t>(y * tiles_across + x)]);
  return box;
}

}  // namespace elbowroom::recon
