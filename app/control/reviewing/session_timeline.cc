#include "app/control/reviewing/session_timeline.h"

#include <algorithm>
#include <map>
#include <utility>
#include <variant>

#include "core/procedure/event_text.h"

namespace elbowroom::control {
namespace {

constexpr double kOneDragS = 1.0;

TimelineRow& RowOf(const std::string& part, std::vector<TimelineRow>* rows) {
  const auto row = std::ranges::find(*rows, part, &TimelineRow::part);
  if (row != rows->end()) return *row;
  return rows->emplace_back(TimelineRow{part, {}});
}

// Of one spacing: where it stood before the changes that are one mark, and when the last of them was.
struct Drag {
  std::size_t mark = 0;
  double from_mm = 0.0;
  double last_s = 0.0;
};

class MarkList {
 public:
  void Add(const core::SessionEvent& event) {
    std::visit([&](const auto& what) { Take(event.time_s, what); }, event.what);
  }
  [[nodiscard]] std::vector<TimelineMark> Marks() && { return std::move(marks_); }

 private:
  void Take(double time_s, const core::SpacingChanged& change) {
    const auto open = drags_.find(change.spacing);
    if (open == drags_.end() || time_s - open->second.last_s > kOneDragS) {
      drags_[change.spacing] = {marks_.size(), change.from_mm, time_s};
      marks_.push_back({MarkKind::kGap, time_s, {}});
    }
    Drag& drag = drags_[change.spacing];
    drag.last_s = time_s;
    marks_[drag.mark].text =
        core::EventText(core::SpacingChanged{change.spacing, drag.from_mm, change.to_mm});
  }
  void Take(double time_s, const core::ToolMarked& mark) { Add(MarkKind::kTool, time_s, mark); }
  void Take(double time_s, const core::Note& note) { Add(MarkKind::kNote, time_s, note); }
  void Take(double time_s, const core::StepMarked& mark) { Add(MarkKind::kStep, time_s, mark); }
  void Take(double time_s, const core::Bookmark& bookmark) { Add(MarkKind::kBookmark, time_s, bookmark); }
  void Take(double time_s, const core::EstimateGiven& given) { Add(MarkKind::kAnswer, time_s, given); }
  void Take(double time_s, const core::SurveyAnswered& answered) { Add(MarkKind::kAnswer, time_s, answered); }
  void Take(double time_s, const core::QuestionnaireAnswered& answered) {
    Add(MarkKind::kAnswer, time_s, answered);
  }

  void Add(MarkKind kind, double time_s, const core::EventContent& what) {
    marks_.push_back({kind, time_s, core::EventText(what)});
  }

  std::vector<TimelineMark> marks_;
  std::map<std::string, Drag> drags_;
};

}  // namespace

SessionTimeline TimelineOf(const ReviewedSession& session, const std::vector<ListedFinding>& findings) {
  SessionTimeline timeline;
  timeline.begin_s = session.frames().front().time_s;
  timeline.end_s = session.frames().back().time_s;
  for (const core::Part& part : session.header().layout.parts) timeline.rows.push_back({part.name, {}});
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const core::Finding& finding = findings[i].finding;
    if (!findings[i].worst_position) continue;
    RowOf(finding.part, &timeline.rows).spans.push_back({i, finding.kind, finding.begin_s, finding.end_s});
  }
  MarkList marks;
  for (const core::SessionEvent& event : session.events()) marks.Add(event);
  timeline.marks = std::move(marks).Marks();
  return timeline;
}

std::vector<TimelineRow> RowsOf(const core::Layout& layout, const core::SessionOutcome& outcome) {
  std::vector<TimelineRow> rows;
  for (const core::Part& part : layout.parts) rows.push_back({part.name, {}});
  for (const core::ContactEpisode& touch : outcome.episodes)
    rows.at(touch.part).spans.push_back({0, core::FindingKind::kTouch, touch.begin_time_s, touch.end_time_s});
  for (const core::NearMiss& miss : outcome.near_misses)
    rows.at(miss.part).spans.push_back({0, core::FindingKind::kNearMiss, miss.begin_time_s, miss.end_time_s});
  return rows;
}

std::optional<std::size_t> NextFinding(const std::vector<ListedFinding>& findings, std::size_t from_position,
                                       int step) {
  std::optional<std::size_t> next;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const auto& at = findings[i].worst_position;
    if (!at || (step > 0 ? *at <= from_position : *at >= from_position)) continue;
    const auto is_nearer = [&](std::size_t best) {
      return step > 0 ? *at < *findings[best].worst_position : *at > *findings[best].worst_position;
    };
    if (!next || is_nearer(*next)) next = i;
  }
  return next;
}

}  // namespace elbowroom::control
