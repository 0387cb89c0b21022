// The report's page.
#pragma once

#include <string>

#include "sessions/report/page_charts.h"
#include "sessions/report/report.h"
#include "sessions/report/report_data.h"

namespace elbowroom::sessions {

// A complete HTML document that loads nothing. Its script draws what its pictures show anew; without a script
// or without WebGL the pictures stay.
[[nodiscard]] std::string ReportPage(const ReportData& data, const ReportPictures& pictures);

// Sections, each a whole <section>, or empty where the session has nothing for it.
[[nodiscard]] std::string SummarySection(const ReportData& data);
[[nodiscard]] std::string SpacingSection(const ReportData& data, PageCharts* charts);
[[nodiscard]] std::string TimelineSection(const ReportData& data, PageCharts* charts);
[[nodiscard]] std::string ApproachSection(const ReportData& data, PageCharts* charts);
[[nodiscard]] std::string ModelSection(const ReportPictures& pictures);
[[nodiscard]] std::string TouchSection(const ReportData& data, const ReportPictures& pictures);
[[nodiscard]] std::string PartSection(const ReportData& data);
// How sure the verdicts are, and what that is made of.
[[nodiscard]] std::string TrustSection(const ReportData& data);
[[nodiscard]] std::string HeatSection(const ReportData& data, const ReportPictures& pictures);
[[nodiscard]] std::string EventSection(const ReportData& data);
[[nodiscard]] std::string PictureSection(const ReportPictures& pictures);
[[nodiscard]] std::string ReadingSection(const ReportData& data);
[[nodiscard]] std::string RigSection(const ReportData& data);

// A part of the rig's section: how far apart the instants are at which the cameras look, and which frames
// lack which camera. Empty: the cameras have no stamps.
[[nodiscard]] std::string SkewOfCameras(const ReportData& data);

// HTML: the spacings' values, each on a line.
[[nodiscard]] std::string SpacingTexts(const ReportData& data, const std::vector<double>& spacing_mm);

}  // namespace elbowroom::sessions
