#include "recon/synthetic/camera_view.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <optional>

#include "recon/synthetic/sensor_noise.h"
#include "recon/synthetic/table_scene.h"

namespace elbowroom::recon {
namespace {

std::vector<BoundingSphere> SpheresOf(std::span<const Solid> solids) {
  std::vector<BoundingSphere> spheres;
  spheres.reserve(solids.size());
  for (const Solid& solid : solids) spheres.push_back(BoundingSphereOf(solid));
  return spheres;
}

cv::Vec3f Levels(const Eigen::Vector3f& bgr) { return {bgr.x(), bgr.y(), bgr.z()}; }

// What the sensor makes of a row of clean grey levels. `draws` is memory of the caller's.
void ExposeRow(std::span<const float> clean, const Exposure& exposure, std::uint64_t row,
               std::vector<float>& draws, unsigned char* out) {
  draws.resize(clean.size());
  DrawRowNoise(StreamSeed(exposure.noise_seed, 0, 0, row), draws);
  using Levels = Eigen::Array<float, Eigen::Dynamic, 1>;
  const auto size = static_cast<Eigen::Index>(clean.size());
  const Eigen::Map<const Levels> clean_levels(clean.data(), size);
  Eigen::Map<Levels> levels(draws.data(), size);
  levels = static_cast<float>(exposure.gain) * clean_levels +
           static_cast<float>(exposure.noise_sigma_levels) * levels + 0.5F;
  levels = levels.max(0.0F).min(255.0F);
  for (const float level : draws) *out++ = static_cast<unsigned char>(level);
}

}  // namespace

CameraView::SolidInView::SolidInView(const Solid& its_solid, const BoundingSphere& sphere,
                                     const Eigen::Vector3d& center_in_world)
    : solid(&its_solid), to_sphere_in_world(sphere.center_in_world - center_in_world) {
  // A line along the unit vector d passes the sphere's centre c at the squared distance |c|^2 - (d.c)^2,
  // which is more than the squared radius if it misses. The slack is far more than rounding makes.
  least_along_squared_mm2 =
      to_sphere_in_world.squaredNorm() * (1.0 - 1e-9) - sphere.radius_mm * sphere.radius_mm - 1e-6;
}

bool CameraView::SolidInView::IsMissedBy(const Ray& ray) const {
  const double along_mm = ray.direction_in_world.dot(to_sphere_in_world);
  return along_mm * along_mm < least_along_squared_mm2;
}

bool CameraView::SolidInView::IsMetBy(const Ray& ray) const {
  return !IsMissedBy(ray) && FirstHit(*solid, ray).has_value();
}

std::optional<CameraView::NearestHit> CameraView::NearestOf(std::span<const SolidInView> solids,
                                                            const Ray& ray) {
  std::optional<NearestHit> nearest;
  for (const SolidInView& in_view : solids) {
    if (in_view.IsMissedBy(ray)) continue;
    const auto hit = FirstHit(*in_view.solid, ray);
    if (hit && (!nearest || hit->distance_mm < nearest->hit.distance_mm))
      nearest = NearestHit{in_view.solid, *hit};
  }
  return nearest;
}

CameraView::CameraView(const core::CameraModel& camera, std::uint64_t seed)
    : rays_(camera), empty_bgr_(rays_.height_px(), rays_.width_px(), CV_32FC3) {
  tbb::parallel_for(0, rays_.height_px(), [&](int y) {
    for (int x = 0; x < rays_.width_px(); ++x) {
      empty_bgr_.at<cv::Vec3f>(y, x) = Levels(EmptySceneColor(seed, rays_.At(x, y)));
    }
  });
  discs_.resize(rays_.tiles().size());
  tbb::parallel_for(std::size_t{0}, discs_.size(), [&](std::size_t i) {
    std::vector<Ray> rays;
    const PixelTile& tile = rays_.tiles()[i];
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) rays.push_back(rays_.At(x, y));
    discs_[i] = DiscOnTable(rays);
  });
}

std::vector<CameraView::SolidInView> CameraView::SolidsNear(const PixelTile& tile,
                                                            std::span<const Solid> solids,
                                                            std::span<const BoundingSphere> spheres) const {
  std::vector<SolidInView> near;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (rays_.MayMeet(tile, spheres[i])) near.emplace_back(solids[i], spheres[i], rays_.center_in_world());
  }
  return near;
}

void CameraView::DrawPixel(int x, int y, std::span<const SolidInView> solids, int samples_per_pixel_side,
                           cv::Mat& clean_bgr) const {
  const int n = samples_per_pixel_side;
  const auto from_center = [&](int i) { return (i + 0.5) / n - 0.5; };
  cv::Vec3f color(0.0F, 0.0F, 0.0F);
  int hits = 0;
  for (int i = 0; i < n * n; ++i) {
    const Ray ray = n == 1 ? rays_.At(x, y) : rays_.At(x, y, {from_center(i % n), from_center(i / n)});
    const auto nearest = NearestOf(solids, ray);
    if (!nearest) continue;
    color += Levels(ShadedColor(nearest->solid->color_bgr, nearest->hit.normal_in_world));
    ++hits;
  }
  if (hits == 0) return;
  auto& clean = clean_bgr.at<cv::Vec3f>(y, x);
  clean = 1.0F / static_cast<float>(n * n) * (color + static_cast<float>(n * n - hits) * clean);
}

void CameraView::DrawTile(const PixelTile& tile, std::span<const SolidInView> solids,
                          int samples_per_pixel_side, cv::Mat& clean_bgr) const {
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x) DrawPixel(x, y, solids, samples_per_pixel_side, clean_bgr);
}

