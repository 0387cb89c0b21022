#include "recon/light/light_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "tests/recon/light/light_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr TableGround kTables[] = {TableGround::kDarkCloth, TableGround::kGreyTable, TableGround::kPatchwork};
constexpr double kWatchNoiseLevels = 3.0;

double Turn(double turns) { return std::sin(2.0 * std::numbers::pi * turns); }

TEST(LightWatch, KnowsTheGainToAHundredthWhileHandsWork) {
  constexpr double kGainTolerance = 0.01;
  for (const TableGround ground : kTables) {
    const LightScene scene(ground, kWatchNoiseLevels, 6);
    const BackgroundReference background = scene.Background();
    for (const double gain : {1.0, 0.85, 1.2, 0.7}) {
      LightWatch watch("cam1", background, false);
      for (int frame = 0; frame < 30; ++frame) {
        const double t = 100.0 * gain + frame / 15.0;
        const DrawnPicture picture = scene.At(t, {gain, gain, gain}, true);
        watch.Add(picture.image_bgr, picture.mask, t);
      }
      EXPECT_NEAR(watch.Report().gain, gain, kGainTolerance * gain) << static_cast<int>(ground);
    }
  }
}

TEST(LightWatch, TellsFlickerFromItsStampsAndNamesTheMains) {
  for (const TableGround ground : kTables) {
    for (const double lamp_hz : {100.0, 120.0}) {
      const double rate_hz = lamp_hz == 100.0 ? 30.0 : 25.0;
      const LightScene scene(ground, kWatchNoiseLevels, 7);
      LightWatch watch("cam1", scene.Background(), false);
      for (int frame = 0; frame < 12 * rate_hz; ++frame) {
        const double t = 500.0 + frame / rate_hz, gain = 1.0 + 0.07 * Turn(lamp_hz * t + 0.2);
        const DrawnPicture picture = scene.At(t, {gain, gain, gain}, true);
        watch.Add(picture.image_bgr, picture.mask, t);
      }
      const LightReport report = watch.Report();
      ASSERT_TRUE(report.pulse && report.pulse->lamp_hz);
      EXPECT_NEAR(*report.pulse->lamp_hz, lamp_hz, 0.1);
      EXPECT_NEAR(report.pulse->amplitude_share, 0.07, 0.01);
      EXPECT_TRUE(report.pulse->matters);
      ASSERT_EQ(report.advice.size(), 1U);
      EXPECT_THAT(report.advice[0], HasSubstr(lamp_hz == 100.0 ? "50 Hz mains" : "60 Hz mains"));
      ASSERT_EQ(report.hidden_mains_hz.size(), 1U);
      EXPECT_EQ(report.hidden_mains_hz[0], lamp_hz == 100.0 ? 60 : 50);
    }
  }
}

TEST(LightWatch, SaysWhereTheBackgroundChangedWhileTheLightDrifts) {
  const LightScene scene(TableGround::kGreyTable, kWatchNoiseLevels, 8);
  LightWatch watch("cam2", scene.Background(), false);
  double t = 0.0;
  const auto go = [&](double seconds, const cv::Rect& thing) {
    for (const double end = t + seconds; t < end; t += 0.5) {
      const double gain = 1.0 - 0.05 * t / 900.0;
      const DrawnPicture picture = scene.At(t, {gain, gain, gain}, false, thing);
      watch.Add(picture.image_bgr, picture.mask, t);
    }
  };
  go(300.0, {});
  EXPECT_THAT(watch.Report().advice, IsEmpty());
  go(600.0, {24, 180, 48, 40});
  const LightReport report = watch.Report();
  ASSERT_EQ(report.changes.size(), 1U);
  ASSERT_EQ(report.advice.size(), 1U);
  EXPECT_THAT(report.advice[0], HasSubstr("camera 'cam2': the background changed lower left"));
  ASSERT_TRUE(report.drift.has_value());
  EXPECT_NEAR(report.drift->share_per_hour, -0.2 / 0.95, 0.03);
  EXPECT_FALSE(report.pulse.has_value());
}

