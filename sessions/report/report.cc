#include "sessions/report/report.h"

#include <algorithm>
#include <array>
#include <future>
#include <map>
#include <system_error>
#include <tuple>

#include "core/error.h"
#include "sessions/charts/chart_painter.h"
#include "sessions/print/pdf.h"
#include "sessions/report/clearance_csv.h"
#include "sessions/report/contacts_csv.h"
#include "sessions/report/report_data.h"
#include "sessions/report/report_document.h"
#include "sessions/report/report_page.h"
#include "sessions/report/stamps_csv.h"
#include "sessions/report/whole_files.h"

namespace elbowroom::sessions {
namespace {

void RequirePng(std::span<const unsigned char> bytes) {
  constexpr std::array<unsigned char, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  core::Require(
      bytes.size() > kSignature.size() && std::ranges::equal(bytes.first(kSignature.size()), kSignature),
      "a report's picture is a PNG file's bytes");
}

}  // namespace

std::optional<core::ContactEpisode> WorstEpisode(std::span<const core::ContactEpisode> episodes) {
  const auto badness = [](const core::ContactEpisode& e) {
    return std::tuple(e.peak_depth_mm, e.peak_area_mm2, -e.peak_frame);
  };
  const auto worst = std::ranges::max_element(episodes, {}, badness);
  if (worst == episodes.end()) return std::nullopt;
  return *worst;
}

void WriteReport(const SessionReader& session, const ReportPictures& pictures,
                 const std::filesystem::path& out_dir) {
  if (!pictures.worst_moment_png.empty()) RequirePng(pictures.worst_moment_png);
  if (pictures.overview_png) RequirePng(*pictures.overview_png);
  for (const ReportPictures::Heat& heat : pictures.heat) RequirePng(heat.png);
  for (const ReportPictures::Touch& touch : pictures.touches) RequirePng(touch.png);
  const core::SessionHeader header = session.header();
  std::string contacts = ContactsCsv(header.layout, {}), clearances = ClearanceCsv(header, {});
  const ReportData data = CollectReportData(
      session, [&](const ContactRow& row) { contacts += ContactLine(header.layout, row); },
      [&](const ContactRow& row) { clearances += ClearanceLine(header, row); });
  ChartPainter painter;
  const Document document = ReportDocument(data, pictures, &painter);
  std::future<std::string> pdf = std::async(std::launch::async, [&] { return PdfOf(document); });
  std::map<std::string, std::string> files = {{"report.html", ReportPage(data, document, pictures.model)},
                                              {"contacts.csv", std::move(contacts)},
                                              {"clearance.csv", std::move(clearances)}};
  constexpr const char* kStampsFile = "stamps.csv";
  if (!data.stamps.empty()) files.emplace(kStampsFile, StampsCsv(data.header.rig, data.stamps));
  files.emplace("report.pdf", pdf.get());
  WriteWholeFiles(out_dir, files);
  // One of an earlier report in the same folder is of another session.
  std::error_code ignored;
  if (data.stamps.empty()) std::filesystem::remove(out_dir / kStampsFile, ignored);
}

}  // namespace elbowroom::sessions
