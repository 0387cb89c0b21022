#include "recon/light/lasting_changes.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/recon/light/light_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

constexpr double kStepS = 0.5;
const cv::Rect kThing(24, 150, 48, 40);

class Watched {
 public:
  Watched(TableGround ground, std::uint64_t seed, double hover_s = 60.0)
      : scene_(ground, 2.0, seed, hover_s), changes_(scene_.Background(), {}) {}

  // The watched time goes on for `seconds`.
  void Go(double seconds, bool hands, const cv::Rect& thing = {}) {
    for (const double end_s = time_s_ + seconds; time_s_ < end_s; time_s_ += kStepS) {
      const DrawnPicture picture = scene_.At(time_s_, {1.0, 1.0, 1.0}, hands, thing);
      changes_.Add(picture.image_bgr, picture.mask, {}, kStepS);
    }
  }
  [[nodiscard]] std::vector<LastingChange> Changes() const { return changes_.Changes(); }

 private:
  LightScene scene_;
  LastingChanges changes_;
  double time_s_ = 0.0;
};

// The box is found to a square on each side.
void ExpectBox(const cv::Rect& found, const cv::Rect& wanted) {
  constexpr int kTolerancePx = LastingChanges::kSquarePx;
  EXPECT_NEAR(found.x, wanted.x, kTolerancePx);
  EXPECT_NEAR(found.y, wanted.y, kTolerancePx);
  EXPECT_NEAR(found.br().x, wanted.br().x, kTolerancePx);
  EXPECT_NEAR(found.br().y, wanted.br().y, kTolerancePx);
}

TEST(LastingChanges, FindAThingThatIsLeftBehindAndForgetItWhenItIsTaken) {
  for (const TableGround ground :
       {TableGround::kDarkCloth, TableGround::kGreyTable, TableGround::kPatchwork}) {
    SCOPED_TRACE(static_cast<int>(ground));
    Watched watched(ground, 3);
    watched.Go(60.0, false);
    EXPECT_TRUE(watched.Changes().empty());
    watched.Go(0.8 * LastingChanges::kLastingS, false, kThing);
    EXPECT_TRUE(watched.Changes().empty()) << "it may still be taken away";
    watched.Go(2.0 * LastingChanges::kLastingS, false, kThing);
    const auto changes = watched.Changes();
    ASSERT_EQ(changes.size(), 1U);
    ExpectBox(changes[0].box_px, kThing);
    EXPECT_NEAR(changes[0].share, kThing.area() / (320.0 * 240.0), 0.01);
    EXPECT_GT(changes[0].object_share, 0.8);
    watched.Go(1.2 * LastingChanges::kLastingS, false);
    EXPECT_TRUE(watched.Changes().empty());
  }
}

TEST(LastingChanges, FindAThingWhileHandsWork) {
  Watched watched(TableGround::kGreyTable, 4);
  watched.Go(60.0, true);
  watched.Go(6.0 * LastingChanges::kLastingS, true, kThing);
  watched.Go(LastingChanges::kLastingS, false, kThing);  // hands leave
  const auto changes = watched.Changes();
  ASSERT_EQ(changes.size(), 1U);
  ExpectBox(changes[0].box_px, kThing);
}

// A palm covers its place all the time. But around it something moves.
TEST(LastingChanges, AreNoHandsThatHoverOverOnePlace) {
  for (int trial = 0; trial < 4 * test_support::SoakScale(); ++trial) {
    const auto seed = static_cast<std::uint64_t>(trial);
    Watched watched(TableGround::kGreyTable, 30 + seed, 1e6);
    for (int i = 0; i < 8; ++i) {
      watched.Go(LastingChanges::kLastingS, true);
      EXPECT_TRUE(watched.Changes().empty()) << seed << ' ' << i;
    }
  }
}

TEST(LastingChanges, IgnoreWhatIsIgnoredAndWhatIsSmall) {
  const LightScene scene(TableGround::kGreyTable, 2.0, 5);
  core::BitMask ignore(320, 240);
  for (int y = 140; y < 200; ++y)
    for (int x = 0; x < 100; ++x) ignore.Set(x, y, true);
  LastingChanges changes(scene.Background(), ignore), small(scene.Background(), {});
  for (double t = 0.0; t < 3.0 * LastingChanges::kLastingS; t += 1.0) {
    const DrawnPicture picture = scene.At(t, {1.0, 1.0, 1.0}, false, kThing);
    changes.Add(picture.image_bgr, picture.mask, {}, 1.0);
    const DrawnPicture crumb = scene.At(t, {1.0, 1.0, 1.0}, false, {200, 100, 9, 9});
    small.Add(crumb.image_bgr, crumb.mask, {}, 1.0);
  }
  EXPECT_TRUE(changes.Changes().empty());
  EXPECT_TRUE(small.Changes().empty());
}

}  // namespace
}  // namespace elbowroom::recon
