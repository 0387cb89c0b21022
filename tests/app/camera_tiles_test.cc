// What the camera strip shows, without Qt: small pictures with outlines, figures, and cameras that go.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <random>
#include <vector>

#include "app/control/demo_parts.h"
#include "app/control/tiles/camera_tally.h"
#include "app/control/tiles/thumbnail.h"
#include "app/control/tiles/tile_maker.h"
#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/rig_presets.h"

namespace elbowroom::control {
namespace {

constexpr std::chrono::seconds kPatience(30);  // far beyond what a tile takes

ThumbnailColor PixelOf(const recon::Image& image, int x, int y) {
  const auto at = 3 * static_cast<std::size_t>(y * image.width_px + x);
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

core::BitMask MaskOf(int width_px, int height_px, const cv::Rect& object) {
  core::BitMask mask(width_px, height_px);
  for (int y = object.y; y < object.y + object.height; ++y)
    for (int x = object.x; x < object.x + object.width; ++x) mask.Set(x, y, true);
  return mask;
}

TEST(Thumbnail, HasThePictureInItsColoursAndTheOutlineOnTheBoundary) {
  const cv::Mat orange(480, 640, CV_8UC3, cv::Scalar(10, 120, 240));
  // Sides on whole small pixels: 640 / 160 = 4.
  const core::BitMask mask = MaskOf(640, 480, {200, 120, 160, 240});
  const recon::Image image = ThumbnailOf(orange, mask, {160, 200});
  ASSERT_EQ(image.width_px, 160);
  ASSERT_EQ(image.height_px, 120);
  const ThumbnailColor untouched = {240, 120, 10};
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const bool is_object = x >= 50 && x < 90 && y >= 30 && y < 90;
      const auto beside = [&](int dx, int dy) {
        return (x + dx >= 50 && x + dx < 90 && y + dy >= 30 && y + dy < 90) != is_object;
      };
      const bool is_edge = beside(-1, 0) || beside(1, 0) || beside(0, -1) || beside(0, 1);
      const ThumbnailColor expected = !is_edge ? untouched : is_object ? kOutline : kOutlineShade;
      ASSERT_EQ(PixelOf(image, x, y), expected) << x << ", " << y;
    }
  }
}

TEST(Thumbnail, FitsTheRoomAndIsNeverLargerThanTheCamera) {
  const core::BitMask mask(640, 480);
  for (const auto& [room, width_px, height_px] : {std::tuple{ThumbnailRoom{200, 60}, 80, 60},
                                                  {ThumbnailRoom{64, 600}, 64, 48},
                                                  {ThumbnailRoom{4000, 3000}, 640, 480},
                                                  {ThumbnailRoom{191, 144}, 191, 143}}) {
    const recon::Image image = ThumbnailOf({}, mask, room);
    EXPECT_EQ(image.width_px, width_px);
    EXPECT_EQ(image.height_px, height_px);
    EXPECT_EQ(image.rgb.size(), static_cast<std::size_t>(3 * width_px * height_px));
  }
  EXPECT_EQ(ThumbnailOf({}, mask, {0, 100}), recon::Image());
  EXPECT_EQ(ThumbnailOf({}, core::BitMask(), {100, 100}), recon::Image());
  EXPECT_THROW((void)ThumbnailOf(cv::Mat(48, 64, CV_8UC3), mask, {100, 100}), core::PreconditionError);
}

TEST(Thumbnail, ShowsAThingOfOnePixelInWidth) {
  const recon::Image image = ThumbnailOf({}, MaskOf(640, 480, {320, 0, 2, 480}), {160, 120});
  for (int y = 0; y < image.height_px; ++y) EXPECT_EQ(PixelOf(image, 80, y), kOutline) << y;
}

TEST(Thumbnail, WithoutAPictureShowsTheSilhouetteInItsTwoColours) {
  std::mt19937 random(20010404);
  core::BitMask mask(640, 480);
  const recon::Image empty = ThumbnailOf({}, mask, {160, 120});
  for (int y = 0; y < empty.height_px; ++y)
    for (int x = 0; x < empty.width_px; ++x) ASSERT_EQ(PixelOf(empty, x, y), kMaskBackground);
  mask.SetAll();
  const recon::Image full = ThumbnailOf({}, mask, {160, 120});
  EXPECT_EQ(PixelOf(full, 3, 3), kMaskObject);
  for (int i = 0; i < 1000; ++i)
    mask.Set(static_cast<int>(random() % 640), static_cast<int>(random() % 480), false);
  const recon::Image holes = ThumbnailOf({}, mask, {160, 120});
  EXPECT_NE(holes, full);
}

core::FrameRecord RecordOf(double time_s, std::vector<std::optional<core::CameraStamp>> stamps,
                           std::vector<core::PictureLoss> losses = {}) {
  core::FrameRecord record;
  record.time_s = time_s;
  record.stamps = std::move(stamps);
  record.losses = std::move(losses);
  return record;
}

TEST(CameraTally, RateIsThatOfThePicturesNumbersOverTheLastTwoSeconds) {
  CameraTally tally(1);
  EXPECT_FALSE(tally.Figures().front().rate_hz);
  for (std::uint64_t i = 0; i <= 90; ++i)
    tally.Add(RecordOf(static_cast<double>(i) / 30.0, {core::CameraStamp{i, static_cast<double>(i) / 30.0}}),
              true);
  EXPECT_NEAR(*tally.Figures().front().rate_hz, 30.0, 1e-9);
  // Then ten a second: two seconds later nothing is left of the thirty. Every other one isn't handed over.
  for (std::uint64_t i = 1; i <= 12; ++i) {
    const double time_s = 3.0 + 0.2 * static_cast<double>(i);
    tally.Add(RecordOf(time_s, {core::CameraStamp{90 + 2 * i, time_s}}), true);
  }
  EXPECT_NEAR(*tally.Figures().front().rate_hz, 10.0, 1e-9);
}

TEST(CameraTally, CountsLostPicturesButNotThoseThatNoFrameNeeded) {
  CameraTally tally(2);
  tally.Add(RecordOf(0.0, {core::CameraStamp{0, 0.0}, core::CameraStamp{0, 0.0}},
                     {{1, 3, 5, core::LossReason::kIncomplete}, {1, 6, 6, core::LossReason::kUnpaired}}),
            true);
  tally.Add(RecordOf(0.1, {core::CameraStamp{1, 0.1}, {}}, {{1, 7, 7, core::LossReason::kNotSent}}), true);
  EXPECT_EQ(tally.Figures()[0].lost, 0);
  EXPECT_EQ(tally.Figures()[1].lost, 4);
}

TEST(CameraTally, SkewIsTheStampLessTheFramesTimeWhileThePictureIsThere) {
  CameraTally tally(2);
  tally.Add(RecordOf(1.0, {core::CameraStamp{1, 1.002}, core::CameraStamp{1, 0.999}}), true);
  EXPECT_NEAR(*tally.Figures()[0].skew_ms, 2.0, 1e-9);
  EXPECT_NEAR(*tally.Figures()[1].skew_ms, -1.0, 1e-9);
  tally.Add(RecordOf(1.1, {core::CameraStamp{2, 1.1}, {}}), true);
  EXPECT_FALSE(tally.Figures()[1].skew_ms);
}

TEST(CameraTally, OfFootageWithoutStampsNothingIsKnown) {
  CameraTally tally(1);
  tally.Add(RecordOf(0.0, {}), false);
  const CameraFigures figures = tally.Figures().front();
  EXPECT_FALSE(figures.rate_hz || figures.lost || figures.skew_ms || figures.light);
}

// A rig whose cameras go and come as the test says.
class SwitchedRig : public recon::FrameSetSource {
 public:
  [[nodiscard]] const core::Rig& rig() const override { return rig_; }
  [[nodiscard]] std::optional<core::FrameIndex> frame_count() const override { return std::nullopt; }
  [[nodiscard]] std::string WhatEndsIt() const override { return {}; }
  [[nodiscard]] std::optional<recon::FrameSet> TryRead(core::FrameIndex, std::stop_token) override {
    return std::nullopt;
  }
  [[nodiscard]] std::vector<recon::BackgroundReference> ReadBackgrounds(const core::Progress&,
                                                                        std::stop_token) override {
    return {};
  }
  [[nodiscard]] std::vector<std::string> CameraTroubles() const override {
    return {"", is_on ? "" : "no picture for 0.25 s", "", ""};
  }
  std::atomic<bool> is_on = true;

