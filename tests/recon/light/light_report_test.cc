#include "recon/light/light_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recon/light/gain_history.h"

namespace elbowroom::recon {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const cv::Size kPicture(640, 480);

TEST(LightReport, NamesThePlaceInThePicture) {
  EXPECT_EQ(PlaceInPicture({0, 400, 60, 60}, kPicture), "lower left");
  EXPECT_EQ(PlaceInPicture({580, 0, 60, 60}, kPicture), "upper right");
  EXPECT_EQ(PlaceInPicture({300, 220, 40, 40}, kPicture), "in the middle");
  EXPECT_EQ(PlaceInPicture({300, 0, 40, 40}, kPicture), "upper middle");
  EXPECT_EQ(PlaceInPicture({600, 220, 40, 40}, kPicture), "on the right");
}

TEST(LightReport, AdvisesInPlainWords) {
  LightReport report;
  report.camera = "cam2";
  EXPECT_THAT(AdviceFor(report, kPicture, false), IsEmpty());
  report.gain = 0.86;
  report.pulse = LightPulse{0.08, 10.0, 100.02, true, true};
  report.changes = {{{0, 400, 80, 80}, 0.021, 0.9}};
  EXPECT_THAT(
      AdviceFor(report, kPicture, false),
      ElementsAre(
          "camera 'cam2': the background changed lower left (2.1 % of the picture, which counts as an "
          "object); take the background again",
          "camera 'cam2': the light is 14 % darker than when the background was taken; take it again, "
          "or set method = \"adaptive\"",
          "camera 'cam2': lamps on 50 Hz mains flicker by 8 %; set an exposure time that is a multiple "
          "of the lamps' pulse, or method = \"adaptive\""));
  EXPECT_EQ(AdviceFor(report, kPicture, true).size(), 1U);
  report.agreeing_share = 0.2;
  EXPECT_THAT(
      AdviceFor(report, kPicture, false),
      ElementsAre(
          "camera 'cam2': only 20 % of the background looks as it did; see whether the camera was moved "
          "or a lamp is off, then take the background again"));
}

TEST(GainHistory, MeasuresADriftAndKeepsQuietWithoutOne) {
  GainHistory still, drifting;
  for (int i = 0; i < 20 * 900; ++i) {
    const double t = i / 20.0, noise = 0.004 * ((i * 7919) % 1000 / 500.0 - 1.0);
    still.Add({t, 1.0 + noise});
    drifting.Add({t, 1.0 - 0.12 * t / 3600.0 + noise});
  }
  EXPECT_FALSE(still.Drift().has_value());
  EXPECT_NEAR(still.Now(), 1.0, 0.001);
  EXPECT_NEAR(still.RateHz(), 20.0, 0.01);
  const auto drift = drifting.Drift();
  ASSERT_TRUE(drift.has_value());
  EXPECT_NEAR(drift->share_per_hour, -0.12 / 0.97, 0.005);  // of the light now
  EXPECT_NEAR(drift->tenth_in_s, 0.1 / 0.1237 * 3600.0, 150.0);
  EXPECT_NEAR(drift->over_s, 900.0, 60.0);
  EXPECT_EQ(GainHistory().Now(), 1.0);
  EXPECT_FALSE(GainHistory().Drift() || GainHistory().Pulse());
}

}  // namespace
}  // namespace elbowroom::recon
