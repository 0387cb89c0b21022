#include "recon/paper_methods/plane_sweep.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <limits>
#include <optional>
#include <vector>

#include "recon/paper_methods/plane_grid.h"
#include "recon/paper_methods/plane_sweep_kernel.h"
#include "recon/paper_methods/sweep_space.h"

namespace elbowroom::recon {
namespace {

constexpr int kRootPx = 2 * kSweepTilePx;

template <typename Affine>
void SetPoints(const core::RigidTransform& b_from_view, const Eigen::Vector3d& center_in_view,
               Affine* affine) {
  const Eigen::Vector3d origin = b_from_view * center_in_view;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    affine->origin[axis] = static_cast<float>(origin[i]);
    affine->along_x[axis] = static_cast<float>(center_in_view.z() * b_from_view.rotation(i, 0));
    affine->along_y[axis] = static_cast<float>(center_in_view.z() * b_from_view.rotation(i, 1));
  }
}

// All but the points, which change from tile to tile and plane to plane.
SweepAsker AskerOf(const SweepCamera& camera, bool exterior_is_object) {
  const core::CameraCalibration& c = camera.model.calibration();
  SweepAsker asker;
  asker.max_radius_squared = static_cast<float>(camera.model.max_radius() * camera.model.max_radius());
  asker.coefficients = LensCoefficientsOf(camera.model);
  asker.lens = asker.coefficients.is_fisheye
                   ? SweepLens::kFisheye
                   : (camera.model.is_ideal() ? SweepLens::kIdeal : SweepLens::kPolynomial);
  const CoverageTexture& coverage = camera.coverage;
  const Eigen::Vector2d first(coverage.left_px, coverage.top_px);
  asker.fx = static_cast<float>(c.camera_matrix(0, 0));
  asker.skew = static_cast<float>(c.camera_matrix(0, 1));
  asker.cx = static_cast<float>(c.camera_matrix(0, 2) - first.x());
  asker.fy = static_cast<float>(c.camera_matrix(1, 1));
  asker.cy = static_cast<float>(c.camera_matrix(1, 2) - first.y());
  const auto relative = [&](const Eigen::Vector2d& position_px) {
    const Eigen::Vector2f p = (position_px - first).cast<float>();
    return std::array<float, 2>{p.x(), p.y()};
  };
  asker.valid_min = relative(coverage.valid_px.min());
  asker.valid_max = relative(coverage.valid_px.max());
  asker.picture_min = relative(Eigen::Vector2d::Constant(-0.5));
  asker.picture_max = relative({c.image_width_px - 0.5, c.image_height_px - 0.5});
  asker.exterior_is_object = exterior_is_object;
  asker.texels = coverage.texels.data();
  asker.stride = coverage.width_texels;
  return asker;
}

SweepBox BoxAt(const SweepSpace& space, const Eigen::Vector3d& center_in_view) {
  SweepBox box;
  SetPoints(space.world_from_view(), center_in_view, &box);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] = static_cast<float>(space.workspace_mm().min()[static_cast<Eigen::Index>(axis)]);
    box.max[axis] = static_cast<float>(space.workspace_mm().max()[static_cast<Eigen::Index>(axis)]);
  }
  return box;
}

// One tile's part of the picture while it is swept.
struct TilePicture {
  bool is_ready = false;
  SweepTile rays;
  std::array<float, kSweepTilePixels> depth_mm{};  // 0: not hit yet; negative: no pixel of the view
  int open_pixels = 0;
};

// Sweeps a square of pixels front to back, whole regions at a time.
class RootSweep {
 public:
  RootSweep(const SweepSpace& space, const std::vector<SweepAsker>& askers, int x0, int y0)
      : space_(space), askers_(askers), x0_(x0), y0_(y0) {}

  [[nodiscard]] std::int64_t tested_points() const { return tested_points_; }

  void Run() {
    Visit({x0_, y0_, x0_ + kRootPx, y0_ + kRootPx, 0, space_.plane_count()}, space_.AllQuestions());
  }

  // The plain sweep: settles nothing but whole tiles.
  void RunPlain() {
    ForEachTile([this](int x0, int y0) {
      const SweepRegion tile{x0, y0, x0 + kSweepTilePx, y0 + kSweepTilePx, 0, space_.plane_count()};
      const std::optional<OpenQuestions> open = space_.Narrow(tile, space_.AllQuestions());
      if (!open) return;
      for (int plane = 0; plane < tile.end_plane && TileAt(x0, y0).open_pixels > 0; ++plane)
        Test({tile.x0, tile.y0, tile.x1, tile.y1, plane, plane + 1}, *open);
    });
  }