 private:
  core::Rig rig_ = recon::FourCameraRig();
};

// The latest tiles, and a wait for some.
class TileBox {
 public:
  void Put(const SharedTiles& tiles) {
    {
      const std::lock_guard lock(mutex_);
      tiles_ = tiles;
      ++count_;
    }
    came_.notify_all();
  }
  template <typename Condition>
  [[nodiscard]] bool WaitFor(Condition condition) {
    std::unique_lock lock(mutex_);
    return came_.wait_for(lock, kPatience, [&] { return tiles_ != nullptr && condition(*tiles_); });
  }
  [[nodiscard]] int count() {
    const std::lock_guard lock(mutex_);
    return count_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  SharedTiles tiles_;
  int count_ = 0;
};

TileWishes SmallTiles() {
  TileWishes wishes;
  wishes.room = {160, 120};
  return wishes;
}

// A live frame of that number in which all cameras but those `without` see a grey table with an object.
SharedFrameResult FrameOf(const core::Rig& rig, core::FrameIndex index,
                          const std::vector<std::size_t>& without = {}) {
  auto result = std::make_shared<FrameResult>();
  auto frames = std::make_shared<recon::FrameSet>();
  frames->taken_at = std::chrono::steady_clock::now();
  auto masks = std::make_shared<std::vector<core::SoftMask>>();
  result->record.frame = index;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const core::CameraModel& camera = rig.cameras[i];
    const bool is_there = std::ranges::count(without, i) == 0;
    masks->push_back({MaskOf(camera.width_px(), camera.height_px(), {8, 8, 64, 64}), {}});
    frames->cameras.push_back(
        {is_there ? cv::Mat(camera.height_px(), camera.width_px(), CV_8UC3, cv::Scalar(90, 90, 90))
                  : cv::Mat()});
    result->record.stamps.emplace_back();
    if (is_there) result->record.stamps.back() = core::CameraStamp{static_cast<std::uint64_t>(index), 0.0};
  }
  result->record.masks = masks;
  result->camera_frames = frames;
  return result;
}

// The same with a hull and the demo's parts, of which the first is in contact.
SharedFrameResult FrameWithParts(const core::Rig& rig) {
  auto result = std::make_shared<FrameResult>(*FrameOf(rig, 0));
  result->layout = std::make_shared<const core::Layout>(DemoLayout());
  result->world_from_parts = core::PosesAt(*result->layout, result->layout->InitialSpacings());
  result->record.contacts.resize(result->layout->parts.size());
  result->record.contacts.front().verdict = core::Verdict::kContact;
  result->hull = std::make_shared<const recon::VisualHull>(
      recon::MakeVisualHull(std::make_shared<const core::Rig>(rig), *result->record.masks));
  return result;
}

TEST(TileMaker, DrawsThePartsIntoThePicturesUnlessItIsToldNotTo) {
  TileBox box;
  const auto rig = std::make_shared<SwitchedRig>();
  TileMaker maker(rig, [&](const SharedTiles& tiles) { box.Put(tiles); });
  // A pixel of the overhead picture in which a part stands: not the table's grey.
  const auto has_parts = [](const recon::Image& image) {
    const ThumbnailColor pixel = PixelOf(image, image.width_px / 2 - 10, image.height_px / 2);
    return pixel != ThumbnailColor{90, 90, 90};
  };
  TileWishes wishes = SmallTiles();
  wishes.shows_parts = false;
  maker.Wish(wishes);
  maker.Add(FrameWithParts(rig->rig()));
  ASSERT_TRUE(box.WaitFor([&](const auto& tiles) {
    return tiles.front().picture.width_px == 160 && !has_parts(tiles.front().picture);
  }));
  wishes.shows_parts = true;
  maker.Wish(wishes);
  maker.Add(FrameWithParts(rig->rig()));
  EXPECT_TRUE(box.WaitFor([&](const auto& tiles) { return has_parts(tiles.front().picture); }));
}

TEST(TileMaker, MakesOneCamerasPictureLargeWhenItIsAskedFor) {
  TileBox box;
  const auto rig = std::make_shared<SwitchedRig>();
  TileMaker maker(rig, [&](const SharedTiles& tiles) { box.Put(tiles); });
  TileWishes wishes;
  wishes.enlarged = 2;
  wishes.enlarged_room = {600, 450};
  maker.Wish(wishes);  // nobody looks at the strip
  maker.Add(FrameWithParts(rig->rig()));
  EXPECT_TRUE(box.WaitFor([](const auto& tiles) {
    return tiles[2].enlarged.width_px == 600 && tiles[1].enlarged.rgb.empty() && tiles[2].picture.rgb.empty();
  }));
}

TEST(TileMaker, MakesNoTileWhileNobodyLooks) {
  TileBox box;
  const auto rig = std::make_shared<SwitchedRig>();
  {
    TileMaker maker(rig, [&](const SharedTiles& tiles) { box.Put(tiles); });
    for (core::FrameIndex i = 0; i < 10; ++i) maker.Add(FrameOf(rig->rig(), i));
    rig->is_on = false;
  }
  EXPECT_EQ(box.count(), 0);
}

TEST(TileMaker, ShowsTheLatestFrameOnceThereIsRoom) {
  TileBox box;
  const auto rig = std::make_shared<SwitchedRig>();
  TileMaker maker(rig, [&](const SharedTiles& tiles) { box.Put(tiles); });
  maker.Add(FrameOf(rig->rig(), 0, {2}));
  maker.Add(FrameOf(rig->rig(), 1));
  maker.Wish(SmallTiles());
  ASSERT_TRUE(box.WaitFor([](const auto& tiles) { return tiles.front().picture.width_px == 160; }));
  EXPECT_TRUE(box.WaitFor([&](const auto& tiles) {
    return tiles.size() == 4 && tiles[1].name == rig->rig().cameras[1].name() &&
           tiles[1].object_px == 64 * 64 && !tiles[2].is_missing && tiles[2].figures.lost == 0;
  }));
}

TEST(TileMaker, ACameraThatGoesIsToldWithoutANewFrameAndKeepsItsPicture) {
  TileBox box;
  const auto rig = std::make_shared<SwitchedRig>();
  TileMaker maker(rig, [&](const SharedTiles& tiles) { box.Put(tiles); });
  maker.Wish(SmallTiles());
  maker.Add(FrameOf(rig->rig(), 0));
  ASSERT_TRUE(box.WaitFor([](const auto& tiles) { return !tiles[1].picture.rgb.empty(); }));
  rig->is_on = false;
  ASSERT_TRUE(box.WaitFor([](const auto& tiles) { return tiles[1].gone == "no picture for 0.25 s"; }));
  maker.Add(FrameOf(rig->rig(), 1, {1}));
  ASSERT_TRUE(box.WaitFor([](const auto& tiles) { return tiles[1].is_missing; }));
  EXPECT_TRUE(box.WaitFor([](const auto& tiles) { return tiles[1].picture.width_px == 160; }));
  rig->is_on = true;
  EXPECT_TRUE(box.WaitFor([](const auto& tiles) { return tiles[1].gone.empty(); }));
}

TEST(TileMaker, KeepsNoSourceAlive) {
  TileBox box;
  auto rig = std::make_shared<SwitchedRig>();
  TileMaker maker(rig, [&](const SharedTiles& tiles) { box.Put(tiles); });
  const std::weak_ptr<SwitchedRig> watched = rig;
  maker.Wish(SmallTiles());
  const SharedFrameResult frame = FrameOf(rig->rig(), 0);
  rig.reset();
  maker.Add(frame);
  ASSERT_TRUE(box.WaitFor([](const auto& tiles) { return !tiles[0].picture.rgb.empty(); }));
  EXPECT_TRUE(watched.expired());
}

}  // namespace
}  // namespace elbowroom::control
