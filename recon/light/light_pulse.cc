#include "recon/light/light_pulse.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace elbowroom::recon {
namespace {

constexpr double kLampsHz[] = {100.0, 120.0};
constexpr double kMainsToleranceHz = 0.5;     // of the lamps' pulse: mains within 0.25 Hz
constexpr double kLeastAmplitude = 0.003;     // less isn't told from what hands do to the estimate
constexpr double kMatteringAmplitude = 0.02;  // 2.5 levels of a grey of 125, an eighth of `floor_levels`
// Explained variance over that of the rest, halved, is exponentially distributed for noise; it must exceed
// this plus the logarithm of how many frequencies are tried.
constexpr double kLeastPower = 9.2;  // -ln(1e-4)

struct Centred {
  std::vector<double> time_s, value;
  double variance = 0.0;
};

// Less a straight line, which is drift.
Centred Detrended(std::span<const GainAtTime> gains) {
  const auto n = static_cast<double>(gains.size());
  double t = 0.0, g = 0.0, tt = 0.0, tg = 0.0;
  for (const GainAtTime& at : gains) t += at.time_s / n, g += at.gain / n;
  for (const GainAtTime& at : gains) {
    tt += (at.time_s - t) * (at.time_s - t);
    tg += (at.time_s - t) * (at.gain - g);
  }
  const double slope = tt > 0.0 ? tg / tt : 0.0;
  Centred centred;
  for (const GainAtTime& at : gains) {
    centred.time_s.push_back(at.time_s - t);
    centred.value.push_back((at.gain - g - slope * (at.time_s - t)) / std::max(g, 1e-9));
    centred.variance += centred.value.back() * centred.value.back() / n;
  }
  return centred;
}

struct Peak {
  double hz = 0.0, power = 0.0, amplitude = 0.0;
};

// Scargle's form: sine and cosine with the phase that makes them orthogonal for these stamps.
Peak At(const Centred& centred, double hz) {
  const double omega = 2.0 * std::numbers::pi * hz;
  std::complex<double> twice;
  for (const double t : centred.time_s) twice += std::polar(1.0, 2.0 * omega * t);
  const double phase = 0.5 * std::arg(twice);
  double c = 0.0, s = 0.0, cc = 0.0, ss = 0.0;
  for (std::size_t i = 0; i < centred.time_s.size(); ++i) {
    const double angle = omega * centred.time_s[i] - phase;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    c += centred.value[i] * cosine, s += centred.value[i] * sine;
    cc += cosine * cosine, ss += sine * sine;
  }
  // At half of the rate, and at an alias of zero, one of both vanishes at all stamps.
  const double least = 1e-6 * static_cast<double>(centred.time_s.size());
  const double a = cc > least ? c / cc : 0.0, b = ss > least ? s / ss : 0.0;
  const double explained = a * c + b * s;
  const double total = centred.variance * static_cast<double>(centred.time_s.size());
  const double rest = std::max(total - explained, 1e-12 * total + 1e-300);
  return {hz, 0.5 * explained / rest * static_cast<double>(centred.time_s.size()), std::hypot(a, b)};
}

Peak BestIn(const Centred& centred, double from_hz, double to_hz, double step_hz) {
  Peak best;
  const int steps = std::max(0, static_cast<int>(std::ceil((to_hz - from_hz) / step_hz)));
  for (int i = 0; i <= steps; ++i) {
    const Peak peak = At(centred, std::min(from_hz + i * step_hz, to_hz));
    if (peak.power > best.power) best = peak;
  }
  // Between the steps, by halving.
  for (double step = 0.5 * step_hz; step > 0.02 * step_hz; step *= 0.5) {
    for (const double hz : {best.hz - step, best.hz + step}) {
      if (hz < from_hz || hz > to_hz) continue;
      const Peak peak = At(centred, hz);
      if (peak.power > best.power) best = peak;
    }
  }
  return best;
}

}  // namespace

std::optional<LightPulse> FindPulse(std::span<const GainAtTime> gains) {
  if (gains.size() < kLeastGains) return std::nullopt;
  const double span_s = gains.back().time_s - gains.front().time_s;
  if (!(span_s > 0.0)) return std::nullopt;
  const double rate_hz = static_cast<double>(gains.size() - 1) / span_s;
  const double step_hz = 0.25 / span_s, slowest_hz = 2.0 / span_s;
  const Centred centred = Detrended(gains);
  if (!(centred.variance > 0.0)) return std::nullopt;
  const Peak seen = BestIn(centred, slowest_hz, 0.5 * rate_hz, step_hz);
  Peak lamps[2];
  for (std::size_t i = 0; i < 2; ++i)
    lamps[i] = BestIn(centred, kLampsHz[i] - kMainsToleranceHz, kLampsHz[i] + kMainsToleranceHz, step_hz);
  const double best = std::max({seen.power, lamps[0].power, lamps[1].power});
  const double tried = 0.5 * rate_hz * span_s + 4.0 * kMainsToleranceHz * span_s;
  if (best < kLeastPower + std::log(std::max(tried, 1.0))) return std::nullopt;
  // Evenly spaced stamps give aliases one power, but for rounding and for steps of the search.
  constexpr double kAlike = 0.8;
  const bool fits[2] = {lamps[0].power >= kAlike * best, lamps[1].power >= kAlike * best};
  LightPulse pulse;
  pulse.fits_lamps = fits[0] || fits[1];
  if (fits[0] != fits[1]) pulse.lamp_hz = lamps[fits[0] ? 0 : 1].hz;
  const Peak& peak = fits[0] ? lamps[0] : fits[1] ? lamps[1] : seen;
  pulse.seen_hz = std::abs(peak.hz - rate_hz * std::round(peak.hz / rate_hz));
  pulse.amplitude_share = peak.amplitude;
  pulse.matters = pulse.amplitude_share >= kMatteringAmplitude;
  if (pulse.seen_hz < slowest_hz || pulse.amplitude_share < kLeastAmplitude) return std::nullopt;
  return pulse;
}

std::vector<int> HiddenMainsHz(double rate_hz) {
  constexpr double kSlowHz = 0.5;
  std::vector<int> hidden;
  for (const int mains_hz : {50, 60}) {
    const double lamp_hz = 2.0 * mains_hz;
    if (std::abs(lamp_hz - rate_hz * std::round(lamp_hz / rate_hz)) < kSlowHz) hidden.push_back(mains_hz);
  }
  return hidden;
}

}  // namespace elbowroom::recon
