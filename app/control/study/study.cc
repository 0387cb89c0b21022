#include "app/control/study/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/spelling.h"
#include "core/statistics/bootstrap.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {
namespace {

constexpr double kStepMm = 10.0;
constexpr int kMostSteps = 60;
constexpr std::uint64_t kSeed = 3;  // any: the same study gives the same interval
constexpr std::size_t kFew = 10;    // participants, of whom little can be said for others

void TakeLarger(const std::optional<double>& value, std::optional<double>* largest) {
  if (value && (!*largest || **largest < *value)) *largest = value;
}

std::vector<StudyRow> RowsOf(const std::vector<StudySession>& sessions) {
  std::vector<StudyRow> rows;
  for (const StudySession& session : sessions) {
    if (rows.empty() || rows.back().participant != session.participant) rows.push_back({session.participant});
    StudyRow& row = rows.back();
    ++row.sessions;
    if (!row.estimate_before_mm) row.estimate_before_mm = session.estimate_before_mm;
    if (session.estimate_after_mm) row.estimate_after_mm = session.estimate_after_mm;
    TakeLarger(session.Measured("needed_without_tools_mm"), &row.needed_without_tools_mm);
    TakeLarger(session.Measured("needed_mm"), &row.needed_mm);
  }
  return rows;
}

// A row of which one session needs more than all that was tried has no answer. One that needs less than that
// changes nothing: the largest of the others is still the largest.
void DropUnansweredNeeds(const std::vector<StudySession>& sessions, std::vector<StudyRow>* rows) {
  for (const StudySession& session : sessions) {
    const auto row = std::ranges::find(*rows, session.participant, &StudyRow::participant);
    if (session.needed.is_above) row->needed_mm.reset();
    if (session.needed_without_tools.is_above) row->needed_without_tools_mm.reset();
  }
}

// Of the sessions whose need lies beyond the gaps that were tried.
std::vector<std::string> RangeNotes(const Study& study) {
  std::vector<std::string> notes;
  for (const StudySession& session : study.sessions) {
    if (session.needed.is_above)
      notes.push_back(fmt::format(
          "{}: touched at the largest gap tried, {:g} mm: what is needed isn't known; give a larger range",
          session.path.string(), study.range.to_mm));
    if (session.needed.is_below || session.needed_without_tools.is_below)
      notes.push_back(fmt::format(
          "{}: free {}at the smallest gap tried, {:g} mm: less may be enough, so what is needed "
          "isn't known; give a range that begins lower",
          session.path.string(), session.needed.is_below ? "" : "without tools ", study.range.from_mm));
  }
  return notes;
}

// Conditions that are compared and have few participants, in a study that has enough.
std::string FewInConditionsNote(const Study& study) {
  std::map<std::string, std::size_t> few;  // the least of a condition's participants in a comparison
  for (const Comparison& comparison : study.comparisons)
    for (const auto& [condition, n] :
         {std::pair(comparison.a, comparison.of_a.n), {comparison.b, comparison.of_b.n}}) {
      if (n >= kFew) continue;
      std::size_t& least = few.try_emplace(condition, n).first->second;
      least = std::min(least, n);
    }
  std::string names;
  for (const auto& [condition, n] : few)
    names += fmt::format("{}'{}' {}", names.empty() ? "" : ", ", condition, n);
  return names.empty() ? names
                       : fmt::format(
                             "few participants in a condition, {}: p and effect sizes of their "
                             "comparisons say little about others",
                             names);
}

void RequireCondition(const std::vector<std::filesystem::path>& sessions, const std::string& baseline,
                      const std::stop_token& stop) {
  std::set<std::string> conditions;
  for (const std::filesystem::path& path : sessions) {
    core::ThrowIfStopped(stop, "the study");
    conditions.insert(sessions::SessionReader(path, stop).header().trial.condition);
  }
  if (conditions.contains(baseline)) return;
  conditions.erase("");
  const std::vector<std::string> names(conditions.begin(), conditions.end());
  throw core::Error(
      core::ErrorKind::kRange,
      fmt::format("--baseline: no session has the condition '{}'; {}", baseline,
                  names.empty()
                      ? std::string("none of them has one: set 'condition' in TRIAL.toml")
                      : core::SpellingAdvice(baseline, names,
                                             fmt::format("there is '{}'", fmt::join(names, "', '")))));
}

// Who did another condition and not the baseline, and what else has no counterpart in it.
std::vector<std::string> BaselineNotes(const Study& study) {
  std::set<std::string> with, without;
  for (const StudySession& session : study.sessions)
    if (session.condition == study.baseline) with.insert(session.participant);
  for (const StudySession& session : study.sessions)
    if (!session.condition.empty() && !with.contains(session.participant))
      without.insert(session.participant);
  std::vector<std::string> notes;
  if (!without.empty())
    notes.push_back(
        fmt::format("{} of {} participants have no trial in the baseline condition '{}' and aren't "
                    "compared: {}",
                    without.size(), study.rows.size(), study.baseline, fmt::join(without, ", ")));
  std::size_t values = 0;
  for (const auto& [measure, by_condition] : MeansByCondition(study.sessions))
    for (const auto& [condition, by_participant] : by_condition)
      for (const auto& [participant, value] : by_participant)
        values += condition != study.baseline && with.contains(participant) ? 1 : 0;
  if (values > study.beyond.size())
    notes.push_back(
        fmt::format("{} of {} values have no counterpart in the baseline condition '{}' of their "
                    "participant and aren't compared",
                    values - study.beyond.size(), values, study.baseline));
  return notes;
}

std::vector<std::string> NotesOf(const Study& study) {
  std::vector<std::string> notes = study.baseline.empty() ? std::vector<std::string>() : BaselineNotes(study);
  const auto count = [&](auto has) { return std::ranges::count_if(study.sessions, has); };
  if (const auto simulated = count([](const StudySession& session) { return session.is_simulated; });
      simulated > 0)
    notes.push_back(
        fmt::format("{} of {} sessions are simulated: their motion and estimates were drawn, and say nothing "
                    "about people",
                    simulated, study.sessions.size()));
  if (const auto without = count([](const StudySession& session) { return !session.has_code; }); without > 0)
    notes.push_back(
        fmt::format("{} of {} sessions name no participant: each counts as a participant of its own", without,
                    study.sessions.size()));
  std::ranges::move(RangeNotes(study), std::back_inserter(notes));
  const auto short_of = [&](const char* what, auto missing) {
    const auto rows = std::ranges::count_if(study.rows, missing);
    if (rows > 0) notes.push_back(fmt::format("{} of {} participants {}", rows, study.rows.size(), what));
  };
  short_of("gave no estimate before their trials: they aren't in the mean shortfall",
           [](const StudyRow& row) { return !row.estimate_before_mm; });
  short_of("gave no estimate after their trials", [](const StudyRow& row) { return !row.estimate_after_mm; });
  if (study.rows.size() < kFew) {
    notes.push_back(
        fmt::format("few participants, {}: intervals and p say little about others, and a bootstrap interval "
                    "of so few is too narrow",
                    study.rows.size()));
  } else if (std::string note = FewInConditionsNote(study); !note.empty()) {
    notes.push_back(std::move(note));
  }
  for (const Comparison& comparison : study.comparisons)
    if (comparison.in_both > 0 && !comparison.pairs) {
      notes.push_back(
          "some participants did both of two conditions, some one: Welch's test takes all for "
          "different people");
      break;
    }
  notes.push_back(
      "what is needed is found for the motion that was made: people move otherwise with more room");
  return notes;
}

}  // namespace

