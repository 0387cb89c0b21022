#include "app/control/revisions/revision_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/control/revisions/revision_touches.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

using sessions::Chart;
using sessions::DocumentRow;
using sessions::DocumentTable;
using sessions::Heading;
using sessions::Ink;
using sessions::NameText;
using sessions::Paragraph;
using sessions::RichText;
using sessions::Section;
using sessions::Verdict;

constexpr const char* kNone = "\u2013";

std::string Motions(std::size_t count) {
  return fmt::format("{} recorded motion{}", count, count == 1 ? "" : "s");
}

// Whether a session's motion touches the revision at some step.
bool TouchesAnywhere(const std::vector<RevisionTouch>& of_session) {
  return std::ranges::any_of(of_session,
                             [](const RevisionTouch& touch) { return touch.frames_in_contact > 0; });
}

std::size_t TouchingAnywhere(const RevisionTouches& touches) {
  return static_cast<std::size_t>(std::ranges::count_if(touches.by_session, TouchesAnywhere));
}

std::string RangeText(const SpacingRange& range) {
  return range.from_mm == range.to_mm
             ? fmt::format("at {} = {:g} mm", range.spacing, range.from_mm)
             : fmt::format("at some gap of {}, {:g} to {:g} mm", range.spacing, range.from_mm, range.to_mm);
}

Section SummarySection(const SpacingRange& range, const SpacingSweep& sweep,
                       const std::vector<RevisionTouches>& touches) {
  Verdict verdict;
  for (std::size_t k = 0; k < touches.size(); ++k) {
    const std::size_t touching = TouchingAnywhere(touches[k]);
    if (touching > 0) verdict.outcome = Verdict::Outcome::kTouched;
    verdict.paragraphs.push_back(sweep.revisions[k].changed.empty()
                                     ? fmt::format("Revision {} changes no part.", sweep.revisions[k].name)
                                     : fmt::format("Revision {}: {} of {} touch what it changes, {}.",
                                                   sweep.revisions[k].name, touching,
                                                   Motions(sweep.sessions.size()), RangeText(range)));
  }
  Section section{.blocks = {std::move(verdict)}};
  const auto simulated = std::ranges::count_if(sweep.sessions, &SweptSession::is_simulated);
  if (simulated > 0)
    section.blocks.push_back(
        Paragraph{fmt::format("Simulated: {} of {}. Such motion was drawn, and says nothing about people.",
                              simulated, Motions(sweep.sessions.size())),
                  true});
  return section;
}

std::string ChangedText(const SweptRevision& revision) {
  std::string names;
  for (const core::PartIndex part : revision.changed)
    names += (names.empty() ? "" : ", ") + revision.parts[part];
  return names.empty() ? "nothing" : names;
}

// Values of a grid of gaps as ranges of neighbours: "120 to 160, 200".
std::string GapsText(const std::vector<double>& steps_mm, const std::vector<RevisionTouch>& of_session) {
  std::string text;
  for (std::size_t first = 0; first < steps_mm.size(); ++first) {
    if (of_session[first].frames_in_contact == 0) continue;
    std::size_t last = first;
    while (last + 1 < steps_mm.size() && of_session[last + 1].frames_in_contact > 0) ++last;
    text += fmt::format("{}{:g}", text.empty() ? "" : ", ", steps_mm[first]);
    if (last > first) text += fmt::format(" to {:g}", steps_mm[last]);
    first = last;
  }
  return text;
}

std::string LengthText(const std::optional<double>& length_mm) {
  return length_mm ? fmt::format("{:.1f}", *length_mm) : kNone;
}

// The revisions, and the recorded layout below.
Section RevisionSection(const SpacingSweep& sweep, const std::vector<RevisionTouches>& touches) {
  DocumentTable table{{{"Revision"},
                       {"Changes"},
                       {"Motions that touch it", true},
                       {"of", true},
                       {"All moved parts free from, mm", true}},
                      {}};
  for (std::size_t k = 0; k < touches.size(); ++k)
    table.rows.push_back(
        {{NameText(sweep.revisions[k].name), NameText(ChangedText(sweep.revisions[k])),
          std::to_string(TouchingAnywhere(touches[k])), std::to_string(sweep.sessions.size()),
          LengthText(sweep.revisions[k].all.all.smallest_free_mm)}});
  table.rows.push_back({{RichText("as recorded"), RichText(kNone), RichText(kNone),
                         std::to_string(sweep.sessions.size()), LengthText(sweep.all.all.smallest_free_mm)}});
  Section section{
      .blocks = {Heading{"Revisions"},
                 Paragraph{"A motion touches a revision if, in some frame at some gap, a part that the "
                           "revision changes is in contact. Free from: the smallest gap at which, as at all "
                           "above, nothing is in a part that the gap moves.",
                           true},
                 std::move(table)}};
  for (const SweptRevision& revision : sweep.revisions)
    for (const std::string& change : revision.changes)
      section.blocks.push_back(Paragraph{fmt::format("Revision {}: {}.", revision.name, change), true});
  return section;
}