  void CopyTo(DepthMap* picture) const {
    for (const TilePicture& tile : tiles_) {
      if (!tile.is_ready) continue;
      const auto index = static_cast<int>(&tile - tiles_.data());
      const int x0 = x0_ + index % 2 * kSweepTilePx, y0 = y0_ + index / 2 * kSweepTilePx;
      const int width = std::min(kSweepTilePx, picture->width_px - x0),
                height = std::min(kSweepTilePx, picture->height_px - y0);
      for (int y = 0; y < height; ++y) {
        std::copy_n(tile.depth_mm.data() + y * kSweepTilePx, width,
                    picture->depth_mm.data() + std::ptrdiff_t{y0 + y} * picture->width_px + x0);
      }
    }
  }

 private:
  TilePicture& TileAt(int x0, int y0) {
    TilePicture& tile =
        tiles_[static_cast<std::size_t>((y0 - y0_) / kSweepTilePx * 2 + (x0 - x0_) / kSweepTilePx)];
    if (tile.is_ready) return tile;
    tile.is_ready = true;
    tile.rays = space_.rays().TileAt(x0, y0);
    for (std::size_t i = 0; i < kSweepTilePixels; ++i) {
      const bool has_ray = tile.rays.dx[i] == tile.rays.dx[i];
      const bool is_pixel = x0 + static_cast<int>(i) % kSweepTilePx < space_.rays().width_px() &&
                            y0 + static_cast<int>(i) / kSweepTilePx < space_.rays().height_px();
      tile.depth_mm[i] = is_pixel ? 0.0F : -1.0F;
      tile.open_pixels += is_pixel && has_ray ? 1 : 0;
    }
    return tile;
  }

  void Visit(const SweepRegion& region, const OpenQuestions& asked) {
    const bool is_tile = region.x1 - region.x0 == kSweepTilePx;
    if (is_tile && TileAt(region.x0, region.y0).open_pixels == 0) return;
    const std::optional<OpenQuestions> open = space_.Narrow(region, asked);
    if (!open) return;
    const int planes = region.end_plane - region.first_plane;
    if (is_tile && (planes == 1 || open->IsSettled())) {
      Test(region, *open);
    } else if (planes > 1 && (is_tile || space_.IsDeep(region))) {
      SweepRegion half = region;
      half.end_plane = region.first_plane + planes / 2;
      Visit(half, *open);
      half.first_plane = half.end_plane;
      half.end_plane = region.end_plane;
      Visit(half, *open);
    } else {
      ForEachTile([&](int x0, int y0) {
        Visit({x0, y0, x0 + kSweepTilePx, y0 + kSweepTilePx, region.first_plane, region.end_plane}, *open);
      });
    }
  }

  // Calls visit(x0, y0) with the root's tiles in the picture.
  template <typename OnTile>
  void ForEachTile(const OnTile& visit) {
    for (int i = 0; i < 4; ++i) {
      const int x0 = x0_ + i % 2 * kSweepTilePx, y0 = y0_ + i / 2 * kSweepTilePx;
      if (x0 < space_.rays().width_px() && y0 < space_.rays().height_px()) visit(x0, y0);
    }
  }

  // Asks all open pixels of a tile on the region's first plane. If the region has more planes it is settled:
  // all open pixels are hit on the first one.
  void Test(const SweepRegion& region, const OpenQuestions& open) {
    TilePicture& tile = TileAt(region.x0, region.y0);
    const double depth_mm = space_.DepthMmOf(region.first_plane);
    const Eigen::Vector3d center_in_view = depth_mm * tile.rays.center.homogeneous();
    SweepMarks marks;
    for (std::size_t i = 0; i < kSweepTilePixels; ++i) {
      const bool has_ray = tile.rays.dx[i] == tile.rays.dx[i];
      marks.open[i] = tile.depth_mm[i] == 0.0F && has_ray ? 1.0F : 0.0F;
      marks.seen[i] = open.is_seen ? 1.0F : 0.0F;
    }
    if (!open.IsSettled()) tested_points_ += tile.open_pixels;
    if (!AskAll(tile.rays, center_in_view, open, &marks)) return;
    for (std::size_t i = 0; i < kSweepTilePixels; ++i) {
      if (marks.open[i] * marks.seen[i] == 0.0F) continue;
      tile.depth_mm[i] = static_cast<float>(depth_mm);
      --tile.open_pixels;
    }
  }

  bool AskAll(const SweepTile& rays, const Eigen::Vector3d& center_in_view, const OpenQuestions& open,
              SweepMarks* marks) const {
    if (!open.in_workspace && !AskSweepBox(rays, BoxAt(space_, center_in_view), marks)) return false;
    for (std::uint64_t bits = open.cameras; bits != 0; bits &= bits - 1) {
      const auto index = static_cast<std::size_t>(std::countr_zero(bits));
      SweepAsker asker = askers_[index];
      SetPoints(space_.cameras()[index].cam_from_view, center_in_view, &asker);
      if (!AskSweepCamera(rays, asker, marks)) return false;
    }
    return true;
  }

