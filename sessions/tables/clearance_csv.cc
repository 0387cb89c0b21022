#include "sessions/tables/clearance_csv.h"

#include <fmt/format.h>

#include <cmath>

#include "sessions/tables/csv_text.h"

namespace elbowroom::sessions {
namespace {

std::string ClearanceHeader(const core::Layout& layout) {
  std::string line =
      "frame,time_s,part,verdict,verdict_errs,required_mm,uncertainty_mm,lower_mm,upper_mm,"
      "part_x_mm,part_y_mm,part_z_mm,hull_x_mm,hull_y_mm,hull_z_mm,"
      "calibration_mm,footprint_mm,segmentation_mm,skew_mm,given_mm";
  for (const core::Spacing& spacing : layout.spacings)
    line += ',' + Quoted("spacing " + spacing.name + " mm");
  return line + '\n';
}

}  // namespace

std::string ClearanceLine(const core::SessionHeader& header, const ContactRow& row) {
  const core::PartClearance& clearance = *row.contact.clearance;
  const auto length = [](double length_mm) {
    return std::isfinite(length_mm) ? fmt::format(",{}", length_mm) : std::string(",");
  };
  const auto witness = [&](const Eigen::Vector3d& x) {
    return clearance.has_witnesses ? std::optional(x) : std::nullopt;
  };
  std::string line = fmt::format(
      "{},{},{},{},{},{},{}", row.frame, row.time_s, Quoted(header.layout.parts[row.contact.part].name),
      core::ToString(row.contact.verdict), HowItErrs(row.contact.verdict), header.trial.required_clearance_mm,
      clearance.AllowedMm(header.trial.uncertainty_mm));
  line += length(clearance.interval.lower_mm) + length(clearance.interval.upper_mm);
  AppendVector(line, witness(clearance.interval.witness_part_in_world_mm));
  AppendVector(line, witness(clearance.interval.witness_hull_in_world_mm));
  if (const auto& budget = clearance.budget) {
    line += fmt::format(",{},{},{},{},{}", budget->calibration_mm, budget->footprint_mm,
                        budget->segmentation_mm, budget->skew_mm, budget->given_mm);
  } else {
    line += ",,,,,";
  }
  for (const double spacing_mm : row.spacing_mm) line += fmt::format(",{}", spacing_mm);
  return line + '\n';
}

std::string_view HowItErrs(core::Verdict verdict) {
  switch (verdict) {
    case core::Verdict::kContact:
      return "may be the hull's alone";
    case core::Verdict::kNear:
      return "may be farther";
    case core::Verdict::kClear:
      return "sure";
    case core::Verdict::kUndecided:
      break;
  }
  return "bounds don't tell";
}

std::string ClearanceCsv(const core::SessionHeader& header, std::span<const ContactRow> rows) {
  std::string csv = ClearanceHeader(header.layout);
  for (const ContactRow& row : rows) csv += ClearanceLine(header, row);
  return csv;
}

}  // namespace elbowroom::sessions
