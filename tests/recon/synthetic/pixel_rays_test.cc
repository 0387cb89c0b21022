#include "recon/synthetic/pixel_rays.h"

#include <gtest/gtest.h>

#include <random>

#include "recon/synthetic/rig_presets.h"

namespace elbowroom::recon {
namespace {

// What a tile leaves out is left out of the picture, so its cone holds every ray of its pixels: those through
// their rims, too.
TEST(PixelRays, ATilesConeHoldsEveryRayOfItsPixels) {
  const core::Rig rig = FourCameraRig();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(-0.5, 0.5), distance_mm(300.0, 2000.0);
  int at_rims = 0;
  for (const core::CameraModel& camera : rig.cameras) {
    const PixelRays rays(camera);
    for (std::size_t i = 0; i < rays.tiles().size(); i += 13) {
      const PixelTile& tile = rays.tiles()[i];
      for (int k = 0; k < 60; ++k) {
        // Pixels at the tile's corners as often as all others.
        const bool is_corner = k % 2 == 0;
        const int x = is_corner
                          ? (k % 4 == 0 ? tile.x0 : tile.x1 - 1)
                          : tile.x0 + static_cast<int>(random() % static_cast<unsigned>(tile.x1 - tile.x0));
        const int y = is_corner
                          ? (k % 8 < 4 ? tile.y0 : tile.y1 - 1)
                          : tile.y0 + static_cast<int>(random() % static_cast<unsigned>(tile.y1 - tile.y0));
        const Eigen::Vector2d within =
            is_corner ? Eigen::Vector2d(x == tile.x0 ? -0.5 : 0.5, y == tile.y0 ? -0.5 : 0.5)
                      : Eigen::Vector2d(share(random), share(random));
        const Ray ray = rays.At(x, y, within);
        const BoundingSphere speck{ray.origin_in_world + distance_mm(random) * ray.direction_in_world, 1e-6};
        ASSERT_TRUE(rays.MayMeet(tile, speck)) << camera.name() << ", pixel " << x << ", " << y;
        at_rims += is_corner ? 1 : 0;
      }
    }
  }
  EXPECT_GT(at_rims, 1000);
}

}  // namespace
}  // namespace elbowroom::recon