std::optional<double> StudyRow::shortfall_mm() const {
  return needed_mm && estimate_before_mm ? std::optional(*needed_mm - *estimate_before_mm) : std::nullopt;
}

bool IsSure(const Comparison& comparison) {
  return comparison.decisive_p && *comparison.decisive_p < 1.0 - kConfidence;
}

SpacingRange FullRange(const std::filesystem::path& session, const std::string& name,
                       const std::stop_token& stop) {
  const sessions::SessionReader reader(session, stop);
  const core::Layout& layout = reader.header().layout;
  if (name.empty() && layout.spacings.size() != 1) {
    std::string names;
    for (const core::Spacing& spacing : layout.spacings)
      names += (names.empty() ? "'" : ", '") + spacing.name + "'";
    throw core::Error(
        core::ErrorKind::kRange,
        names.empty()
            ? fmt::format("'{}': its layout has no gap, so no space can be studied; give the layout a "
                          "[[spacing]] before the trials are recorded",
                          session.string())
            : fmt::format("'{}': its layout has several gaps, {}: choose one by --spacing NAME",
                          session.string(), names));
  }
  const core::Spacing& spacing =
      name.empty() ? layout.spacings.front() : layout.spacings[core::RequireSpacing(layout, name)];
  const double width_mm = spacing.max_mm - spacing.min_mm;
  return {spacing.name, spacing.min_mm, spacing.max_mm, std::max(kStepMm, std::ceil(width_mm / kMostSteps))};
}