// What the centre rays around the tile meet needn't be complete: a solid that no ray through the tile's
// pixels meets gives none of them an edge.
void CameraView::DrawTileByEdges(const PixelTile& tile, std::span<const SolidInView> solids, int edge_samples,
                                 cv::Mat& clean_bgr) const {
  const int x0 = std::max(tile.x0 - 1, 0), x1 = std::min(tile.x1 + 1, rays_.width_px());
  const int y0 = std::max(tile.y0 - 1, 0), y1 = std::min(tile.y1 + 1, rays_.height_px());
  std::vector<std::optional<NearestHit>> hits;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) hits.push_back(NearestOf(solids, rays_.At(x, y)));
  const auto hit_at = [&](int x, int y) -> const std::optional<NearestHit>& {
    return hits[static_cast<std::size_t>((y - y0) * (x1 - x0) + x - x0)];
  };
  const auto is_on_edge = [&](int x, int y) {
    for (int v = std::max(y - 1, y0); v <= std::min(y + 1, y1 - 1); ++v)
      for (int u = std::max(x - 1, x0); u <= std::min(x + 1, x1 - 1); ++u)
        if (hit_at(u, v).has_value() != hit_at(x, y).has_value()) return true;
    return false;
  };
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      const std::optional<NearestHit>& nearest = hit_at(x, y);
      if (is_on_edge(x, y)) {
        DrawPixel(x, y, solids, edge_samples, clean_bgr);
      } else if (nearest) {
        clean_bgr.at<cv::Vec3f>(y, x) =
            Levels(ShadedColor(nearest->solid->color_bgr, nearest->hit.normal_in_world));
      }
    }
  }
}

void CameraView::DrawShadow(std::size_t tile_index, std::span<const Solid> solids,
                            std::span<const BoundingSphere> spheres, cv::Mat& clean_bgr) const {
  const std::optional<TableDisc>& disc = discs_[tile_index];
  if (!disc) return;
  std::vector<Solid> shading;
  std::vector<BoundingSphere> their_spheres;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (!MayShade(spheres[i], *disc)) continue;
    shading.push_back(solids[i]);
    their_spheres.push_back(spheres[i]);
  }
  if (shading.empty()) return;
  const PixelTile& tile = rays_.tiles()[tile_index];
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x)
      clean_bgr.at<cv::Vec3f>(y, x) *= TableLight(rays_.At(x, y), shading, their_spheres);
  }
}

cv::Mat CameraView::Render(std::span<const Solid> solids, const Exposure& exposure) const {
  const std::vector<BoundingSphere> spheres = SpheresOf(solids);
  cv::Mat clean_bgr = empty_bgr_.clone();
  tbb::parallel_for(std::size_t{0}, rays_.tiles().size(), [&](std::size_t i) {
    const PixelTile& tile = rays_.tiles()[i];
    if (exposure.table_shadow) DrawShadow(i, solids, spheres, clean_bgr);
    const std::vector<SolidInView> near = SolidsNear(tile, solids, spheres);
    if (!near.empty()) DrawTile(tile, near, exposure.samples_per_pixel_side, clean_bgr);
  });
  cv::Mat image_bgr(clean_bgr.size(), CV_8UC3);
  const std::size_t levels_in_row = 3 * static_cast<std::size_t>(clean_bgr.cols);
  tbb::parallel_for(tbb::blocked_range<int>(0, clean_bgr.rows), [&](const tbb::blocked_range<int>& rows) {
    std::vector<float> draws;
    for (int y = rows.begin(); y < rows.end(); ++y)
      ExposeRow({clean_bgr.ptr<float>(y), levels_in_row}, exposure, static_cast<std::uint64_t>(y), draws,
                image_bgr.ptr<unsigned char>(y));
  });
  return image_bgr;
}

cv::Mat CameraView::DrawLevels(std::span<const Solid> solids, int edge_samples) const {
  const std::vector<BoundingSphere> spheres = SpheresOf(solids);
  cv::Mat clean_bgr = empty_bgr_.clone();
  tbb::parallel_for(std::size_t{0}, rays_.tiles().size(), [&](std::size_t i) {
    const std::vector<SolidInView> near = SolidsNear(rays_.tiles()[i], solids, spheres);
    if (!near.empty()) DrawTileByEdges(rays_.tiles()[i], near, edge_samples, clean_bgr);
  });
  return clean_bgr;
}

core::BitMask CameraView::TrueMask(std::span<const Solid> solids) const {
  const std::vector<BoundingSphere> spheres = SpheresOf(solids);
  core::BitMask mask(rays_.width_px(), rays_.height_px());
  // Tiles of one row share words of the mask, so a task takes a whole row of tiles.
  const auto per_row =
      static_cast<std::size_t>(std::ranges::count(rays_.tiles(), rays_.tiles().front().y0, &PixelTile::y0));
  tbb::parallel_for(std::size_t{0}, rays_.tiles().size() / per_row, [&](std::size_t row) {
    for (std::size_t i = row * per_row; i < (row + 1) * per_row; ++i) {
      const PixelTile& tile = rays_.tiles()[i];
      const std::vector<SolidInView> near = SolidsNear(tile, solids, spheres);
      for (int y = tile.y0; !near.empty() && y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
          const Ray ray = rays_.At(x, y);
          if (std::ranges::any_of(near, [&](const SolidInView& solid) { return solid.IsMetBy(ray); }))
            mask.Set(x, y, true);
        }
      }
    }
  });
  return mask;
}

}  // namespace elbowroom::recon
