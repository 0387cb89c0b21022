#include "app/control/study/study_files.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <utility>

#include "app/control/study/study_report.h"
#include "sessions/report/whole_files.h"
#include "sessions/tables/csv_text.h"

namespace elbowroom::control {
namespace {

std::string Field(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; }

std::string ParticipantsCsv(const Study& study) {
  std::string csv =
      "participant,sessions,estimate_before_mm,needed_without_tools_mm,needed_mm,shortfall_mm,estimate_after_"
      "mm\n";
  for (const StudyRow& row : study.rows)
    csv += fmt::format("{},{},{},{},{},{},{}\n", sessions::Quoted(row.participant), row.sessions,
                       Field(row.estimate_before_mm), Field(row.needed_without_tools_mm),
                       Field(row.needed_mm), Field(row.shortfall_mm()), Field(row.estimate_after_mm));
  return csv;
}

std::string SessionsCsv(const Study& study) {
  std::set<std::string> measures;
  for (const StudySession& session : study.sessions)
    for (const auto& [measure, value] : session.measures) measures.insert(measure);
  std::string csv =
      "session,participant,condition,order,started_at_utc,estimate_before_mm,estimate_after_mm,block";
  for (const std::string& measure : measures) csv += "," + sessions::Quoted(measure);
  csv += "\n";
  for (const StudySession& session : study.sessions) {
    csv += fmt::format("{},{},{},{},{},{},{},{}", sessions::Quoted(session.path.string()),
                       sessions::Quoted(session.participant), sessions::Quoted(session.condition),
                       session.order > 0 ? std::to_string(session.order) : "",
                       sessions::Quoted(session.started_at_utc), Field(session.estimate_before_mm),
                       Field(session.estimate_after_mm), sessions::Quoted(session.block));
    for (const std::string& measure : measures) csv += "," + Field(session.Measured(measure));
    csv += "\n";
  }
  return csv;
}

std::string ComparisonsCsv(const Study& study) {
  std::string csv =
      "measure,a,b,n_a,n_b,mean_a,mean_b,sd_a,sd_b,t,df,p,corrected_p,effect_size,u,p_ranks,in_both,t_pairs,"
      "df_pairs,p_pairs,decisive_p,baseline\n";
  for (const Comparison& c : study.comparisons) {
    const auto of = [](const auto& result, auto member) {
      return result ? Field((*result).*member) : std::string();
    };
    using core::MeanComparison, core::RankSumTest;
    csv += fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", sessions::Quoted(c.measure),
        sessions::Quoted(c.a), sessions::Quoted(c.b), c.of_a.n, c.of_b.n, c.of_a.mean, c.of_b.mean,
        Field(c.of_a.sd), Field(c.of_b.sd), of(c.means, &MeanComparison::t), of(c.means, &MeanComparison::df),
        of(c.means, &MeanComparison::p), Field(c.corrected_p), Field(c.effect_size),
        of(c.ranks, &RankSumTest::u), of(c.ranks, &RankSumTest::p), c.in_both,
        of(c.pairs, &MeanComparison::t), of(c.pairs, &MeanComparison::df), of(c.pairs, &MeanComparison::p),
        Field(c.decisive_p), sessions::Quoted(study.baseline));
  }
  return csv;
}

std::string BaselineCsv(const Study& study) {
  std::string csv = "participant,condition,measure,value,baseline,difference\n";
  for (const BeyondBaseline& row : study.beyond)
    csv +=
        fmt::format("{},{},{},{},{},{}\n", sessions::Quoted(row.participant), sessions::Quoted(row.condition),
                    sessions::Quoted(row.measure), row.value, row.baseline, row.difference());
  return csv;
}

}  // namespace

std::vector<std::filesystem::path> WriteStudy(const Study& study, const std::filesystem::path& folder,
                                              const core::Progress& progress, const std::stop_token& stop) {
  sessions::PageAndPdf report = MakeStudyReport(study, progress, stop);
  std::map<std::string, std::string> files = {{"participants.csv", ParticipantsCsv(study)},
                                              {"sessions.csv", SessionsCsv(study)},
                                              {"comparisons.csv", ComparisonsCsv(study)},
                                              {"report.html", std::move(report.html)},
                                              {"report.pdf", std::move(report.pdf)}};
  if (!study.baseline.empty()) files["baseline.csv"] = BaselineCsv(study);
  return sessions::WriteWholeFiles(folder, files);
}

}  // namespace elbowroom::control
