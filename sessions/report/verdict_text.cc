#include "sessions/report/verdict_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace elbowroom::sessions {
namespace {

constexpr std::size_t kMostLevelsInASentence = 4;

std::string Number(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

std::string HowMany(std::int64_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : what.ends_with("ch") ? "es" : "s");
}

const SpacingStudy* Judged(const ReportData& data) {
  return data.judged_spacing ? &data.spacings[*data.judged_spacing] : nullptr;
}

// ", all with 'PMT to A' at 140 mm"
std::string AtWhichSpacings(const ReportData& data) {
  const SpacingStudy* study = Judged(data);
  if (study == nullptr || !study->largest_touched_mm) return "";
  const bool is_about_all_touches = std::ranges::all_of(data.parts, [&](const PartSummary& part) {
    return part.frames.frames_in_contact == 0 ||
           IsBoundedBy(data.header.layout, part.frames.part, study->spacing);
  });
  if (!is_about_all_touches) return "";
  std::vector<SpacingLevel> touched;
  for (const SpacingLevel& level : study->levels) {
    if (level.frames_in_contact > 0) touched.push_back(level);
  }
  const std::string name = data.header.layout.spacings[study->spacing].name;
  if (touched.size() == 1)
    return fmt::format(", all with '{}' at {}", name, Millimetres(touched[0].spacing_mm));
  if (touched.size() > kMostLevelsInASentence) {
    return fmt::format(", with '{}' from {} to {}", name, Number(touched.front().spacing_mm),
                       Millimetres(touched.back().spacing_mm));
  }
  std::vector<std::string> values;
  for (const SpacingLevel& level : touched) values.push_back(Number(level.spacing_mm));
  const std::string last = values.back();
  values.pop_back();
  return fmt::format(", with '{}' at {} and {} mm", name, fmt::join(values, ", "), last);
}

// ", up to 100 mm more than the participant's estimate of 140 mm"
std::string AgainstEstimate(const ReportData& data, const SpacingStudy& study) {
  const double estimate_mm = data.header.trial.estimate_mm;
  if (!(estimate_mm > 0.0)) return "";
  const std::string estimate = "the participant's estimate of " + Millimetres(estimate_mm);
  const auto& touched_mm = study.largest_touched_mm;
  const auto& free_mm = study.smallest_free_mm;
  if (free_mm && estimate_mm >= *free_mm) return "; " + estimate + " is enough";
  if (touched_mm && estimate_mm > *touched_mm)
    return "; " + estimate + " lies above what was touched and was not tried";
  if (touched_mm && free_mm)
    return fmt::format(", up to {} more than {}", Millimetres(*free_mm - estimate_mm), estimate);
  if (touched_mm) return ", more than " + estimate;
  return "; " + estimate + " was not tried";
}

bool IsAllOfTheTask(const ReportData& data) { return data.status == SessionStatus::kComplete; }

// The spacing that was enough for the task; nothing for a task that wasn't done to its end, as its rest might
// have touched something. (A touch shows that more space is needed, however the task goes on.)
std::optional<double> EnoughMm(const ReportData& data, const SpaceNeed& need) {
  return IsAllOfTheTask(data) ? need.smallest_free_mm : std::nullopt;
}

// "140–240 mm"
std::string RangeText(double least_mm, double most_mm) {
  if (Number(least_mm) == Number(most_mm)) return Millimetres(least_mm);
  return fmt::format("{}\u2013{}", Number(least_mm), Millimetres(most_mm));
}

std::string SpaceClause(const ReportData& data) {
  const SpacingStudy* study = Judged(data);
  if (study == nullptr) return "";
  if (!IsAllOfTheTask(data)) {
    return study->largest_touched_mm
               ? fmt::format("; the task needs more than {}", Millimetres(*study->largest_touched_mm))
               : "; what space the whole task needs isn't known";
  }
  const auto& touched_mm = study->largest_touched_mm;
  const auto& free_mm = study->smallest_free_mm;
  if (!touched_mm && !free_mm) return "";
  std::string clause;
  if (touched_mm && free_mm) {
    clause = fmt::format("the task needed more than {} and at most {}", Millimetres(*touched_mm),
                         Millimetres(*free_mm));
  } else if (touched_mm) {
    clause = fmt::format("the task needed more than {}, and no larger spacing was held free of touches",
                         Millimetres(*touched_mm));
  } else {
    clause = fmt::format("{} was enough, the smallest spacing tried", Millimetres(*free_mm));
  }
  return "; " + clause + AgainstEstimate(data, *study);
}

std::string WhatWasTouched(const ReportData& data) {
  const double duration_s = data.end_s - data.begin_s;
  if (data.frames.empty()) return "No frame was recorded";
  if (!data.has_contact() && IsAllOfTheTask(data))
    return fmt::format("Nothing was touched in {:.1f} s", duration_s);
  const std::string contacts =
      !data.has_contact() ? "nothing touched"
      : data.has_outcome  ? HowMany(static_cast<std::int64_t>(data.episodes.size()), "touch")
                          : fmt::format("contact in {} of {}", data.frames_in_contact,
                                        HowMany(static_cast<std::int64_t>(data.frames.size()), "frame"));
  switch (data.status) {
    case SessionStatus::kRecording:
      return fmt::format("The recording is under way: {:.1f} s so far with {}", duration_s, contacts);
    case SessionStatus::kCutOff:
    case SessionStatus::kAbandoned:
      return fmt::format("The recording broke off after {:.1f} s with {}", duration_s, contacts);
    case SessionStatus::kComplete:
      break;
  }
  return fmt::format("{} in {:.1f} s", contacts, duration_s);
}

}  // namespace

