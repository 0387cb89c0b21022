// Slices through the workspace, coloured by what the rig can do there, as SVG.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "app/control/coverage/coverage_job.h"

namespace elbowroom::control {

enum class CoverageQuantity { kUncertainty, kFootprint, kCameras, kPhantom };
inline constexpr std::array kCoverageQuantities = {CoverageQuantity::kUncertainty,
                                                   CoverageQuantity::kFootprint, CoverageQuantity::kCameras,
                                                   CoverageQuantity::kPhantom};

// "uncertainty_mm": the JSON key, and the picture's file name before ".svg".
[[nodiscard]] const char* NameOf(CoverageQuantity quantity);
[[nodiscard]] const char* TitleOf(CoverageQuantity quantity);
// What the quantity is, in one or two sentences, for a reader of the page.
[[nodiscard]] std::string ExplanationOf(CoverageQuantity quantity, const CoverageOutcome& outcome);
[[nodiscard]] const std::optional<core::Spread>& SpreadOf(const recon::CoverageFigures& figures,
                                                          CoverageQuantity quantity);

// The workspace from above at three heights, and two upright slices through its middle. Cameras are dots with
// their names; those beyond the picture's edge are hollow dots on it. Parts: the outlines of their shadows.
// The legend says what a colour is. Stands in a page; alone it needs StandaloneSvg.
[[nodiscard]] std::string CoveragePicture(const CoverageOutcome& outcome, CoverageQuantity quantity);

// An SVG file.
[[nodiscard]] std::string StandaloneSvg(const std::string& svg);

}  // namespace elbowroom::control