TEST(LightWatch, TellsWhenTheCameraWasMovedOrALampIsOff) {
  const LightScene scene(TableGround::kPatchwork, kWatchNoiseLevels, 9),
      other(TableGround::kPatchwork, kWatchNoiseLevels, 90);
  LightWatch watch("cam1", scene.Background(), true);
  for (int i = 0; i < 120; ++i) {
    const DrawnPicture picture = other.At(i, {1.0, 1.0, 1.0}, false);
    watch.Add(picture.image_bgr, picture.mask, i);
  }
  const auto advice = watch.Report().advice;
  ASSERT_EQ(advice.size(), 1U);
  EXPECT_THAT(advice[0], HasSubstr("moved"));
}

TEST(LightWatch, LeavesOutWhatIsNotLaterAndRefusesOtherSizes) {
  const LightScene scene(TableGround::kGreyTable, kWatchNoiseLevels, 10);
  LightWatch watch("cam1", scene.Background(), false);
  EXPECT_EQ(watch.Report().gain, 1.0);
  const DrawnPicture bright = scene.At(1.0, {1.2, 1.2, 1.2}, false),
                     plain = scene.At(2.0, {1.0, 1.0, 1.0}, false);
  watch.Add(bright.image_bgr, bright.mask, 5.0);
  watch.Add(plain.image_bgr, plain.mask, 5.0);
  watch.Add(plain.image_bgr, plain.mask, 4.0);
  EXPECT_NEAR(watch.Report().gain, 1.2, 0.02);
  EXPECT_EQ(watch.Report().time_s, 5.0);
  EXPECT_THROW(watch.Add(cv::Mat(9, 9, CV_8UC3), core::BitMask(9, 9), 6.0), core::PreconditionError);
}

// Two hands work without a break; the light of a day, with clouds, moves by 15 % and changes its colour. Two
// pictures a second, and 15 in twelve seconds of five minutes, so that a pulse could be seen. Here twenty
// minutes, of another part of the day for each table; with `./dev soak 24` eight hours, with 48 another day.
TEST(LightWatch, RaisesNoFalseAlarmInHoursOfWork) {
  constexpr double kDayS = 8.0 * 3600.0, kShareS = 1200.0;
  constexpr double kSlowS = 0.5, kFastS = 1.0 / 15.0, kFastEveryS = 300.0, kFastForS = 12.0;
  constexpr double kReportEveryS = 20.0;
  const double watched_s = std::min(kDayS, kShareS * test_support::SoakScale());
  const std::size_t days = static_cast<std::size_t>(std::max(1, test_support::SoakScale() / 24));
  int reports = 0;
  for (std::size_t run = 0; run < std::size(kTables) * days; ++run) {
    const std::size_t table = run % std::size(kTables);
    const LightScene scene(kTables[table], kWatchNoiseLevels, 11 + run);
    LightWatch watch("cam1", scene.Background(), true);
    const double begin_s = (kDayS - watched_s) * static_cast<double>(table) / 2.0;
    double next_report_s = begin_s + kFastForS;
    for (double t = begin_s; t < begin_s + watched_s;
         t += std::fmod(t - begin_s, kFastEveryS) < kFastForS ? kFastS : kSlowS) {
      const double day = 0.10 * Turn(t / kDayS), cloud = 0.05 * Turn(t / 700.0) * Turn(t / 4100.0);
      const double warm = 0.03 * Turn(t / 9000.0);
      const DrawnPicture picture =
          scene.At(t, {1.0 + day + cloud - warm, 1.0 + day + cloud, 1.0 + day + cloud + warm}, true);
      watch.Add(picture.image_bgr, picture.mask, t);
      if (t < next_report_s) continue;
      next_report_s += kReportEveryS;
      ++reports;
      const LightReport report = watch.Report();
      ASSERT_THAT(report.advice, IsEmpty()) << "run " << run << ", after " << t - begin_s << " s";
      ASSERT_FALSE(report.pulse.has_value()) << "run " << run << ", after " << t - begin_s << " s";
      ASSERT_NEAR(report.gain, 1.0 + day + cloud, 0.02) << t;
    }
  }
  EXPECT_GT(reports, 150);
}

}  // namespace
}  // namespace elbowroom::recon