// Over the gap, how many motions touch each revision, and how many touched the same parts as recorded.
Section ChartSection(const SpacingRange& range, const SpacingSweep& sweep,
                     const std::vector<RevisionTouches>& touches, sessions::ChartPainters* painters) {
  const std::vector<double> steps_mm = StepsOf(sweep);
  if (steps_mm.size() < 2) return {};
  Chart chart{"Motions that touch, over the gap",
              fmt::format("{}, mm", range.spacing),
              steps_mm.front(),
              steps_mm.back(),
              {}};
  for (std::size_t k = 0; k < touches.size(); ++k) {
    sessions::ChartPanel panel;
    panel.title =
        fmt::format("Motions that touch revision {}, of {}", sweep.revisions[k].name, sweep.sessions.size());
    panel.height_px = 120.0;
    panel.low = 0.0;
    panel.counts = true;
    sessions::ChartLine now{sweep.revisions[k].name, Ink::kTouched, {}};
    sessions::ChartLine before{"as recorded", Ink::kQuiet, {}};
    before.is_dashed = true;
    for (std::size_t step = 0; step < steps_mm.size(); ++step) {
      now.points.push_back({steps_mm[step], static_cast<double>(touches[k].touching[step])});
      before.points.push_back({steps_mm[step], static_cast<double>(touches[k].touching_before[step])});
    }
    now.has_marks = before.has_marks = true;
    panel.lines = {std::move(before), std::move(now)};
    chart.panels.push_back(std::move(panel));
  }
  return {.blocks = {Heading{"Over the gap"},
                     Paragraph{"Dashed: the motions that touch the recorded parts of the same names.", true},
                     sessions::Drawn(std::move(chart), painters)}};
}

// The motions that touch a revision, the deepest first.
Section MotionSection(const SpacingSweep& sweep, const std::vector<RevisionTouches>& touches) {
  constexpr std::size_t kMostRows = 200;
  struct Row {
    std::size_t session;
    RevisionTouch worst;
    double gap_mm;
  };
  const std::vector<double> steps_mm = StepsOf(sweep);
  Section section{.blocks = {Heading{"Motions that touch"}}};
  for (std::size_t k = 0; k < touches.size(); ++k) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < sweep.sessions.size(); ++i) {
      if (!TouchesAnywhere(touches[k].by_session[i])) continue;
      Row row{i, {}, 0.0};
      for (std::size_t step = 0; step < steps_mm.size(); ++step) {
        const RevisionTouch& touch = touches[k].by_session[i][step];
        if (touch.frames_in_contact == 0 || touch.deepest_mm < row.worst.deepest_mm) continue;
        row.worst = touch;
        row.gap_mm = steps_mm[step];
      }
      rows.push_back(row);
    }
    std::ranges::stable_sort(rows, std::ranges::greater(),
                             [](const Row& row) { return row.worst.deepest_mm; });
    section.blocks.push_back(Heading{"Revision " + sweep.revisions[k].name, true});
    if (rows.empty()) {
      section.blocks.push_back(Paragraph{"None.", true});
      continue;
    }
    DocumentTable table{{{"Session"},
                         {"Participant"},
                         {"Touches at the gaps, mm"},
                         {"Deepest, mm", true},
                         {"at the gap, mm", true},
                         {"Frames in contact there", true},
                         {"of", true}},
                        {}};
    for (const Row& row : std::span(rows).first(std::min(rows.size(), kMostRows))) {
      const SweptSession& session = sweep.sessions[row.session];
      table.rows.push_back({{NameText(session.path.filename().string()), NameText(session.participant),
                             GapsText(steps_mm, touches[k].by_session[row.session]),
                             fmt::format("{:.1f}", row.worst.deepest_mm), fmt::format("{:g}", row.gap_mm),
                             std::to_string(row.worst.frames_in_contact),
                             std::to_string(session.of_revisions[k].all.frames)}});
    }
    section.blocks.push_back(std::move(table));
    if (rows.size() > kMostRows)
      section.blocks.push_back(
          Paragraph{fmt::format("{} more are in revisions.csv.", rows.size() - kMostRows), true});
  }
  return section;
}

Section SkippedSection(const SpacingSweep& sweep) {
  const review::StudyCount& count = sweep.count;
  return {
      .blocks = {Heading{"What was computed"},
                 Paragraph{fmt::format(
                     "{} questions, one for each part, frame and gap, were asked of the hull; {} were "
                     "settled by another gap's answer, {} are about parts that the gap doesn't move. Parts "
                     "that a revision doesn't change have the recorded layout's answers.",
                     count.asked, count.settled_by_motion, count.unmoved)}}};
}

}  // namespace

sessions::Document RevisionDocument(const SpacingRange& range, const SpacingSweep& sweep,
                                    sessions::ChartPainters* painters) {
  core::Require(!sweep.revisions.empty(), "a report of revisions needs one");
  const std::vector<RevisionTouches> touches = TouchesOfRevisions(sweep);
  sessions::Document document;
  document.kicker = "Elbowroom revision report";
  document.title = "Which recorded motions touch the new CAD?";
  document.facts = {Motions(sweep.sessions.size()), fmt::format("{} frames", sweep.all.all.frames),
                    fmt::format("gap {}, {:g} to {:g} mm", range.spacing, range.from_mm, range.to_mm)};
  document.footer = "Beside this page: revisions.pdf (the same to print), revisions.csv (all figures).";
  document.source = fmt::format("{}; gap {}", Motions(sweep.sessions.size()), range.spacing);
  document.made_at_utc =
      std::ranges::max_element(sweep.sessions, {}, &SweptSession::started_at_utc)->started_at_utc;
  for (Section& section : std::array{SummarySection(range, sweep, touches), RevisionSection(sweep, touches),
                                     ChartSection(range, sweep, touches, painters),
                                     MotionSection(sweep, touches), SkippedSection(sweep)})
    if (!section.blocks.empty()) document.sections.push_back(std::move(section));
  return document;
}

}  // namespace elbowroom::control
