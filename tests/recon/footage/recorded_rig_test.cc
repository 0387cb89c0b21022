#include "recon/footage/recorded_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <random>

#include "recon/images/mask_image.h"
#include "tests/recon/footage/made_footage.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using ::testing::AllOf;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::NumberedPicture;
using testing::NumberIn;
using testing::PlainRig;
using testing::TestFolder;

core::BitMask MaskWithPixels(int width_px, int height_px, int pixels) {
  core::BitMask mask(width_px, height_px);
  for (int i = 0; i < pixels; ++i) mask.Set(i, 1, true);
  return mask;
}

TEST(RecordedRig, EndsWithItsShortestSourceAndNamesIt) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("a.avi"), 30);
  testing::WriteVideo(folder.File("b.avi"), 22, 100);
  testing::WriteVideo(folder.File("c.avi"), 25, 200);
  RecordedRig rig(PlainRig(
      {{folder.File("a.avi"), "", ""}, {folder.File("b.avi"), "", ""}, {folder.File("c.avi"), "", ""}}));
  EXPECT_EQ(rig.frame_count(), 22);
  ASSERT_TRUE(rig.shortest_source().has_value());
  EXPECT_EQ(rig.shortest_source()->camera, 1U);
  EXPECT_EQ(rig.shortest_source()->frames, 22);
  EXPECT_EQ(rig.shortest_source()->location, folder.File("b.avi"));
  EXPECT_THAT(ErrorOf(ErrorKind::kRange, [&] { (void)rig.Read(22); }),
              AllOf(HasSubstr("frame 22"), HasSubstr("shortest source, camera 'cam2' (22 frames)")));
  EXPECT_THAT(ErrorOf(ErrorKind::kRange, [&] { (void)rig.Read(-1); }), HasSubstr("frame -1"));
}

TEST(RecordedRig, EndsWhereTheFirstVideoEndsWhateverTheyPromise) {
  const TestFolder folder;
  const std::vector<std::uint32_t> promised = {30, 60, 25};
  const std::vector<int> held = {30, 22, 25};
  std::vector<CameraSources> sources;
  for (std::size_t i = 0; i < held.size(); ++i) {
    const std::string file = folder.File(std::to_string(i) + ".avi");
    testing::WriteVideo(file, held[i]);
    testing::PromiseFrames(file, promised[i]);
    sources.push_back({file, "", ""});
  }
  RecordedRig rig(PlainRig(sources));
  EXPECT_EQ(rig.frame_count(), 25);
  for (int i = 0; i < 22; ++i) EXPECT_EQ(NumberIn(rig.Read(i).cameras[0].image_bgr), i);
  EXPECT_FALSE(rig.TryRead(22, {}).has_value());
  EXPECT_EQ(rig.frame_count(), 22);
  EXPECT_EQ(rig.shortest_source()->camera, 1U);
  EXPECT_EQ(rig.Read(5).index, 5);
}

TEST(RecordedRig, DamageAfterTheEndDoesNotMatter) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("a.avi"), 40);
  testing::WriteVideo(folder.File("b.avi"), 20);
  testing::DamageFrame(folder.File("a.avi"), 23);
  RecordedRig rig(PlainRig({{folder.File("a.avi"), "", ""}, {folder.File("b.avi"), "", ""}}));
  for (int i = 0; i < 20; ++i) EXPECT_EQ(NumberIn(rig.Read(i).cameras[0].image_bgr), i);
  EXPECT_FALSE(rig.TryRead(20, {}).has_value());
}

TEST(RecordedRig, GivesFramesOfOneNumberInAnyOrder) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("a.avi"), 30);
  testing::WriteVideo(folder.File("b.avi"), 30, 100);
  RecordedRig rig(PlainRig({{folder.File("a.avi"), "", ""}, {folder.File("b.avi"), "", ""}}));
  std::vector<int> order;
  for (int i = 0; i < 30; ++i) order.push_back(i);
  std::mt19937 random(5);
  for (int i = 0; i < 20; ++i) order.push_back(static_cast<int>(random() % 30U));
  for (const int i : order) {
    const FrameSet set = rig.Read(i);
    EXPECT_EQ(set.index, i);
    EXPECT_NEAR(set.time_s, i / 30.0, 1e-4);  // the container keeps its rate as a ratio
    ASSERT_EQ(set.cameras.size(), 2U);
    EXPECT_EQ(NumberIn(set.cameras[0].image_bgr), i);
    EXPECT_EQ(NumberIn(set.cameras[1].image_bgr), 100 + i);
    EXPECT_FALSE(set.cameras[0].ready_mask.has_value());
  }
}

TEST(RecordedRig, BringsReadyMasksAndNeedsNoBackgroundForThem) {
  const TestFolder folder;
  for (int i = 0; i < 3; ++i) {
    WriteMaskPng(MaskWithPixels(96, 64, i + 1), folder.path() / ("m_" + std::to_string(i) + ".png"));
  }
  cv::imwrite(folder.File("f_0.png"), NumberedPicture(42));
  cv::imwrite(folder.File("f_1.png"), NumberedPicture(43));
  cv::imwrite(folder.File("bg.png"), NumberedPicture(0));
  RecordedRig rig(
      PlainRig({{"", "", folder.File("m_%d.png")}, {folder.File("f_%d.png"), folder.File("bg.png"), ""}}));
  EXPECT_EQ(rig.frame_count(), 2);
  const FrameSet set = rig.Read(1);
  EXPECT_TRUE(set.cameras[0].image_bgr.empty());
  ASSERT_TRUE(set.cameras[0].ready_mask.has_value());
  EXPECT_EQ(*set.cameras[0].ready_mask, MaskWithPixels(96, 64, 2));
  EXPECT_EQ(NumberIn(set.cameras[1].image_bgr), 43);
  EXPECT_EQ(set.time_s, 1.0 / 25.0);  // no source says a rate
  const auto backgrounds = rig.ReadBackgrounds(core::Progress(), {});
  EXPECT_TRUE(backgrounds[0].mean_bgr.empty());
  EXPECT_EQ(backgrounds[1].frames, 1);
}

