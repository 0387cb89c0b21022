#include "app/control/calibration/foreign_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace elbowroom::control {
namespace {

using core::Error;
using core::ErrorKind;
using core::LengthUnit;
using recon::RigConvention;

constexpr std::array<LengthUnit, 4> kUnits = {LengthUnit::kMillimetre, LengthUnit::kCentimetre,
                                              LengthUnit::kMetre, LengthUnit::kInch};

double ErrorOf(const TriedConvention& tried) {
  return tried.check ? tried.check->error_px : std::numeric_limits<double>::infinity();
}

std::vector<TriedConvention> TryAll(const MatchedRig& matched, const recon::CalibrationInput& input,
                                    const StatedConvention& stated) {
  std::vector<TriedConvention> tried;
  for (const RigConvention& convention : recon::PossibleConventions(matched.rig.format)) {
    if (convention.pose != stated.pose.value_or(convention.pose) ||
        convention.axes != stated.axes.value_or(convention.axes))
      continue;
    tried.push_back({convention, recon::CheckRig(input, CalibrationsIn(matched, convention, 1.0))});
  }
  if (tried.empty())
    throw Error(ErrorKind::kFormat,
                fmt::format("files of the format {} can't have these poses or axes; leave out "
                            "--pose and --axes",
                            ToString(matched.rig.format)));
  std::ranges::stable_sort(tried, {}, ErrorOf);  // the documented one first where they are equal
  return tried;
}

bool IsSame(const MatchedRig& matched, const RigConvention& a, const RigConvention& b) {
  return recon::AreTheSameRig(CalibrationsIn(matched, a, 1.0), CalibrationsIn(matched, b, 1.0));
}

std::string PixelsOf(const TriedConvention& tried) {
  return tried.check ? fmt::format("{:.1f} px", tried.check->error_px) : std::string("no fit");
}

double MostErrorPx(const recon::CalibrationCamera& camera) {
  return kMostErrorShare * std::max(camera.width_px, camera.height_px);
}

// The best is good enough in every camera, and nothing else is as good.
void RequireDecided(const MatchedRig& matched, const recon::CalibrationInput& input,
                    const std::vector<TriedConvention>& tried) {
  const TriedConvention& best = tried.front();
  if (!best.check)
    throw Error(
        ErrorKind::kCamera,
        "the poses can't be checked: no two cameras see the board at once, or all stand in one place");
  for (std::size_t i = 0; i < input.cameras.size(); ++i) {
    const std::optional<double>& error_px = best.check->camera_error_px[i];
    if (!error_px || *error_px <= MostErrorPx(input.cameras[i])) continue;
    std::string others;
    for (std::size_t k = 1; k < tried.size(); ++k)
      others += fmt::format("; {}: {}", ToString(tried[k].convention), PixelsOf(tried[k]));
    throw Error(
        ErrorKind::kCamera,
        fmt::format("the board refutes the poses: camera '{}' is {:.1f} px off at best ({}), at most {:.1f} "
                    "are allowed{}; check the cameras' names and lenses, and square_mm",
                    input.cameras[i].name, *error_px, ToString(best.convention),
                    MostErrorPx(input.cameras[i]), others));
  }
  for (std::size_t k = 1; k < tried.size(); ++k) {
    if (ErrorOf(tried[k]) > kRefutedFactor * best.check->error_px ||
        IsSame(matched, best.convention, tried[k].convention))
      continue;
    throw Error(
        ErrorKind::kCamera,
        fmt::format("the board doesn't tell what the poses are: {} is {:.2f} px off, {} {:.2f}; say --pose "
                    "and --axes, or show the board in more places",
                    ToString(best.convention), best.check->error_px, ToString(tried[k].convention),
                    tried[k].check->error_px));
  }
}

std::optional<LengthUnit> NearestUnit(double unit_mm) {
  for (const LengthUnit unit : kUnits)
    if (std::abs(unit_mm / core::MillimetresPer(unit) - 1.0) <= kUnitTolerance) return unit;
  return std::nullopt;
}

// From the scale that the board tells to a unit.
void SettleUnit(const recon::ForeignRig& rig, const StatedConvention& stated, double told_mm,
                FoundConvention* found) {
  found->unit = stated.unit ? stated.unit : NearestUnit(told_mm);
  found->unit_mm = found->unit ? core::MillimetresPer(*found->unit) : told_mm;
  const double off = told_mm / found->unit_mm - 1.0;
  if (std::abs(off) > kUnitTolerance)
    throw Error(
        ErrorKind::kCamera,
        fmt::format("the board says that one of the file's units is {:.4g} mm, not 1 {}; check --unit and "
                    "square_mm",
                    told_mm, core::ToString(*found->unit)));
  constexpr double kNoteworthy = 0.01;
  if (!found->unit) {
    found->warnings.push_back(fmt::format(
        "the lengths are in no unit with a name: one of them is {:.4g} mm by the board's squares, "
        "which is taken",
        told_mm));
  } else if (std::abs(off) > kNoteworthy) {
    found->warnings.push_back(fmt::format(
        "by the board's squares the rig should be {:.1f} % {}; check square_mm, and the board that the "
        "rig was calibrated with",
        100.0 * std::abs(off), off > 0.0 ? "larger" : "smaller"));
  }
  const std::optional<LengthUnit> documented = recon::DocumentedUnit(rig.format);
  if (documented && found->unit != documented)
    found->warnings.push_back(fmt::format("{} keeps lengths in {}; these are in {}", ToString(rig.format),
                                          core::ToString(*documented),
                                          found->unit ? std::string(core::ToString(*found->unit))
                                                      : fmt::format("units of {:.4g} mm", told_mm)));
}

}  // namespace

