// One synthetic camera: casts the ray of every pixel at solids in front of its empty scene.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/bit_mask.h"
#include "core/camera_model.h"
#include "recon/synthetic/pixel_rays.h"
#include "recon/synthetic/solids.h"
#include "recon/synthetic/table_scene.h"

namespace elbowroom::recon {

// The settings of one exposure of one camera.
struct Exposure {
  double gain = 1.0;
  double noise_sigma_levels = 0.0;
  std::uint64_t noise_seed = 0;
  bool table_shadow = false;
  int samples_per_pixel_side = 1;  // rays of a pixel, each way
};

// Immutable: the rays of all pixels and the noise-free picture of the empty scene.
class CameraView {
 public:
  // `seed` picks the cloth's pattern. Throws: Error{kCamera} naming a camera without a ray for some pixel.
  CameraView(const core::CameraModel& camera, std::uint64_t seed);

  // 8-bit BGR. Uses all cores; the same bits on any number of them.
  [[nodiscard]] cv::Mat Render(std::span<const Solid> solids, const Exposure& exposure) const;

  // The same before the sensor: grey levels, CV_32FC3, without gain and noise. Only pixels on the edge of a
  // silhouette, where some of the centre rays of the nine pixels around meet a solid and some don't, take
  // `edge_samples` rays each way; the others take the one through their centre.
  [[nodiscard]] cv::Mat DrawLevels(std::span<const Solid> solids, int edge_samples) const;

  // The pixels whose centre ray hits a solid.
  [[nodiscard]] core::BitMask TrueMask(std::span<const Solid> solids) const;

 private:
  // A solid and its bounding sphere, as the camera sees them: most rays are found to miss the sphere.
  struct SolidInView {
    SolidInView(const Solid& its_solid, const BoundingSphere& sphere, const Eigen::Vector3d& center_in_world);
    [[nodiscard]] bool IsMissedBy(const Ray& ray) const;  // false where it isn't certain
    [[nodiscard]] bool IsMetBy(const Ray& ray) const;

    const Solid* solid;
    Eigen::Vector3d to_sphere_in_world;  // from the camera's centre to the sphere's
    double least_along_squared_mm2 = 0.0;
  };
  struct NearestHit {
    const Solid* solid = nullptr;
    RayHit hit;
  };

  [[nodiscard]] static std::optional<NearestHit> NearestOf(std::span<const SolidInView> solids,
                                                           const Ray& ray);
  [[nodiscard]] std::vector<SolidInView> SolidsNear(const PixelTile& tile, std::span<const Solid> solids,
                                                    std::span<const BoundingSphere> spheres) const;
  void DrawPixel(int x, int y, std::span<const SolidInView> solids, int samples_per_pixel_side,
                 cv::Mat& clean_bgr) const;
  void DrawTile(const PixelTile& tile, std::span<const SolidInView> solids, int samples_per_pixel_side,
                cv::Mat& clean_bgr) const;
  void DrawTileByEdges(const PixelTile& tile, std::span<const SolidInView> solids, int edge_samples,
                       cv::Mat& clean_bgr) const;
  void DrawShadow(std::size_t tile_index, std::span<const Solid> solids,
                  std::span<const BoundingSphere> spheres, cv::Mat& clean_bgr) const;

  PixelRays rays_;
  std::vector<std::optional<TableDisc>> discs_;  // where the rays of each tile meet the table
  cv::Mat empty_bgr_;                            // CV_32FC3
};

}  // namespace elbowroom::recon
