// Texts of places that lie close together in the 3-D view: none hides another place's mark.
#include <gtest/gtest.h>

#include <QImage>
#include <QPainter>
#include <vector>

#include "app/console/view/dimension_painter.h"
#include "app/control/palette/part_colors.h"

namespace elbowroom::console {
namespace {

constexpr double kDepthMm = 1000.0;

// A place that the view shows at `pixel`.
control::Dimension PlaceAt(const recon::SceneView& view, const Eigen::Vector2d& pixel, core::Verdict band) {
  const Eigen::Vector3d place = kDepthMm * view.RayInCam(pixel);
  return {place, place, "≥ 50.8 mm deep", band};
}

TEST(DimensionTexts, LeaveEveryMarkFree) {
  const recon::SceneView view;
  const std::vector<Eigen::Vector2d> pixels = {{300, 240}, {306, 228}, {295, 255},
                                               {340, 232}, {320, 214}, {5, 5}};
  std::vector<control::Dimension> places;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    places.push_back(PlaceAt(view, pixels[i], i % 2 == 0 ? core::Verdict::kContact : core::Verdict::kClear));
  QImage picture(view.width_px, view.height_px, QImage::Format_RGB32);
  picture.fill(Qt::white);
  QPainter painter(&picture);
  PaintDimensions(painter, view, {}, places);
  painter.end();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const QColor seen = picture.pixelColor(static_cast<int>(pixels[i].x()), static_cast<int>(pixels[i].y()));
    const control::Color color = control::BandColor(*places[i].band);
    EXPECT_NEAR(seen.redF(), color.x(), 0.01) << i;
    EXPECT_NEAR(seen.greenF(), color.y(), 0.01) << i;
    EXPECT_NEAR(seen.blueF(), color.z(), 0.01) << i;
  }
}

}  // namespace
}  // namespace elbowroom::console
