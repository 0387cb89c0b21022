#include "app/cli/recorded/session_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include "app/cli/options/value_json.h"
#include "core/plain_text.h"
#include "core/procedure/answers.h"
#include "core/procedure/scores.h"
#include "core/procedure/step_runs.h"

namespace elbowroom::cli {
namespace {

nlohmann::json OriginJson(const std::optional<core::SessionOrigin>& origin) {
  if (!origin) return nullptr;
  return {{"file", origin->file},
          {"recording_id", origin->recording_id},
          {"replayed_at_utc", origin->replayed_at_utc},
          {"changes", origin->changes}};
}

nlohmann::json PartsJson(const sessions::SessionReader& session) {
  nlohmann::json parts = nlohmann::json::array();
  for (const sessions::PartTotals& totals : session.part_totals())
    parts.push_back({{"part", session.header().layout.parts[totals.part].name},
                     {"frames_in_contact", totals.frames_in_contact},
                     {"frames_near", totals.frames_near},
                     {"frames_undecided", totals.frames_undecided},
                     {"frames_clear", totals.frames_clear}});
  return parts;
}

nlohmann::json SpacingsJson(const core::Layout& layout, const std::vector<sessions::FrameSummary>& frames) {
  nlohmann::json spacings = nlohmann::json::array();
  for (core::SpacingIndex i = 0; i < layout.spacings.size(); ++i) {
    nlohmann::json spacing = {
        {"spacing", layout.spacings[i].name}, {"least_mm", nullptr}, {"most_mm", nullptr}};
    if (!frames.empty()) {
      const auto value = [i](const sessions::FrameSummary& frame) { return frame.spacing_mm[i]; };
      spacing["least_mm"] = value(*std::ranges::min_element(frames, {}, value));
      spacing["most_mm"] = value(*std::ranges::max_element(frames, {}, value));
    }
    spacings.push_back(spacing);
  }
  return spacings;
}

nlohmann::json ReviewJson(const std::vector<core::Finding>& findings) {
  nlohmann::json review = {{"statuses", nlohmann::json::object()}};
  std::size_t remarks = 0;
  for (const core::Finding& finding : findings) {
    const std::string status(core::ToString(finding.status()));
    review["statuses"][status] = review["statuses"].value(status, 0) + 1;
    remarks += finding.remarks.size();
  }
  review["remarks"] = remarks;
  review["gone"] = std::ranges::count(findings, core::FindingPresence::kGone, &core::Finding::presence);
  review["not_checked"] =
      std::ranges::count(findings, core::FindingPresence::kNotChecked, &core::Finding::presence);
  return review;
}

template <typename Value>
nlohmann::json JsonOrNull(const std::optional<Value>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json StepsJson(const std::vector<core::SessionEvent>& events) {
  nlohmann::json steps = nlohmann::json::array();
  for (const core::StepRun& run : core::StepRunsOf(events))
    steps.push_back({{"step", run.step},
                     {"begin_s", run.begin_s},
                     {"end_s", JsonOrNull(run.end_s)},
                     {"duration_s", JsonOrNull(run.duration_s())}});
  return steps;
}

nlohmann::json SurveyJson(const core::TrialInfo& trial, const std::vector<core::SessionEvent>& events) {
  nlohmann::json survey = nlohmann::json::array();
  const std::vector<std::optional<int>> answers = core::AnswersOf(trial, events);
  for (std::size_t i = 0; i < answers.size(); ++i)
    survey.push_back({{"when", core::ToString(trial.survey[i].when)},
                      {"item", trial.survey[i].item},
                      {"scale", {trial.survey[i].least, trial.survey[i].most}},
                      {"answer", JsonOrNull(answers[i])}});
  return survey;
}

nlohmann::json AnswerJson(const std::optional<core::ItemAnswer>& answer) {
  if (!answer) return nullptr;
  return std::visit([](const auto& said) { return nlohmann::json(said); }, *answer);
}

nlohmann::json ItemsJson(const core::Questionnaire& questionnaire, const core::ItemAnswers& answers) {
  nlohmann::json items = nlohmann::json::array();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const core::QuestionnaireItem& item = questionnaire.items[i];
    nlohmann::json json = {
        {"id", item.id},
        {"text", item.text},
        {"kind", core::ToString(item.kind)},
        {"reversed", item.reversed},
        {"answer", AnswerJson(answers[i])},
        {"value", JsonOrNull(answers[i] ? core::ValueOf(item, *answers[i]) : std::nullopt)}};
    if (item.kind == core::ItemKind::kScale) json["scale"] = {item.least, item.most};
    if (item.kind == core::ItemKind::kNumber) json["range"] = {item.least, item.most};
    if (item.kind == core::ItemKind::kChoice) json["choices"] = item.choices;
    items.push_back(std::move(json));
  }
  return items;
}

nlohmann::json QuestionnairesJson(const core::TrialInfo& trial,
                                  const std::vector<core::SessionEvent>& events) {
  nlohmann::json questionnaires = nlohmann::json::array();
  for (const core::Questionnaire& questionnaire : trial.questionnaires) {
    const core::ItemAnswers answers = core::AnswersOf(questionnaire, events);
    nlohmann::json scores = nlohmann::json::array();
    for (const core::Score& score : questionnaire.scores)
      scores.push_back({{"score", score.name},
                        {"rule", core::ToString(score.rule)},
                        {"value", JsonOrNull(core::ScoreOf(questionnaire, score, answers))}});
    questionnaires.push_back({{"when", core::ToString(questionnaire.when)},
                              {"questionnaire", questionnaire.name},
                              {"items", ItemsJson(questionnaire, answers)},
                              {"scores", std::move(scores)}});
  }
  return questionnaires;
}

bool IsNearMissHere(const core::Finding& finding) {
  return finding.kind == core::FindingKind::kNearMiss && finding.presence == core::FindingPresence::kHere;
}

nlohmann::json NamesOf(const core::Rig& rig) {
  nlohmann::json names = nlohmann::json::array();
  for (const core::CameraModel& camera : rig.cameras) names.push_back(camera.name());
  return names;
}

std::string Shown(const nlohmann::json& text) { return core::OneLine(text.get<std::string>(), 120); }

std::string OriginText(const nlohmann::json& origin) {
  if (origin.is_null()) return "";
  std::string text = fmt::format("\n  replay of {}", Shown(origin["file"]));
  if (origin["changes"].empty()) text += ", unchanged";
  for (const nlohmann::json& change : origin["changes"]) text += "\n    changed: " + Shown(change);
  return text;
}

std::string QuestionnaireText(const nlohmann::json& questionnaire) {
  const auto answered = std::count_if(questionnaire["items"].begin(), questionnaire["items"].end(),
                                      [](const nlohmann::json& item) { return !item["answer"].is_null(); });
  std::string text = fmt::format(
      "\n  questionnaire '{}' {} the trial: {} of {} answered", Shown(questionnaire["questionnaire"]),
      questionnaire["when"].get<std::string>(), answered, questionnaire["items"].size());
  for (const nlohmann::json& score : questionnaire["scores"])
    text += fmt::format("; {} {}", Shown(score["score"]),
                        score["value"].is_null() ? "-" : fmt::format("{:.4g}", score["value"].get<double>()));
  return text;
}

}  // namespace

nlohmann::json SummaryJson(const sessions::SessionReader& session) {
  const core::SessionHeader& header = session.header();
  const std::vector<sessions::FrameSummary> frames = session.frames();
  const std::vector<core::ContactEpisode> episodes = session.episodes();
  const std::vector<core::Finding> findings = session.findings();
  const std::vector<core::SessionEvent> events = session.events();
  const std::vector<core::FootageFile> footage = session.footage();
  std::error_code unknown;
  nlohmann::json json = {
      {"session", session.path().string()},
      {"status", sessions::ToString(session.status())},
      {"schema", session.file_schema()},
      {"bytes", std::filesystem::file_size(session.path(), unknown)},
      {"recording_id", session.recording_id()},
      {"first_recording_id", session.first_recording_id()},
      {"origin", OriginJson(header.origin)},
      {"participant", header.trial.participant},
      {"task", header.trial.task},
      {"condition", header.trial.condition},
      {"block", header.trial.block},
      {"order", header.trial.order > 0 ? nlohmann::json(header.trial.order) : nlohmann::json()},
      {"estimate_mm", header.trial.estimate_mm},
      {"estimate_after_mm", JsonOrNull(core::EstimatesOf(header.trial, events).after_mm)},
      {"steps", StepsJson(events)},
      {"survey", SurveyJson(header.trial, events)},
      {"questionnaires", QuestionnairesJson(header.trial, events)},
      {"required_clearance_mm", header.trial.required_clearance_mm},
      {"tools", header.trial.tools},
      {"started_at_utc", header.started_at_utc},
      {"ended_at_utc", session.ended_at_utc() ? nlohmann::json(*session.ended_at_utc()) : nlohmann::json()},
      {"cameras", NamesOf(header.rig)},
      {"parts", PartsJson(session)},
      {"spacings", SpacingsJson(header.layout, frames)},
      {"frames", frames.size()},
      {"first_frame", frames.empty() ? nlohmann::json() : nlohmann::json(frames.front().frame)},
      {"seconds", frames.empty() ? 0.0 : frames.back().time_s - frames.front().time_s},
      {"touches", episodes.size()},
      {"near_misses", std::ranges::count_if(findings, IsNearMissHere)},
      {"events", events.size()},
      {"review", ReviewJson(findings)},
      {"footage_files", footage.size()},
      {"footage_bytes", std::accumulate(footage.begin(), footage.end(), std::int64_t{0},
                                        [](auto sum, const auto& file) { return sum + file.bytes; })},
      {"versions", header.versions},
      {"settings", header.settings}};
  double deepest_mm = 0.0;
  for (const core::ContactEpisode& episode : episodes)
    deepest_mm = std::max(deepest_mm, episode.peak_depth_mm);
  json["deepest_mm"] = episodes.empty() ? nlohmann::json() : nlohmann::json(deepest_mm);
  return json;
}

std::string SummaryText(const nlohmann::json& summary) {
  std::string text = fmt::format("{}: {}, begun {}", Shown(summary["session"]),
                                 summary["status"].get<std::string>(), Shown(summary["started_at_utc"]));
  text += OriginText(summary["origin"]);
  text +=
      fmt::format("\n  participant '{}', task '{}'", Shown(summary["participant"]), Shown(summary["task"]));
  text +=
      fmt::format("\n  {} frames, {:.1f} s, {} cameras, {:.1f} MB, schema {}", summary["frames"].get<int>(),
                  summary["seconds"].get<double>(), summary["cameras"].size(),
                  summary["bytes"].get<double>() / 1e6, summary["schema"].get<int>());
  text += fmt::format("\n  {} touches", summary["touches"].get<int>());
  if (!summary["deepest_mm"].is_null())
    text += fmt::format(" (the deepest {:.1f} mm)", summary["deepest_mm"].get<double>());
  text += fmt::format(", {} near misses, {} remarks of reviewers", summary["near_misses"].get<int>(),
                      summary["review"]["remarks"].get<int>());
  if (!summary["condition"].get<std::string>().empty())
    text += fmt::format("\n  condition '{}'", Shown(summary["condition"]));
  if (!summary["block"].get<std::string>().empty())
    text += fmt::format("\n  block '{}'", Shown(summary["block"]));
  for (const nlohmann::json& questionnaire : summary["questionnaires"])
    text += QuestionnaireText(questionnaire);
  for (const nlohmann::json& step : summary["steps"])
    text += fmt::format(
        "\n  step '{}': begun at {:.1f} s{}", Shown(step["step"]), step["begin_s"].get<double>(),
        step["duration_s"].is_null() ? ", not ended"
                                     : fmt::format(", for {:.1f} s", step["duration_s"].get<double>()));
  for (const nlohmann::json& part : summary["parts"])
    text +=
        fmt::format("\n  part '{}': {} frames in contact, {} near, {} undecided, {} clear",
                    Shown(part["part"]), part["frames_in_contact"].get<int>(), part["frames_near"].get<int>(),
                    part["frames_undecided"].get<int>(), part["frames_clear"].get<int>());
  for (const nlohmann::json& spacing : summary["spacings"]) {
    if (spacing["least_mm"].is_null()) continue;
    text += fmt::format("\n  spacing '{}': {:.1f} to {:.1f} mm", Shown(spacing["spacing"]),
                        spacing["least_mm"].get<double>(), spacing["most_mm"].get<double>());
  }
  return text;
}

}  // namespace elbowroom::cli
