#include "app/control/study/study_tables.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/control/study/study_text.h"
#include "sessions/charts/ink.h"

namespace elbowroom::control {
namespace {

using sessions::ColorOf;
using sessions::DocumentCell;
using sessions::DocumentRow;
using sessions::DocumentTable;
using sessions::Ink;
using sessions::NameText;
using sessions::RichText;
using sessions::WithRemark;

struct LengthColumn {
  const char* title;
  std::optional<double> (*value)(const StudyRow&);
  Ink ink;
};

// Those of Table 3.
const std::vector<LengthColumn>& LengthColumns() {
  static const std::vector<LengthColumn> kColumns = {
      {"Estimate before, mm", [](const StudyRow& row) { return row.estimate_before_mm; }, Ink::kSpacing},
      {"Needed without tools, mm", [](const StudyRow& row) { return row.needed_without_tools_mm; },
       Ink::kTool},
      {"Needed, mm", [](const StudyRow& row) { return row.needed_mm; }, Ink::kText},
      {"Shortfall, mm", [](const StudyRow& row) { return row.shortfall_mm(); }, Ink::kTouched},
      {"Estimate after, mm", [](const StudyRow& row) { return row.estimate_after_mm; }, Ink::kCaution}};
  return kColumns;
}

DocumentCell LengthCell(const std::optional<double>& length_mm, Ink ink) {
  DocumentCell cell(RichText(LengthText(length_mm)));
  if (length_mm) cell.dot = ColorOf(ink);
  return cell;
}

std::optional<core::Summary> SummaryOf(const Study& study, const LengthColumn& column) {
  std::vector<double> lengths_mm;
  for (const StudyRow& row : study.rows)
    if (const auto length_mm = column.value(row)) lengths_mm.push_back(*length_mm);
  return lengths_mm.empty() ? std::nullopt : std::optional(core::Summarise(lengths_mm));
}

RichText GroupText(const std::string& condition, const core::Summary& summary) {
  RichText text = NameText(condition);
  text += sessions::Remark(
      summary.sd ? fmt::format("{} \u00b1 {:.3g}, n = {}", NumberText(summary.mean), *summary.sd, summary.n)
                 : fmt::format("{}, n = {}", NumberText(summary.mean), summary.n));
  return text;
}

// The value, and in a remark what it is of.
RichText TestText(const std::optional<core::MeanComparison>& test) {
  return test ? WithRemark(fmt::format("{:.2f}", test->t), fmt::format("df = {:.1f}", test->df)) : kNoFigure;
}

DocumentRow ComparisonRow(const Comparison& comparison) {
  const auto p_of = [](const auto& test) { return test ? ProbabilityText(test->p) : std::string(kNoFigure); };
  DocumentRow row{
      {GroupText(comparison.a, comparison.of_a), GroupText(comparison.b, comparison.of_b),
       TestText(comparison.means),
       comparison.corrected_p
           ? WithRemark(p_of(comparison.means), "corrected " + ProbabilityText(*comparison.corrected_p))
           : kNoFigure,
       comparison.effect_size ? fmt::format("{:.2f}", *comparison.effect_size) : kNoFigure,
       comparison.ranks ? WithRemark(p_of(comparison.ranks), fmt::format("U = {:g}", comparison.ranks->u))
                        : kNoFigure,
       comparison.pairs ? WithRemark(p_of(comparison.pairs), fmt::format("t = {:.2f}", comparison.pairs->t))
                        : kNoFigure,
       comparison.decisive_p ? ProbabilityText(*comparison.decisive_p) : kNoFigure}};
  row.is_highlighted = IsSure(comparison);
  return row;
}

}  // namespace

DocumentTable ParticipantTable(const Study& study) {
  DocumentTable table{{{"Participant"}}, {}};
  DocumentRow means{{RichText("Mean")}}, deviations{{RichText("SD")}};
  for (const LengthColumn& column : LengthColumns()) {
    table.columns.push_back({column.title, true});
    const std::optional<core::Summary> summary = SummaryOf(study, column);
    means.cells.emplace_back(summary ? LengthText(summary->mean) : kNoFigure);
    deviations.cells.emplace_back(summary ? LengthText(summary->sd) : kNoFigure);
  }
  for (const StudyRow& participant : study.rows) {
    DocumentRow row{{participant.sessions > 1 ? [&] {
      RichText text = NameText(participant.participant);
      text += sessions::Remark(CountText(participant.sessions, "session"));
      return text;
    }()
                                              : NameText(participant.participant)}};
    for (const LengthColumn& column : LengthColumns()) {
      const std::optional<double> length_mm = column.value(participant);
      const bool is_enough = column.ink == Ink::kTouched && length_mm && *length_mm <= 0.0;
      row.cells.push_back(LengthCell(length_mm, is_enough ? Ink::kFree : column.ink));
    }
    table.rows.push_back(std::move(row));
  }
  means.is_highlighted = true;
  table.rows.push_back(std::move(means));
  table.rows.push_back(std::move(deviations));
  return table;
}

DocumentTable ComparisonTable(const Study& study) {
  DocumentTable table{{{WithRemark("Condition", "mean \u00b1 SD")},
                       {WithRemark("against", "mean \u00b1 SD")},
                       {"t", true},
                       {"p", true},
                       {"Hedges' g", true},
                       {"p of ranks", true},
                       {"p of pairs", true},
                       {"decisive p", true}},
                      {}};
  std::string measure;
  for (const Comparison& comparison : study.comparisons) {
    if (measure != comparison.measure) {
      measure = comparison.measure;
      DocumentRow head{{RichText(NameOfCompared(measure, study.baseline))}};
      head.begins_group = true;
      table.rows.push_back(std::move(head));
    }
    table.rows.push_back(ComparisonRow(comparison));
  }
  return table;
}

DocumentTable CorrelationTable(const Study& study) {
  DocumentTable table{{{"Measure"}, {"n", true}, {"r", true}, {"p", true}}, {}};
  for (const MeasuresCorrelated& pair : study.correlations)
    table.rows.push_back(
        {{NameOfMeasure(pair.a == "needed_mm" ? pair.b : pair.a), std::to_string(pair.correlation.n),
          fmt::format("{:.2f}", pair.correlation.r), ProbabilityText(pair.correlation.p)}});
  return table;
}

DocumentTable SessionTable(const Study& study) {
  DocumentTable table{{{"Session"},
                       {"Participant"},
                       {"Condition"},
                       {"Trial", true},
                       {"Started"},
                       {"Touches", true},
                       {"Needed, mm", true}},
                      {}};
  for (const StudySession& session : study.sessions)
    table.rows.push_back(
        {{NameText(session.path.filename().string()), NameText(session.participant),
          session.condition.empty() ? RichText(kNoFigure) : NameText(session.condition),
          session.order > 0 ? std::to_string(session.order) : kNoFigure, session.started_at_utc,
          NumberText(session.Measured("touches")), LengthText(session.Measured("needed_mm"))}});
  return table;
}

}  // namespace elbowroom::control
