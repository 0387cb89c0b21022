#include "recon/light/light_pulse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace elbowroom::recon {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kGainNoise = 0.004;  // of an estimate from 1,024 pixels with 2 % of noise

struct Recording {
  double rate_hz = 30.0, seconds = 10.0;
  double pulse_hz = 0.0, amplitude = 0.0;
  double jitter_s = 0.0;  // of the time between stamps, uniform
  double drift_share = 0.0;
};

std::vector<GainAtTime> GainsOf(const Recording& recording, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, kGainNoise);
  const auto uniform = [&] { return static_cast<double>(random() % 100000U) / 100000.0; };
  const double phase = 2.0 * std::numbers::pi * uniform();
  std::vector<GainAtTime> gains;
  for (int i = 0; i < recording.rate_hz * recording.seconds; ++i) {
    const double t = 1000.0 + i / recording.rate_hz + recording.jitter_s * (uniform() - 0.5);
    const double pulse =
        recording.amplitude * std::cos(2.0 * std::numbers::pi * recording.pulse_hz * t + phase);
    gains.push_back({t, (1.0 + pulse) * (1.0 + recording.drift_share * (t - 1000.0) / recording.seconds) +
                            noise(random)});
  }
  return gains;
}

struct LampCase {
  double rate_hz, pulse_hz;
  double lamp_hz;  // 0: both lamps fit
  double seen_hz;
};

// Rates of cameras, lamps of both mains, mains that are off a little; each with several phases and
// amplitudes.
TEST(LightPulse, IsTakenForTheLampThatAliasesToIt) {
  constexpr double kFrequencyToleranceHz = 0.02;  // a fifth of 1 / 10 s
  std::mt19937 random(21);
  for (const LampCase& lamp : {LampCase{30.0, 100.0, 100.0, 10.0}, LampCase{29.97, 100.0, 100.0, 10.09},
                               LampCase{30.0, 100.2, 100.2, 10.2}, LampCase{29.0, 120.0, 120.0, 4.0},
                               LampCase{25.0, 120.0, 120.0, 5.0}, LampCase{15.0, 100.0, 100.0, 5.0},
                               LampCase{60.0, 100.0, 100.0, 20.0}, LampCase{50.0, 120.0, 120.0, 20.0},
                               LampCase{24.0, 100.0, 100.0, 4.0}, LampCase{12.5, 120.0, 120.0, 5.0},
                               LampCase{90.0, 100.0, 100.0, 10.0}, LampCase{22.0, 100.0, 0.0, 10.0},
                               LampCase{55.0, 120.0, 0.0, 10.0}}) {
    for (const double amplitude : {0.10, 0.02, 0.006}) {
      for (int trial = 0; trial < 5; ++trial) {
        SCOPED_TRACE(std::to_string(lamp.rate_hz) + " Hz, lamp " + std::to_string(lamp.pulse_hz) + " Hz, " +
                     std::to_string(amplitude));
        const auto pulse =
            FindPulse(GainsOf({lamp.rate_hz, 10.0, lamp.pulse_hz, amplitude, 0.0, 0.03}, random));
        ASSERT_TRUE(pulse.has_value());
        EXPECT_TRUE(pulse->fits_lamps);
        ASSERT_EQ(pulse->lamp_hz.has_value(), lamp.lamp_hz > 0.0);
        EXPECT_NEAR(pulse->lamp_hz.value_or(0.0), lamp.lamp_hz, kFrequencyToleranceHz);
        EXPECT_NEAR(pulse->seen_hz, lamp.seen_hz, kFrequencyToleranceHz);
        EXPECT_NEAR(pulse->amplitude_share, amplitude, 0.1 * amplitude + 3.0 * kGainNoise / std::sqrt(60.0));
        EXPECT_EQ(pulse->matters, amplitude >= 0.02 * 0.9 && pulse->amplitude_share >= 0.02);
      }
    }
  }
}

// 22 pictures a second show both lamps at 10 Hz. Stamps that aren't even tell them apart.
TEST(LightPulse, UnevenStampsTellAliasesApart) {
  std::mt19937 random(22);
  for (const double lamp_hz : {100.0, 120.0}) {
    for (int trial = 0; trial < 10; ++trial) {
      const auto pulse = FindPulse(GainsOf({22.0, 10.0, lamp_hz, 0.05, 0.008, 0.0}, random));
      ASSERT_TRUE(pulse && pulse->lamp_hz);
      EXPECT_NEAR(*pulse->lamp_hz, lamp_hz, 0.05);
    }
  }
  // So does a light that really pulses at 10 Hz.
  const auto pulse = FindPulse(GainsOf({22.0, 10.0, 10.0, 0.05, 0.008, 0.0}, random));
  ASSERT_TRUE(pulse.has_value());
  EXPECT_FALSE(pulse->fits_lamps);
  EXPECT_NEAR(pulse->seen_hz, 10.0, 0.05);
}

TEST(LightPulse, ThatFitsNoLampIsNoLamps) {
  std::mt19937 random(23);
  const auto pulse = FindPulse(GainsOf({30.0, 10.0, 3.3, 0.05, 0.0, 0.0}, random));
  ASSERT_TRUE(pulse.has_value());
  EXPECT_FALSE(pulse->fits_lamps);
  EXPECT_FALSE(pulse->lamp_hz.has_value());
  EXPECT_NEAR(pulse->seen_hz, 3.3, 0.02);
}

TEST(LightPulse, IsNotSeenInNoiseOrDrift) {
  std::mt19937 random(24);
  int seen = 0;
  for (int trial = 0; trial < 400; ++trial) {
    Recording recording{15.0 + trial % 30, 10.0, 0.0, 0.0, trial % 3 == 0 ? 0.005 : 0.0, 0.1 * (trial % 5)};
    seen += FindPulse(GainsOf(recording, random)) ? 1 : 0;
  }
  EXPECT_EQ(seen, 0);
  EXPECT_FALSE(FindPulse({}).has_value());
  EXPECT_FALSE(FindPulse(std::vector<GainAtTime>(100, GainAtTime{1.0, 1.0})).has_value());
}

TEST(LightPulse, TellsWhichLampsTheRateHides) {
  EXPECT_THAT(HiddenMainsHz(25.0), ElementsAre(50));
  EXPECT_THAT(HiddenMainsHz(30.0), ElementsAre(60));
  EXPECT_THAT(HiddenMainsHz(29.97), ElementsAre(60));
  EXPECT_THAT(HiddenMainsHz(20.0), ElementsAre(50, 60));
  EXPECT_THAT(HiddenMainsHz(24.0), ElementsAre(60));
  EXPECT_THAT(HiddenMainsHz(29.0), IsEmpty());
}

}  // namespace
}  // namespace elbowroom::recon