  const SweepSpace& space_;
  const std::vector<SweepAsker>& askers_;
  int x0_, y0_;
  std::array<TilePicture, 4> tiles_;
  std::int64_t tested_points_ = 0;
};

// The sweep with picture positions from a grid. A position between the corners of a cell has no bound that
// follows from the lens, so nothing is settled for many pixels at once: plane by plane, each pixel without a
// hit is asked.
class GridSweep {
 public:
  GridSweep(const SweepSpace& space, const std::vector<SweepAsker>& askers, const core::CameraModel& view,
            int cells)
      : space_(space), askers_(askers), grid_(view, cells) {
    for (int y0 = 0; y0 < space.rays().height_px(); y0 += kSweepTilePx)
      for (int x0 = 0; x0 < space.rays().width_px(); x0 += kSweepTilePx) tiles_.push_back(MakeTile(x0, y0));
    for (std::size_t i = 0; i < kSweepTilePixels; ++i) {
      pixels_.dx[i] = static_cast<float>(i % kSweepTilePx);
      pixels_.dy[i] = static_cast<float>(i / kSweepTilePx);
    }
  }

  void Run() {
    std::vector<std::vector<std::optional<GridTriangle>>> positions(askers_.size());
    for (int plane = 0; plane < space_.plane_count(); ++plane) {
      const double depth_mm = space_.DepthMmOf(plane);
      for (std::size_t i = 0; i < positions.size(); ++i)
        positions[i] = grid_.PositionsOf(space_.cameras()[i], depth_mm);
      tbb::parallel_for(std::size_t{0}, tiles_.size(), [&](std::size_t i) {
        for (std::size_t k = 0; k < tiles_[i].triangles.size(); ++k)
          Test(depth_mm, positions, tiles_[i].triangles[k], &tiles_[i]);
      });
    }
  }

  void CopyTo(DepthMap* picture) const {
    for (const Tile& tile : tiles_) {
      for (std::size_t i = 0; i < kSweepTilePixels; ++i) {
        const int x = tile.x0 + static_cast<int>(i) % kSweepTilePx,
                  y = tile.y0 + static_cast<int>(i) / kSweepTilePx;
        if (x >= picture->width_px || y >= picture->height_px) continue;
        picture->depth_mm[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture->width_px) +
                          static_cast<std::size_t>(x)] = tile.depth_mm[i];
      }
    }
  }

  [[nodiscard]] std::int64_t tested_points() const {
    std::int64_t sum = 0;
    for (const Tile& tile : tiles_) sum += tile.tested_points;
    return sum;
  }

 private:
  struct Tile {
    int x0 = 0, y0 = 0;
    SweepTile rays;
    std::array<std::size_t, kSweepTilePixels> triangle_of{};
    std::vector<std::size_t> triangles;  // each once
    std::array<float, kSweepTilePixels> depth_mm{};
    std::int64_t tested_points = 0;
  };

  [[nodiscard]] Tile MakeTile(int x0, int y0) const {
    Tile tile{x0, y0, space_.rays().TileAt(x0, y0), {}, {}, {}, 0};
    for (std::size_t i = 0; i < kSweepTilePixels; ++i) {
      tile.triangle_of[i] =
          grid_.TriangleOf(x0 + static_cast<int>(i) % kSweepTilePx, y0 + static_cast<int>(i) / kSweepTilePx);
      if (std::ranges::find(tile.triangles, tile.triangle_of[i]) == tile.triangles.end())
        tile.triangles.push_back(tile.triangle_of[i]);
    }
    return tile;
  }

  // Asks the tile's pixels in one triangle that aren't hit yet.
  void Test(double depth_mm, const std::vector<std::vector<std::optional<GridTriangle>>>& positions,
            std::size_t triangle, Tile* tile) const {
    SweepMarks marks;
    std::int64_t open_pixels = 0;
    for (std::size_t i = 0; i < kSweepTilePixels; ++i) {
      const bool has_ray = tile->rays.dx[i] == tile->rays.dx[i];
      const bool is_pixel = tile->x0 + static_cast<int>(i) % kSweepTilePx < space_.rays().width_px() &&
                            tile->y0 + static_cast<int>(i) / kSweepTilePx < space_.rays().height_px();
      const bool is_open =
          tile->triangle_of[i] == triangle && tile->depth_mm[i] == 0.0F && has_ray && is_pixel;
      marks.open[i] = is_open ? 1.0F : 0.0F;
      marks.seen[i] = space_.exterior_is_object() ? 0.0F : 1.0F;
      open_pixels += is_open ? 1 : 0;
    }
    if (open_pixels == 0) return;
    tile->tested_points += open_pixels;
    SweepBox box = BoxAt(space_, depth_mm * tile->rays.center.homogeneous());
    if (!AskSweepBox(tile->rays, box, &marks)) return;
    for (std::size_t c = 0; c < askers_.size(); ++c)
      if (!AskSweepCamera(pixels_, AskerOn(c, positions[c][triangle], *tile), &marks)) return;
    for (std::size_t i = 0; i < kSweepTilePixels; ++i)
      if (marks.open[i] * marks.seen[i] != 0.0F) tile->depth_mm[i] = static_cast<float>(depth_mm);
  }

  // A camera without lens, whose points in its frame are the positions in homogeneous coordinates. Without
  // positions they are behind the camera, which is exterior.
  [[nodiscard]] SweepAsker AskerOn(std::size_t camera, const std::optional<GridTriangle>& positions,
                                   const Tile& tile) const {
    SweepAsker asker = askers_[camera];
    asker.lens = SweepLens::kIdeal;
    asker.max_radius_squared = std::numeric_limits<float>::infinity();
    asker.fx = asker.fy = 1.0F;
    asker.skew = asker.cx = asker.cy = 0.0F;
    asker.origin = {0.0F, 0.0F, -1.0F};
    asker.along_x = asker.along_y = {0.0F, 0.0F, 0.0F};
    if (!positions) return asker;
    const CoverageTexture& coverage = space_.cameras()[camera].coverage;
    const GridTriangle counted = positions->CountedFrom({coverage.left_px, coverage.top_px});
    const Eigen::Vector3d origin = counted.origin + tile.x0 * counted.along_x + tile.y0 * counted.along_y;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      asker.origin[axis] = static_cast<float>(origin[i]);
      asker.along_x[axis] = static_cast<float>(counted.along_x[i]);
      asker.along_y[axis] = static_cast<float>(counted.along_y[i]);
    }
    return asker;
  }

  const SweepSpace& space_;
  const std::vector<SweepAsker>& askers_;
  PlaneGrid grid_;
  SweepTile pixels_;  // a tile's pixels counted from its first
  std::vector<Tile> tiles_;
};

}  // namespace

