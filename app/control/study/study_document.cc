#include "app/control/study/study_document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "app/control/study/study_charts.h"
#include "app/control/study/study_tables.h"
#include "app/control/study/study_text.h"

namespace elbowroom::control {
namespace {

using sessions::Bullets;
using sessions::ChartPainters;
using sessions::Document;
using sessions::Heading;
using sessions::Paragraph;
using sessions::Picture;
using sessions::Section;
using sessions::Tile;
using sessions::Tiles;
using sessions::Verdict;

// The values that participants have of a length, and their mean.
struct Lengths {
  std::vector<double> values_mm;

  Lengths(const Study& study, const std::function<std::optional<double>(const StudyRow&)>& length) {
    for (const StudyRow& row : study.rows)
      if (const auto length_mm = length(row)) values_mm.push_back(*length_mm);
  }
  [[nodiscard]] double mean_mm() const { return core::Summarise(values_mm).mean; }
};

std::string TitleOf(const Study& study) {
  const std::string& task = study.sessions.front().task;
  const bool is_one_task =
      !task.empty() &&
      std::ranges::all_of(study.sessions, [&](const StudySession& session) { return session.task == task; });
  if (is_one_task) return task;
  if (study.shortfall_mm || study.comparisons.empty())
    return fmt::format("Space at '{}'", study.range.spacing);
  std::set<std::string> conditions;
  for (const StudySession& session : study.sessions)
    if (!session.condition.empty()) conditions.insert(session.condition);
  return fmt::format("Conditions compared: {}", fmt::join(conditions, ", "));
}

std::vector<std::string> FactsOf(const Study& study) {
  const auto started = [](const StudySession& session) { return session.started_at_utc; };
  const std::string first = started(*std::ranges::min_element(study.sessions, {}, started));
  const std::string last = started(*std::ranges::max_element(study.sessions, {}, started));
  return {
      CountText(study.rows.size(), "participant"), CountText(study.sessions.size(), "session"),
      first == last ? "started " + first : fmt::format("started between {} and {}", first, last),
      fmt::format("gap {}, {:g} to {:g} mm", study.range.spacing, study.range.from_mm, study.range.to_mm)};
}

// Of a study without estimates: whether its conditions differ.
Verdict ConditionVerdict(const Study& study) {
  const Comparison* surest = SurestOf(study.comparisons);
  if (surest == nullptr)
    return {
        Verdict::Outcome::kDoubtful,
        {"No participant has an estimate and a need that is known, and no two conditions can be compared: "
         "there is nothing to hold against each other."}};
  const auto differ = std::ranges::count_if(study.comparisons, IsSure);
  const std::string surest_of = study.comparisons.size() > 1
                                    ? fmt::format(" (the surest of {} comparisons)", study.comparisons.size())
                                    : std::string();
  const std::string what =
      fmt::format("'{}' against '{}', {}: {} against {} on average, {}{}.", surest->a, surest->b,
                  NameOfCompared(surest->measure, study.baseline), NumberText(surest->of_a.mean),
                  NumberText(surest->of_b.mean), PText(*surest->decisive_p), surest_of);
  return {Verdict::Outcome::kDoubtful,
          {differ == 0 ? "No difference between conditions is sure; what was found may be chance. " + what
                       : fmt::format("Conditions differ, in {} of {}. {}", differ,
                                     CountText(study.comparisons.size(), "comparison"), what)}};
}

// Who allocated too little, in one sentence, and whether that can be chance.
Verdict VerdictOf(const Study& study) {
  using Outcome = Verdict::Outcome;
  if (!study.shortfall_mm) return ConditionVerdict(study);
  const core::Summary& shortfall = *study.shortfall_mm;
  const bool is_short = shortfall.mean > 0.0;
  const std::string how_much = fmt::format("{} mm {}", LengthText(std::abs(shortfall.mean)),
                                           is_short ? "less than was needed" : "more than was needed");
  if (!study.shortfall_interval_mm)
    return {Outcome::kDoubtful,
            {fmt::format("One participant estimated {}: it says nothing about others.", how_much)}};
  const core::Interval& interval = *study.shortfall_interval_mm;
  const std::string bounds =
      fmt::format("{} to {} mm", LengthText(interval.lower), LengthText(interval.upper));
  if (interval.lower <= 0.0 && interval.upper >= 0.0)
    return {Outcome::kDoubtful,
            {fmt::format("On average participants estimated {}, but it may be chance: the 95 % interval of "
                         "the mean shortfall is {}.",
                         how_much, bounds)}};
  return {is_short ? Outcome::kTouched : Outcome::kFree,
          {fmt::format("On average participants estimated {}; the 95 % interval of the mean shortfall is {}.",
                       how_much, bounds)}};
}

// The one with the largest shortfall named.
std::string ShortfallSentence(const Study& study) {
  const auto shortfall = [](const StudyRow& row) {
    return row.shortfall_mm().value_or(-std::numeric_limits<double>::infinity());
  };
  const auto too_little =
      std::ranges::count_if(study.rows, [&](const StudyRow& row) { return shortfall(row) > 0.0; });
  const StudyRow& worst = *std::ranges::max_element(study.rows, {}, shortfall);
  std::string sentence =
      fmt::format("{} of {} estimated less than they needed", too_little, study.shortfall_mm->n);
  if (too_little > 0)
    sentence += fmt::format(", most of all {}: {} mm", worst.participant, LengthText(worst.shortfall_mm()));
  return sentence + ".";
}

std::optional<Tile> MeanTile(const char* title, const Lengths& lengths) {
  if (lengths.values_mm.empty()) return std::nullopt;
  return Tile{title, LengthText(lengths.mean_mm()) + " mm",
              fmt::format("mean of {}", CountText(lengths.values_mm.size(), "participant"))};
}

Tiles TilesOf(const Study& study) {
  Tiles tiles;
  const auto add = [&](std::optional<Tile> tile) {
    if (tile) tiles.tiles.push_back(std::move(*tile));
  };
  if (study.shortfall_mm)
    add(Tile{"Mean shortfall", LengthText(study.shortfall_mm->mean) + " mm",
             study.shortfall_mm->sd ? fmt::format("SD {} mm, of {}", LengthText(study.shortfall_mm->sd),
                                                  CountText(study.shortfall_mm->n, "participant"))
                                    : "of one participant"});
  const Lengths needed(study, [](const StudyRow& row) { return row.needed_mm; });
  if (!needed.values_mm.empty())
    add(Tile{"Space needed", LengthText(std::ranges::max(needed.values_mm)) + " mm",
             fmt::format("the most of {}; their mean is {} mm",
                         CountText(needed.values_mm.size(), "participant"), LengthText(needed.mean_mm()))});
  add(MeanTile("Estimate before",
               Lengths(study, [](const StudyRow& row) { return row.estimate_before_mm; })));
  add(MeanTile("Estimate after", Lengths(study, [](const StudyRow& row) { return row.estimate_after_mm; })));
  return tiles;
}

Section SummarySection(const Study& study) {
  Verdict verdict = VerdictOf(study);
  if (study.shortfall_mm && study.shortfall_mm->n > 1) verdict.paragraphs.push_back(ShortfallSentence(study));
  return {.blocks = {std::move(verdict), TilesOf(study)}};
}

Section ParticipantSection(const Study& study, ChartPainters* painters) {
  Section section{
      .blocks = {Heading{"Estimated and needed"},
                 Paragraph{"Needed is the smallest gap at which, as at all above, nothing of what was "
                           "recorded is in a moved part. The shortfall is what was needed less what was "
                           "estimated before.",
                           true},
                 ParticipantTable(study)}};
  if (study.shortfall_bootstrap_mm)
    section.blocks.push_back(
        Paragraph{fmt::format("95 % interval of the mean shortfall by bootstrap: {} to {} mm.",
                              LengthText(study.shortfall_bootstrap_mm->lower),
                              LengthText(study.shortfall_bootstrap_mm->upper)),
                  true});
  if (sessions::Chart chart = EstimateChart(study); !chart.panels.empty()) {
    section.blocks.push_back(
        Paragraph{"In the colours of the table: estimates before and after, and what was needed with and "
                  "without tools. A bar is the shortfall; a green one, what was estimated and not needed.",
                  true});
    section.blocks.push_back(sessions::Drawn(std::move(chart), painters));
  }
  return section;
}

Section NeedSection(const Study& study, ChartPainters* painters) {
  return {.blocks = {Heading{"How much space is enough"},
                     Paragraph{"The recorded motion judged at every gap: how often the moved part that is "
                               "touched most is touched, and in how many participants' motion nothing "
                               "touches at that gap and at all larger ones.",
                               true},
                     sessions::Drawn(NeedChart(study), painters)}};
}

Section ConditionSection(const Study& study, ChartPainters* painters) {
  if (study.comparisons.empty()) return {};
  Section section{
      .blocks = {Heading{"Conditions compared"},
                 Paragraph{"t and p: Welch's test, two-tailed; corrected by Holm over all rows. p of ranks: "
                           "Mann and Whitney's test. p of pairs: where the same participants did both. The "
                           "decisive p is that of pairs where there is one, else Welch's, corrected by Holm "
                           "over all rows; rows in which it is below 0.05 are marked.",
                           true}}};
  if (!study.baseline.empty())
    section.blocks.push_back(Paragraph{
        fmt::format("Each value is what a participant's trials in a condition have more than the same "
                    "participant's trials in the baseline condition '{}'.",
                    study.baseline),
        true});
  section.blocks.push_back(ComparisonTable(study));
  std::vector<sessions::Chart> charts = ConditionCharts(study);
  if (!charts.empty())
    section.blocks.push_back(Paragraph{
        "A thin mark is a participant, a tall one the mean, a frame the mean's 95 % interval.", true});
  for (sessions::Chart& chart : charts) {
    section.blocks.push_back(Heading{chart.x_name, true});
    section.blocks.push_back(sessions::Drawn(std::move(chart), painters));
  }
  return section;
}

Section CorrelationSection(const Study& study) {
  if (study.correlations.empty()) return {};
  return {
      .blocks = {
          Heading{"What goes together with the space needed"},
          Paragraph{"Pearson's r over the participants; p is not corrected for the number of rows.", true},
          CorrelationTable(study)}};
}

Section DwellSection(const Study& study, const std::vector<DwellPicture>& dwell) {
  Section section;
  for (const DwellPicture& picture : dwell) {
    if (section.blocks.empty()) section.blocks = {Heading{"Where parts were touched, in all sessions"}};
    section.blocks.push_back(Picture{
        picture.png,
        fmt::format("{}: how long in all, and how deep at most, each patch of about {:.0f} mm was touched in "
                    "{}.",
                    picture.part, core::kHeatPatchMm, CountText(picture.sessions, "session")),
        "Where the part was touched"});
  }
  if (study.dwell.size() > dwell.size())
    section.blocks.push_back(Paragraph{fmt::format("{} more parts were touched, each for a shorter time.",
                                                   study.dwell.size() - dwell.size()),
                                       true});
  return section;
}

Section NoteSection(const Study& study) {
  Bullets bullets;
  for (const std::string& note : study.notes) bullets.items.emplace_back(note + ".");
  return {.blocks = {Heading{"What these figures can't say"}, std::move(bullets)}};
}

Section SkippedSection(const Study& study) {
  const review::StudyCount& count = study.sweep.count;
  const std::int64_t questions = count.asked + count.settled_by_motion + count.unmoved;
  return {
      .blocks = {Heading{"What was computed"},
                 Paragraph{fmt::format(
                     "{} frames at {} gaps gave {} questions, one for each part, frame and gap: {} were "
                     "asked of the hull, {} were settled by another gap's answer, {} are about parts that "
                     "the gap doesn't move. {} frames were the same as the frame before.",
                     study.sweep.all.all.frames, study.sweep.all.all.steps.size(), questions, count.asked,
                     count.settled_by_motion, count.unmoved, count.unchanged_frames)}}};
}

}  // namespace

Document StudyDocument(const Study& study, const std::vector<DwellPicture>& dwell, ChartPainters* painters) {
  Document document;
  document.kicker = "Elbowroom study report";
  document.title = TitleOf(study);
  document.facts = FactsOf(study);
  document.footer = fmt::format(
      "Beside this page: report.pdf (the same to print), participants.csv, sessions.csv{} and "
      "comparisons.csv (all figures with all digits).",
      study.baseline.empty() ? "" : ", baseline.csv");
  document.source = fmt::format("{}; gap {}, {:g} to {:g} mm", CountText(study.sessions.size(), "session"),
                                study.range.spacing, study.range.from_mm, study.range.to_mm);
  document.made_at_utc =
      std::ranges::max_element(study.sessions, {}, &StudySession::started_at_utc)->started_at_utc;
  for (Section& section :
       std::vector{SummarySection(study), ParticipantSection(study, painters), NeedSection(study, painters),
                   ConditionSection(study, painters), CorrelationSection(study), DwellSection(study, dwell),
                   NoteSection(study), Section{.blocks = {Heading{"Sessions"}, SessionTable(study)}},
                   SkippedSection(study)})
    if (!section.blocks.empty()) document.sections.push_back(std::move(section));
  return document;
}

}  // namespace elbowroom::control
