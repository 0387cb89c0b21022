#include "app/control/revisions/revision_files.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "app/control/revisions/revision_document.h"
#include "sessions/report/page_and_pdf.h"
#include "sessions/report/whole_files.h"
#include "sessions/tables/csv_text.h"

namespace elbowroom::control {
namespace {

std::string RevisionsCsv(const SpacingSweep& sweep) {
  const auto length = [](double length_mm) {
    return std::isfinite(length_mm) ? fmt::format("{}", length_mm) : std::string();
  };
  std::string csv =
      "revision,session,participant,spacing_mm,part,frames,frames_in_contact,frames_near,frames_undecided,"
      "frames_clear,deepest_mm,lower_mm,upper_mm,closest_frame\n";
  for (std::size_t k = 0; k < sweep.revisions.size(); ++k) {
    const SweptRevision& revision = sweep.revisions[k];
    for (const SweptSession& session : sweep.sessions) {
      const review::SpacingCurve& curve = session.of_revisions[k].all;
      for (const review::StudyStep& step : curve.steps) {
        for (const core::PartIndex i : revision.changed) {
          const review::PartAtSpacing& part = step.parts[i];
          csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", sessions::Quoted(revision.name),
                             sessions::Quoted(session.path.string()), sessions::Quoted(session.participant),
                             step.spacing_mm, sessions::Quoted(revision.parts[i]), curve.frames,
                             part.frames_in_contact, part.frames_near, part.frames_undecided,
                             part.frames_clear, part.deepest_mm, length(part.lower_mm), length(part.upper_mm),
                             part.closest_frame ? std::to_string(*part.closest_frame) : "");
        }
      }
    }
  }
  return csv;
}

}  // namespace

std::vector<std::filesystem::path> WriteRevisions(const SpacingRange& range, const SpacingSweep& sweep,
                                                  const std::filesystem::path& folder,
                                                  const core::Progress& progress,
                                                  const std::stop_token& stop) {
  sessions::ChartPainters painters;
  const sessions::Document document = RevisionDocument(range, sweep, &painters);
  sessions::PageAndPdf report = sessions::MakePageAndPdf(document, progress, stop);
  return sessions::WriteWholeFiles(folder, {{"revisions.csv", RevisionsCsv(sweep)},
                                            {"revisions.html", std::move(report.html)},
                                            {"revisions.pdf", std::move(report.pdf)}});
}

}  // namespace elbowroom::control
