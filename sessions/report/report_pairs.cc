#include <fmt/format.h>

#include "sessions/report/pair_course.h"
#include "sessions/report/report_document.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

std::string GapText(const PairDistance& distance) {
  return distance.gap_mm ? fmt::format("{:.2f} mm", *distance.gap_mm)
                         : "at least " + Millimetres(distance.at_least_mm);
}

std::string VerdictOf(const RuledPair& pair, const PairDistance& distance) {
  if (distance.verdict == core::Verdict::kContact && pair.authorised_contact)
    return "contact, which is allowed";
  return std::string(core::ToString(distance.verdict));
}

DocumentTable TableOf(const ReportData& data, const PairApproaches& approaches,
                      const std::vector<PairCourse>& courses) {
  DocumentTable table{{{"Parts"},
                       {"Required", true},
                       {WithRemark("Closest", "between their surfaces"), true},
                       {WithRemark("Spacing", "then"), true},
                       {"From", true},
                       {"Verdict"},
                       {"Rule not kept for", true}},
                      {}};
  for (const PairCourse& course : courses) {
    const RuledPair& pair = approaches.pairs[course.pair];
    const PairDistance& distance = course.closest_distance();
    RichText names;
    names += NameRun(data.header.layout.parts[pair.a].name);
    names += {.text = " and "};
    names += NameRun(data.header.layout.parts[pair.b].name);
    table.rows.push_back({{std::move(names), Millimetres(pair.required_mm), GapText(distance),
                           SpacingTexts(data, course.closest->spacing_mm),
                           fmt::format("{:.2f} s", course.time_s), VerdictOf(pair, distance),
                           course.broken_s > 0.0 ? fmt::format("{:.1f} s", course.broken_s) : kNothing}});
  }
  return table;
}

}  // namespace

Section PairSection(const ReportData& data, const PairApproaches& approaches, ChartPainters* painters) {
  const std::vector<PairCourse> courses = CoursesOf(data, approaches);
  if (courses.empty()) return {};
  std::string lead =
      "Virtual parts against each other, by the layout\u2019s pair rules, where the spacings put them: the "
      "gap "
      "between their surfaces, or a lower bound of it (dashed) where that shows that the rule is kept.";
  if (courses.size() > kMostPairPanels)
    lead += fmt::format(" Drawn for {} of {} pairs, those nearest to breaking their rule.", kMostPairPanels,
                        courses.size());
  if (approaches.judged.size() < approaches.settings)
    lead +=
        fmt::format(" {} of {} settings of the spacings were judged: those held longest, and the extremes.",
                    approaches.judged.size(), approaches.settings);
  return {.blocks = {Heading{"Parts against parts"}, Paragraph{std::move(lead), true},
                     Drawn(PairChart(data, approaches, courses), painters),
                     TableOf(data, approaches, courses)}};
}

Section SkippedSection(const ReportData& data) {
  DocumentTable table{{{"Part"},
                       {WithRemark("Triangles", "over all frames"), true},
                       {WithRemark("Settled together", "the hull was surely too far away"), true},
                       {WithRemark("Questions", "asked of the hull"), true}},
                      {}};
  for (const PartSummary& part : data.parts) {
    const core::QueryCount& count = part.frames.count;
    if (count.triangles == 0) continue;
    table.rows.push_back(
        {{NameText(data.header.layout.parts[part.frames.part].name), std::to_string(count.triangles),
          fmt::format("{} ({:.1f} %)", count.skipped,
                      100.0 * static_cast<double>(count.skipped) / static_cast<double>(count.triangles)),
          std::to_string(count.queries)}});
  }
  if (table.rows.empty()) return {};
  return {
      .blocks = {Heading{"What was skipped"},
                 Paragraph{"Triangles that were settled without a look at each, together with their "
                           "neighbours. A part that stood still before a hull that stayed kept its answer, "
                           "with its counts. What is skipped changes no verdict.",
                           true},
                 std::move(table)}};
}

}  // namespace elbowroom::sessions
