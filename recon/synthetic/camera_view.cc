#include "recon/synthetic/camera_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
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

struct NearestHit {
  const Solid* solid = nullptr;
  RayHit hit;
};

std::optional<NearestHit> NearestOf(std::span<const Solid> solids, const Ray& ray) {
  std::optional<NearestHit> nearest;
  for (const Solid& solid : solids) {
    const auto hit = FirstHit(solid, ray);
    if (hit && (!nearest || hit->distance_mm < nearest->hit.distance_mm)) nearest = NearestHit{&solid, *hit};
  }
  return nearest;
}

// What the sensor makes of a row of clean grey levels.
void ExposeRow(const cv::Vec3f* clean, const Exposure& exposure, std::uint64_t row, int width,
               cv::Vec3b* out) {
  RowNoise noise(StreamSeed(exposure.noise_seed, 0, 0, row));
  const auto gain = static_cast<float>(exposure.gain);
  const auto sigma = static_cast<float>(exposure.noise_sigma_levels);
  float draw[3];
  for (int x = 0; x < width; ++x) {
    noise.Next(draw);
    for (int channel = 0; channel < 3; ++channel) {
      const float level = gain * clean[x][channel] + sigma * draw[channel] + 0.5F;
      out[x][channel] = static_cast<unsigned char>(std::clamp(level, 0.0F, 255.0F));
    }
  }
}

}  // namespace

CameraView::CameraView(const core::CameraModel& camera, std::uint64_t seed)
    : rays_(camera), empty_bgr_(rays_.height_px(), rays_.width_px(), CV_32FC3) {
  tbb::parallel_for(0, rays_.height_px(), [&](int y) {
    for (int x = 0; x < rays_.width_px(); ++x) {
      empty_bgr_.at<cv::Vec3f>(y, x) = Levels(EmptySceneColor(seed, rays_.At(x, y)));
    }
  });
}

std::vector<Solid> CameraView::SolidsNear(const PixelTile& tile, std::span<const Solid> solids,
                                          std::span<const BoundingSphere> spheres) const {
  std::vector<Solid> near;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (rays_.MayMeet(tile, spheres[i])) near.push_back(solids[i]);
  }
  return near;
}

void CameraView::DrawTile(const PixelTile& tile, std::span<const Solid> solids, int samples_per_pixel_side,
                          cv::Mat& clean_bgr) const {
  const int n = samples_per_pixel_side;
  const float share = 1.0F / static_cast<float>(n * n);
  const auto from_center = [&](int i) { return (i + 0.5) / n - 0.5; };
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      cv::Vec3f color(0.0F, 0.0F, 0.0F);
      int hits = 0;
      for (int i = 0; i < n * n; ++i) {
        const Ray ray = n == 1 ? rays_.At(x, y) : rays_.At(x, y, {from_center(i % n), from_center(i / n)});
        const auto nearest = NearestOf(solids, ray);
        if (!nearest) continue;
        color += Levels(ShadedColor(nearest->solid->color_bgr, nearest->hit.normal_in_world));
        ++hits;
      }
      if (hits == 0) continue;
      auto& clean = clean_bgr.at<cv::Vec3f>(y, x);
      clean = share * (color + static_cast<float>(n * n - hits) * clean);
    }
  }
}

void CameraView::DrawShadow(const PixelTile& tile, std::span<const Solid> solids,
                            std::span<const BoundingSphere> spheres, cv::Mat& clean_bgr) const {
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x)
      clean_bgr.at<cv::Vec3f>(y, x) *= TableLight(rays_.At(x, y), solids, spheres);
  }
}

cv::Mat CameraView::Render(std::span<const Solid> solids, const Exposure& exposure) const {
  const std::vector<BoundingSphere> spheres = SpheresOf(solids);
  cv::Mat clean_bgr = empty_bgr_.clone();
  tbb::parallel_for(std::size_t{0}, rays_.tiles().size(), [&](std::size_t i) {
    const PixelTile& tile = rays_.tiles()[i];
    if (exposure.table_shadow && !solids.empty()) DrawShadow(tile, solids, spheres, clean_bgr);
    const std::vector<Solid> near = SolidsNear(tile, solids, spheres);
    if (!near.empty()) DrawTile(tile, near, exposure.samples_per_pixel_side, clean_bgr);
  });
  cv::Mat image_bgr(clean_bgr.size(), CV_8UC3);
  tbb::parallel_for(0, clean_bgr.rows, [&](int y) {
    ExposeRow(clean_bgr.ptr<cv::Vec3f>(y), exposure, static_cast<std::uint64_t>(y), clean_bgr.cols,
              image_bgr.ptr<cv::Vec3b>(y));
  });
  return image_bgr;
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
      const std::vector<Solid> near = SolidsNear(tile, solids, spheres);
      for (int y = tile.y0; !near.empty() && y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
          const Ray ray = rays_.At(x, y);
          if (std::ranges::any_of(near, [&](const Solid& s) { return FirstHit(s, ray).has_value(); })) {
            mask.Set(x, y, true);
          }
        }
      }
    }
  });
  return mask;
}

}  // namespace elbowroom::recon
