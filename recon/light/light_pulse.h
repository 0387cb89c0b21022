// A pulse of the light, and which lamps it comes from.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "recon/light/light_report.h"

namespace elbowroom::recon {

struct GainAtTime {
  double time_s = 0.0;  // of the middle of the exposure
  double gain = 1.0;
};

// The strongest pulse in a few seconds of pictures: the periodogram of Lomb (1976) and Scargle (1982), which
// takes the stamps as they are, from the slowest pulse that the time shows to half of the pictures' rate and
// around 100 and 120 Hz. Evenly spaced stamps can't tell a frequency from its aliases, so a pulse that fits
// lamps is taken for theirs; where both lamps fit, or the pulse fits neither, `lamp_hz` is empty. Nothing if
// no pulse stands out of the noise (once in about 10,000 times noise does), or with fewer than kLeastGains.
// Exact to a tenth of the amplitude (tests/recon/light/light_pulse_test.cc). `gains`: in order of time.
[[nodiscard]] std::optional<LightPulse> FindPulse(std::span<const GainAtTime> gains);
inline constexpr std::size_t kLeastGains = 48;

// 50, 60: mains of which lamps pulse at (nearly) a multiple of the pictures' rate, so that all pictures show
// the same light.
[[nodiscard]] std::vector<int> HiddenMainsHz(double rate_hz);

}  // namespace elbowroom::recon
