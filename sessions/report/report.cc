#include "sessions/report/report.h"

#include <algorithm>
#include <array>
#include <future>
#include <memory>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/system/file_sync.h"
#include "core/system/whole_file.h"
#include "sessions/bcf/bcf_file.h"
#include "sessions/print/pdf.h"
#include "sessions/report/report_data.h"
#include "sessions/report/report_document.h"
#include "sessions/report/report_page.h"
#include "sessions/report/report_topics.h"
#include "sessions/tables/clearance_csv.h"
#include "sessions/tables/contacts_csv.h"
#include "sessions/tables/row_lines.h"
#include "sessions/tables/stamps_csv.h"

namespace elbowroom::sessions {
namespace {

void RequirePng(std::span<const unsigned char> bytes) {
  constexpr std::array<unsigned char, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  core::Require(
      bytes.size() > kSignature.size() && std::ranges::equal(bytes.first(kSignature.size()), kSignature),
      "a report's picture is a PNG file's bytes");
}

void RequirePngs(const ReportPictures& pictures) {
  if (!pictures.worst_moment_png.empty()) RequirePng(pictures.worst_moment_png);
  if (pictures.overview_png) RequirePng(*pictures.overview_png);
  for (const ReportPictures::Heat& heat : pictures.heat) RequirePng(heat.png);
  for (const ReportPictures::Touch& touch : pictures.touches) RequirePng(touch.png);
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

void WriteReport(const SessionReader& session, const PictureSource& draw,
                 const std::filesystem::path& out_dir) {
  const core::SessionHeader header = session.header();
  core::MakeFolder(out_dir);
  core::PendingFiles files;
  // A session may have more rows than there is memory for.
  core::PendingFile& contacts = files.Begin(out_dir / "contacts.csv");
  core::PendingFile& clearances = files.Begin(out_dir / "clearance.csv");
  contacts.Append(ContactsCsv(header.layout, {}));
  clearances.Append(ClearanceCsv(header, {}));
  std::future<std::unique_ptr<ChartPainters>> painters_made =
      std::async(std::launch::async, [] { return std::make_unique<ChartPainters>(); });  // meanwhile
  RowLines contact_lines(&contacts, [&](const ContactRow& row) { return ContactLine(header.layout, row); });
  RowLines clearance_lines(&clearances, [&](const ContactRow& row) { return ClearanceLine(header, row); });
  const ReportData data = CollectReportData(
      session, [&](const ContactRow& row) { contact_lines.Add(row); },
      [&](const ContactRow& row) { clearance_lines.Add(row); });
  contact_lines.Finish();
  clearance_lines.Finish();
  std::unique_ptr<ChartPainters> painters;
  std::future<ChartSections> charts = std::async(std::launch::async, [&] {
    painters = painters_made.get();
    return DrawCharts(data, painters.get());
  });
  const ReportPictures pictures = draw ? draw() : ReportPictures();  // meanwhile
  RequirePngs(pictures);
  ChartSections chart_sections = charts.get();
  const Document document = ReportDocument(data, pictures, std::move(chart_sections), painters.get());
  std::future<std::string> pdf = std::async(std::launch::async, [&] { return PdfOf(document); });
  files.Write(out_dir / "report.html", ReportPage(data, document, pictures.model));
  files.Write(out_dir / "touches.bcfzip", PackBcf(TopicsOf(session, data.list, pictures)));
  constexpr const char* kStampsFile = "stamps.csv";
  if (!data.stamps.empty()) files.Write(out_dir / kStampsFile, StampsCsv(data.header.rig, data.stamps));
  files.Write(out_dir / "report.pdf", pdf.get());
  files.RenameAll();
  // One of an earlier report in the same folder is of another session.
  std::error_code ignored;
  if (data.stamps.empty()) std::filesystem::remove(out_dir / kStampsFile, ignored);
}

void WriteTopics(const SessionReader& session, const ReportPictures& pictures,
                 const std::filesystem::path& file) {
  core::PendingFiles files;
  files.Write(file, PackBcf(TopicsOf(session, TouchesOf(session), pictures)));
  files.RenameAll();
}

}  // namespace elbowroom::sessions
