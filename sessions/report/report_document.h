// What the report says: a document, of which report.html and report.pdf are made.
#pragma once

#include <string>
#include <vector>

#include "sessions/document/document.h"
#include "sessions/report/drawn_chart.h"
#include "sessions/report/report.h"
#include "sessions/report/report_data.h"

namespace elbowroom::sessions {

// The sections that have charts and need no pictures.
struct ChartSections {
  Section timeline;
  Section spacing;
  Section approach;
};
[[nodiscard]] ChartSections DrawCharts(const ReportData& data, ChartPainters* painters);

// Its pictures' bytes are those of `pictures`.
[[nodiscard]] Document ReportDocument(const ReportData& data, const ReportPictures& pictures,
                                      ChartSections charts, ChartPainters* painters);

// The figures at the top.
[[nodiscard]] Tiles TilesOf(const ReportData& data);

// Sections; without blocks where the session has nothing for it.
[[nodiscard]] Section SummarySection(const ReportData& data);
[[nodiscard]] Section SpacingSection(const ReportData& data, ChartPainters* painters);
[[nodiscard]] Section TimelineSection(const ReportData& data, ChartPainters* painters);
[[nodiscard]] Section ApproachSection(const ReportData& data, ChartPainters* painters);
[[nodiscard]] Section ModelSection(const ReportPictures& pictures);
[[nodiscard]] Section TouchSection(const ReportData& data, const ReportPictures& pictures);
[[nodiscard]] Section PartSection(const ReportData& data);
// The virtual parts of the layout's pair rules, held against each other.
[[nodiscard]] Section PairSection(const ReportData& data, const PairApproaches& approaches,
                                  ChartPainters* painters);
// What needn't be looked at to be sure.
[[nodiscard]] Section SkippedSection(const ReportData& data);
inline constexpr const char* kTrustId = "how-sure";
// How sure the verdicts are, and what that is made of.
[[nodiscard]] Section TrustSection(const ReportData& data);
// The steps, the estimates and the survey.
[[nodiscard]] Section ProcedureSection(const ReportData& data);
[[nodiscard]] Section HeatSection(const ReportData& data, const ReportPictures& pictures);
[[nodiscard]] Section EventSection(const ReportData& data);
[[nodiscard]] Section PictureSection(const ReportPictures& pictures);
[[nodiscard]] Section ReadingSection(const ReportData& data);
[[nodiscard]] Section RigSection(const ReportData& data);

// A part of the rig's section: how far apart the instants are at which the cameras look, and which frames
// lack which camera. Empty: the cameras have no stamps.
[[nodiscard]] std::vector<Block> SkewOfCameras(const ReportData& data);

// The spacings' values, each on a line.
[[nodiscard]] RichText SpacingTexts(const ReportData& data, const std::vector<double>& spacing_mm);

// "12 mm" deep, or "11 mm to 13 mm" from the hull; a near miss without witness points is "at least" so far.
[[nodiscard]] RichText DepthText(const ReportTouch& touch);

// "–": a cell that has nothing to say.
inline constexpr const char* kNothing = "\u2013";

}  // namespace elbowroom::sessions