std::string Millimetres(double length_mm) { return Number(length_mm) + " mm"; }

std::string VerdictSentence(const ReportData& data) {
  return WhatWasTouched(data) + AtWhichSpacings(data) + SpaceClause(data) + ".";
}

std::string TouchesByPart(const ReportData& data) {
  std::vector<std::string> clauses;
  for (std::size_t i = 0; i < data.parts.size(); ++i) {
    const std::int64_t touches = data.parts[i].touches;
    clauses.push_back(fmt::format("{} on {}", touches == 0 ? "none" : std::to_string(touches),
                                  data.header.layout.parts[i].name));
  }
  return clauses.empty() ? "" : fmt::format("{}.", fmt::join(clauses, ", "));
}

std::string SpaceNeeded(const ReportData& data) {
  const SpacingStudy* study = Judged(data);
  if (study == nullptr) return "unknown";
  return NeedText(*study, IsAllOfTheTask(data));
}

std::string NeedText(const SpaceNeed& need, bool is_whole_task) {
  const auto& touched_mm = need.largest_touched_mm;
  const std::optional<double> enough_mm = is_whole_task ? need.smallest_free_mm : std::nullopt;
  if (!touched_mm && !enough_mm) return "unknown";
  if (!touched_mm) return "at most " + Millimetres(*enough_mm);
  if (!enough_mm) return "more than " + Millimetres(*touched_mm);
  return RangeText(*touched_mm, *enough_mm);
}

std::string SpaceProvided(const ReportData& data) {
  const SpacingStudy* study = Judged(data);
  if (study == nullptr || study->levels.empty()) return "unknown";
  return RangeText(study->levels.front().spacing_mm, study->levels.back().spacing_mm);
}

std::string Shortfall(const ReportData& data) {
  const SpacingStudy* study = Judged(data);
  const double estimate_mm = data.header.trial.estimate_mm;
  if (study == nullptr || !(estimate_mm > 0.0)) return "unknown";
  const auto& touched_mm = study->largest_touched_mm;
  const std::optional<double> enough_mm = EnoughMm(data, *study);
  if (enough_mm && *enough_mm <= estimate_mm) return "none";
  const bool is_too_little = touched_mm && *touched_mm >= estimate_mm;
  if (is_too_little && enough_mm) return RangeText(*touched_mm - estimate_mm, *enough_mm - estimate_mm);
  if (is_too_little) return "more than " + Millimetres(*touched_mm - estimate_mm);
  return enough_mm ? "at most " + Millimetres(*enough_mm - estimate_mm) : "unknown";
}

std::string GaugeFailure(const core::RigQuality& quality) {
  if (!quality.is_refuted()) return "";
  const core::RigGauge& gauge = *quality.gauge;
  return fmt::format(
      "The rig's gauge failed: a rod of {:.2f} mm measured {:.2f} mm, and {:.2f} mm is the bound ({} "
      "places). "
      "So no part counts as near or clear, but as undecided. Calibrate the rig again, and gauge it.",
      gauge.true_diameter_mm, gauge.diameter_mm, gauge.bound_mm, gauge.places);
}

}  // namespace elbowroom::sessions