TEST(RecordedRig, NamesAMaskOfTheWrongSize) {
  const TestFolder folder;
  WriteMaskPng(MaskWithPixels(96, 64, 1), folder.path() / "good.png");
  WriteMaskPng(MaskWithPixels(95, 64, 1), folder.path() / "bad.png");
  RecordedRig rig(PlainRig({{"", "", folder.File("good.png")}, {"", "", folder.File("bad.png")}}));
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, [&] { (void)rig.Read(0); }),
              AllOf(HasSubstr("cam2"), HasSubstr("bad.png"), HasSubstr("95 x 64"), HasSubstr("96 x 64")));
}

TEST(RecordedRig, GoesOnAfterAFrameThatCannotBeRead) {
  const TestFolder folder;
  for (int i = 0; i < 6; ++i) cv::imwrite(folder.File("f_" + std::to_string(i) + ".png"), NumberedPicture(i));
  testing::WriteText(folder.path() / "f_3.png", "broken");
  RecordedRig rig(PlainRig({{folder.File("f_%d.png"), "", ""}}));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(NumberIn(rig.Read(i).cameras[0].image_bgr), i);
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, [&] { (void)rig.Read(3); }),
              AllOf(HasSubstr("cam1"), HasSubstr("f_3.png")));
  EXPECT_EQ(NumberIn(rig.Read(4).cameras[0].image_bgr), 4);
}

TEST(RecordedRig, RefusesSourcesThatDoNotGoTogether) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("a.avi"), 10, 0, 30.0);
  testing::WriteVideo(folder.File("b.avi"), 10, 0, 15.0);
  EXPECT_THAT(
      ErrorOf(
          ErrorKind::kFormat,
          [&] {
            const RecordedRig rig(PlainRig({{folder.File("a.avi"), "", ""}, {folder.File("b.avi"), "", ""}}));
          }),
      AllOf(HasSubstr("cam1"), HasSubstr("cam2"), HasSubstr("rate")));
  EXPECT_THAT(ErrorOf(ErrorKind::kFormat,
                      [] {
                        const RecordedRig rig(PlainRig({{"", "", ""}}));
                      }),
              AllOf(HasSubstr("cam1"), HasSubstr("neither frames nor masks")));
  EXPECT_THAT(ErrorOf(ErrorKind::kFormat,
                      [&] {
                        const RecordedRig rig(PlainRig({{"", "", folder.File("a.avi")}}));
                      }),
              AllOf(HasSubstr("cam1"), HasSubstr("masks")));
}

TEST(RecordedRig, NamesTheFirstOfSeveralBadCameras) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("a.avi"), 10);
  for (int repeat = 0; repeat < 5; ++repeat) {
    const std::string message = ErrorOf(ErrorKind::kFile, [&] {
      const RecordedRig rig(PlainRig({{folder.File("a.avi"), "", ""},
                                      {folder.File("gone2.avi"), "", ""},
                                      {folder.File("gone3.avi"), "", ""}}));
    });
    EXPECT_THAT(message, AllOf(HasSubstr("cam2"), HasSubstr("gone2.avi")));
  }
}

TEST(RecordedRig, RefusesALiveCamera) {
  const std::string message = ErrorOf(ErrorKind::kFile, [&] {
    const RecordedRig rig(PlainRig({{"rtsp://camera/1", "", ""}}));
  });
  EXPECT_THAT(message, AllOf(HasSubstr("cam1"), HasSubstr("only recorded footage can be read")));
}

TEST(RecordedRig, MeasuresBackgroundsWithProgressAndStops) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("a.avi"), 10);
  testing::WriteVideo(folder.File("bg.avi"), 12, 7);
  const CameraSources sources{folder.File("a.avi"), folder.File("bg.avi"), ""};
  RecordedRig rig(PlainRig({sources, sources}));
  std::int64_t done_at_last = 0, total_at_last = 0;
  const core::Progress progress([&](std::int64_t done, std::int64_t total, const std::string&) {
    EXPECT_GE(done, done_at_last);
    done_at_last = done, total_at_last = total;
  });
  const auto backgrounds = rig.ReadBackgrounds(progress, {});
  ASSERT_EQ(backgrounds.size(), 2U);
  EXPECT_EQ(backgrounds[0].frames, 12);
  EXPECT_EQ(done_at_last, 24);
  EXPECT_EQ(total_at_last, 24);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THAT(ErrorOf(ErrorKind::kCancelled, [&] { (void)rig.ReadBackgrounds(progress, stop.get_token()); }),
              HasSubstr("cancelled"));
  const core::Progress throwing(
      [](std::int64_t, std::int64_t, const std::string&) { throw std::runtime_error("full"); });
  EXPECT_THROW((void)rig.ReadBackgrounds(throwing, {}), std::runtime_error);
  RecordedRig without(PlainRig({{folder.File("a.avi"), "", ""}}));
  EXPECT_THAT(ErrorOf(ErrorKind::kFormat, [&] { (void)without.ReadBackgrounds(core::Progress(), {}); }),
              AllOf(HasSubstr("cam1"), HasSubstr("background")));
}

}  // namespace
}  // namespace elbowroom::recon