SweptView SweepPlanes(const core::Rig& rig, std::span<const core::SoftMask> masks,
                      const core::CameraModel& view, const SweepRays& rays,
                      const PlaneSweepOptions& options) {
  const SweepSpace space(rig, masks, view, rays, options);
  SweptView swept;
  DepthMap& picture = swept.picture;
  picture.width_px = view.width_px();
  picture.height_px = view.height_px();
  const auto pixels =
      static_cast<std::size_t>(picture.width_px) * static_cast<std::size_t>(picture.height_px);
  picture.depth_mm.assign(pixels, 0.0F);
  std::vector<SweepAsker> askers;
  for (const SweepCamera& camera : space.cameras())
    askers.push_back(AskerOf(camera, space.exterior_is_object()));
  const int roots_x = (picture.width_px + kRootPx - 1) / kRootPx,
            roots_y = (picture.height_px + kRootPx - 1) / kRootPx;
  std::atomic<std::int64_t> tested = 0;
  if (options.undistortion_grid > 0) {
    GridSweep sweep(space, askers, view, options.undistortion_grid);
    sweep.Run();
    sweep.CopyTo(&picture);
    tested = sweep.tested_points();
  } else if (space.plane_count() > 0) {
    tbb::parallel_for(0, roots_x * roots_y, [&](int root) {
      RootSweep sweep(space, askers, root % roots_x * kRootPx, root / roots_x * kRootPx);
      options.settles_regions ? sweep.Run() : sweep.RunPlain();
      sweep.CopyTo(&picture);
      tested += sweep.tested_points();
    });
  }
  picture.hit_pixels = std::count_if(picture.depth_mm.begin(), picture.depth_mm.end(),
                                     [](float depth_mm) { return depth_mm > 0.0F; });
  swept.stats.planes = space.plane_count();
  swept.stats.tested_points = tested;
  swept.stats.skipped_points = swept.stats.planes * static_cast<std::int64_t>(pixels) - tested;
  return swept;
}

SweptView SweepPlanes(const core::Rig& rig, std::span<const core::SoftMask> masks,
                      const core::CameraModel& view, const PlaneSweepOptions& options) {
  return SweepPlanes(rig, masks, view, SweepRays(view), options);
}

}  // namespace elbowroom::recon