Study MakeStudy(const SweepRequest& request, const core::Progress& progress, const std::stop_token& stop,
                const std::string& baseline) {
  if (!baseline.empty()) RequireCondition(request.sessions, baseline, stop);
  Study study;
  study.range = request.range;
  study.baseline = baseline;
  study.sweep = SweepSpacing(request, progress, stop);
  DwellSum dwell;
  for (const SweptSession& swept : study.sweep.sessions) {
    progress.Report(static_cast<std::int64_t>(study.sessions.size()),
                    static_cast<std::int64_t>(study.sweep.sessions.size()), "reading the sessions");
    const sessions::SessionReader reader(swept.path, stop);
    StudySession session = ReadStudySession(reader);
    dwell.Add(reader);
    const core::Layout& layout = reader.header().layout;
    AddNeeds(swept, layout.spacings[core::RequireSpacing(layout, request.range.spacing)].min_mm, &session);
    study.sessions.push_back(std::move(session));
  }
  NameParticipantsApart(&study.sessions);
  study.dwell = dwell.parts();
  const auto place = [](const StudySession& session) {
    return std::tie(session.participant, session.order, session.started_at_utc, session.path);
  };
  std::ranges::stable_sort(study.sessions, [&](const auto& a, const auto& b) { return place(a) < place(b); });
  study.rows = RowsOf(study.sessions);
  DropUnansweredNeeds(study.sessions, &study.rows);
  std::vector<double> shortfalls_mm;
  for (const StudyRow& row : study.rows)
    if (const auto shortfall_mm = row.shortfall_mm()) shortfalls_mm.push_back(*shortfall_mm);
  if (!shortfalls_mm.empty()) {
    study.shortfall_mm = core::Summarise(shortfalls_mm);
    study.shortfall_interval_mm = core::MeanInterval(*study.shortfall_mm, kConfidence);
    study.shortfall_bootstrap_mm = core::BootstrapMean(shortfalls_mm, kConfidence, kSeed);
  }
  study.compared = MeansByCondition(study.sessions);
  if (!baseline.empty()) {
    study.beyond = BeyondTheBaseline(study.compared, baseline);
    study.compared = DifferencesByCondition(study.beyond);
  }
  study.comparisons = CompareConditions(study.compared);
  study.correlations = CorrelateWithNeed(study.sessions);
  study.notes = NotesOf(study);
  if (dwell.left_out() > 0)
    study.notes.push_back(fmt::format(
        "{} maps of touches aren't in the sums: their part has another shape than in the session before",
        dwell.left_out()));
  return study;
}

}  // namespace elbowroom::control
