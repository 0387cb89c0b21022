// A contour's map that was kept as bytes is the map that would be made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "recon/contours/contour_map.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

// Items that a grid's loops may read: all but what follows the last one.
template <typename Item>
void ExpectSame(std::span<const Item> a, std::span<const Item> b, std::size_t behind, const char* what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  EXPECT_EQ(std::memcmp(a.data(), b.data(), (a.size() - behind) * sizeof(Item)), 0) << what;
}

void ExpectSameMap(const ContourMap& made, const ContourMap& kept) {
  EXPECT_EQ(made.exterior_is_object(), kept.exterior_is_object());
  EXPECT_EQ(made.contour().vertices, kept.contour().vertices);
  EXPECT_EQ(made.contour().edge_from, kept.contour().edge_from);
  EXPECT_EQ(made.contour().edge_to, kept.contour().edge_to);
  const ContourCellsView a = made.CellsView(), b = kept.CellsView();
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.origin_x_px, b.origin_x_px);
  EXPECT_EQ(a.origin_y_px, b.origin_y_px);
  EXPECT_EQ(a.cell_px, b.cell_px);
  ExpectSame(a.labels, b.labels, ContourCellsView::kBytesBehind, "labels");
  ExpectSame(a.clear_squares, b.clear_squares, a.clear_squares.empty() ? 0 : ContourCellsView::kBytesBehind,
             "distances");
  ExpectSame(a.first, b.first, 0, "first");
  ExpectSame(a.edges, b.edges, a.edges.empty() ? 0 : ContourCellsView::kEdgesBehind, "edges");
}

class KeptContours : public testing::Test {
 protected:
  [[nodiscard]] ContourMap Make(LensKind lens) {
    const core::CameraModel camera = RandomCamera(&random_, lens);
    core::SoftMask silhouette{RandomMask(&random_, camera.width_px(), camera.height_px()), {}};
    if (random_.Chance(0.5)) silhouette = RandomLevels(&random_, std::move(silhouette.mask));
    const bool exterior = random_.Chance(0.5);
    return {TraceContour(silhouette, exterior, UndistortedPlane(camera)), exterior};
  }
  Random random_{5207};
};

TEST_F(KeptContours, AnswerAsThoseThatWereMade) {
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const ContourMap made = Make(static_cast<LensKind>(trial % kLensKinds));
    const auto kept = ContourMap::FromBytes(made.Bytes());
    ASSERT_TRUE(kept);
    ExpectSameMap(made, *kept);
    EXPECT_EQ(kept->Bytes(), made.Bytes());
    for (int i = 0; i < 200; ++i) {
      const Vector2d at(random_.Uniform(-80.0, 80.0), random_.Uniform(-80.0, 80.0));
      ASSERT_EQ(kept->IsObject(at), made.IsObject(at));
      ASSERT_EQ(kept->LabelAt(at).distance_px, made.LabelAt(at).distance_px) << at.transpose();
      ASSERT_EQ(kept->EdgeWithinPx(at), made.EdgeWithinPx(at)) << at.transpose();
      ASSERT_EQ(kept->NearestEdge(at), made.NearestEdge(at)) << at.transpose();
    }
  }
}

TEST_F(KeptContours, BytesThatEndEarlyAreNone) {
  const std::string bytes = Make(LensKind{}).Bytes();
  for (int trial = 0; trial < 300; ++trial) {
    const auto size = static_cast<std::size_t>(random_.Uniform(0.0, static_cast<double>(bytes.size())));
    EXPECT_EQ(ContourMap::FromBytes(std::string_view(bytes).substr(0, std::min(size, bytes.size() - 1))),
              nullptr)
        << size << " of " << bytes.size();
  }
  EXPECT_EQ(ContourMap::FromBytes(""), nullptr);
  EXPECT_EQ(ContourMap::FromBytes(std::string(64, '\xff')), nullptr);
}

}  // namespace
}  // namespace elbowroom::recon