std::vector<core::CameraCalibration> CalibrationsIn(const MatchedRig& matched,
                                                    const RigConvention& convention, double unit_mm) {
  const std::vector<core::CameraCalibration> all = recon::CalibrationsOf(matched.rig, convention, unit_mm);
  std::vector<core::CameraCalibration> calibrations;
  for (const std::size_t place : matched.places) calibrations.push_back(all[place]);
  return calibrations;
}

FoundConvention FindConvention(const MatchedRig& matched, const recon::CalibrationInput& input,
                               const StatedConvention& stated) {
  FoundConvention found;
  found.tried = TryAll(matched, input, stated);
  RequireDecided(matched, input, found.tried);
  found.convention = found.tried.front().convention;
  const double told_mm = found.tried.front().check->scale;
  const RigConvention documented = recon::DocumentedConvention(matched.rig.format);
  const bool is_documented_tried = std::ranges::any_of(
      found.tried, [&](const TriedConvention& tried) { return tried.convention == documented; });
  if (is_documented_tried && IsSame(matched, found.convention, documented)) found.convention = documented;
  if (found.convention != documented && is_documented_tried) {
    const auto of_documented = std::ranges::find(found.tried, documented, &TriedConvention::convention);
    found.warnings.push_back(fmt::format("the poses are {} ({}), not {} as {} documents ({})",
                                         ToString(found.convention), PixelsOf(found.tried.front()),
                                         ToString(documented), ToString(matched.rig.format),
                                         PixelsOf(*of_documented)));
  }
  SettleUnit(matched.rig, stated, told_mm, &found);
  found.check = recon::CheckRig(input, CalibrationsIn(matched, found.convention, found.unit_mm), 1.0);
  if (found.check) found.check->scale = told_mm / found.unit_mm;
  return found;
}

FoundConvention UncheckedConvention(const recon::ForeignRig& rig, const StatedConvention& stated) {
  FoundConvention found;
  const RigConvention documented = recon::DocumentedConvention(rig.format);
  found.convention = {stated.pose.value_or(documented.pose), stated.axes.value_or(documented.axes)};
  found.unit = stated.unit ? stated.unit : recon::DocumentedUnit(rig.format);
  if (!found.unit)
    throw Error(ErrorKind::kFormat,
                fmt::format("files of the format {} don't say their unit; say --unit mm, cm, m "
                            "or in, or let a board tell it with --check",
                            ToString(rig.format)));
  found.unit_mm = core::MillimetresPer(*found.unit);
  found.warnings.push_back(
      fmt::format("nothing is checked: the poses are taken as {}, the lengths as {}; a board that the "
                  "cameras see checks both: "
                  "--check CALIB.toml",
                  ToString(found.convention), core::ToString(*found.unit)));
  return found;
}

}  // namespace elbowroom::control
