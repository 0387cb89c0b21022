#include "cad_import/normalisation/unit_choice.h"

#include <fmt/format.h>

#include "cad_import/normalisation/likely_unit.h"
#include "core/error.h"
#include "core/size_text.h"
#include "core/units.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;
using core::LengthUnit;

// Sizes that nothing at a table has.
constexpr double kImplausiblySmallMm = 1.0, kImplausiblyLargeMm = 3000.0;

std::string SizeText(const Eigen::AlignedBox3d& bounds, double mm_per_unit) {
  return core::SizeText(bounds.sizes() * mm_per_unit) + " mm";
}

Eigen::AlignedBox3d BoundsOf(const RawScene& scene) {
  Eigen::AlignedBox3d bounds;
  for (const RawInstance& instance : scene.instances)
    for (const Eigen::Vector3d& vertex : scene.shapes[instance.shape].mesh.vertices_mm)
      bounds.extend(instance.model_from_shape * vertex);
  return bounds;
}

[[noreturn]] void FailWithoutUnit(const RawScene& scene, FileFormat format, const std::string& where) {
  const Eigen::AlignedBox3d bounds = BoundsOf(scene);
  std::string sizes;
  for (const LengthUnit unit : kLengthUnits) {
    sizes += fmt::format("{}{} if in {}", sizes.empty() ? "" : ", ",
                         SizeText(bounds, core::MillimetresPer(unit)), core::ToString(unit));
  }
  throw Error(
      ErrorKind::kCad,
      fmt::format(
          "{0}: {1} carries no unit: {2}; most likely its unit is {3}: use --unit, FILE:{3} or `unit`", where,
          ToString(format), sizes, core::ToString(LikelyUnit(bounds.sizes().maxCoeff()))));
}

}  // namespace

FileUnit ChooseUnit(const RawScene& scene, FileFormat format, const ImportOptions& options,
                    const std::string& where, std::vector<std::string>& warnings) {
  if (options.unit) {
    FileUnit asked = UnitOf(*options.unit);
    if (scene.unit && scene.unit->name != asked.name) {
      warnings.push_back(fmt::format("the {} file is in {} by its own word but was read in {}, as asked",
                                     ToString(format), scene.unit->name, asked.name));
    }
    return asked;
  }
  if (scene.unit) return *scene.unit;
  if (!options.unit_if_file_has_none) FailWithoutUnit(scene, format, where);
  return UnitOf(*options.unit_if_file_has_none);
}

void WarnOfSize(const Eigen::AlignedBox3d& bounds_mm, const FileUnit& unit,
                std::vector<std::string>& warnings) {
  const double longest_mm = bounds_mm.sizes().maxCoeff();
  if (longest_mm >= kImplausiblySmallMm && longest_mm <= kImplausiblyLargeMm) return;
  const LengthUnit likely = LikelyUnit(longest_mm / unit.mm_per_unit);
  const double mm_per_likely = core::MillimetresPer(likely);
  std::string other;
  if (mm_per_likely != unit.mm_per_unit)
    other = fmt::format(" If it is {}, that would be {}.", core::ToString(likely),
                        SizeText(bounds_mm, mm_per_likely / unit.mm_per_unit));
  warnings.push_back(fmt::format("its size, {}, is implausible for a payload; is its unit really {}?{}",
                                 SizeText(bounds_mm, 1.0), unit.name, other));
}

}  // namespace elbowroom::cad_import
