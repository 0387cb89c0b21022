#include "app/cli/trial_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>

#include "app/cli/light_json.h"
#include "app/cli/options/value_json.h"

namespace elbowroom::cli {

namespace {

const char* ToString(sessions::RecordingState state) {
  switch (state) {
    case sessions::RecordingState::kInFile:
      return "file";
    case sessions::RecordingState::kInMemory:
      return "memory";
    case sessions::RecordingState::kInSpill:
      return "spill";
  }
  return "";
}

// What only live cameras have.
void AddCapture(const control::TrialOutcome& outcome, CommandResult* result) {
  const std::optional<double> median_ms = outcome.latencies.MedianMs();
  if (!median_ms) return;
  const double p99_ms = *outcome.latencies.QuantileMs(0.99);
  const std::int64_t lost =
      std::accumulate(outcome.pictures_lost.begin(), outcome.pictures_lost.end(), std::int64_t{0});
  result->json["latency_ms"] = {{"median", *median_ms}, {"p99", p99_ms}};
  result->json["frames_without_camera"] = outcome.frames_without_camera;
  result->json["pictures_lost"] = outcome.pictures_lost;
  result->json["light"] = nlohmann::json::array();
  for (const recon::LightReport& light : outcome.light) result->json["light"].push_back(JsonOf(light));
  result->text += fmt::format(
      "\n  capture to verdict: {:.1f} ms in the median, {:.1f} ms in 99 %; {} pictures lost, "
      "{} frames lack a camera",
      *median_ms, p99_ms, lost, outcome.frames_without_camera);
}

void AddKnocks(const control::KnockReport& knocks, CommandResult* result) {
  result->json["knocks"] = {{"state", ToString(knocks.state)},
                            {"evidence_s", knocks.evidence_s},
                            {"frames_compared", knocks.frames_compared},
                            {"frames_skipped", knocks.frames_skipped},
                            {"noise_factor", knocks.noise_factor},
                            {"cameras", knocks.cameras},
                            {"since_s", OrNull(knocks.since_s)},
                            {"shift_px", OrNull(knocks.shift_px)},
                            {"shift_sigma_px", OrNull(knocks.shift_sigma_px)}};
  if (knocks.advice.empty()) return;
  result->json["warnings"].push_back(knocks.advice);
  result->text += "\nwarning: " + knocks.advice;
}

void AddFootage(const recon::FootageRecording& footage, CommandResult* result) {
  std::uint64_t unwritten = 0;
  for (const recon::CameraRecording& camera : footage.cameras) unwritten += camera.unwritten;
  result->json["footage"] = {{"rig", footage.rig_file.string()},
                             {"seconds", footage.seconds},
                             {"bytes", footage.bytes},
                             {"unwritten", unwritten}};
  constexpr double kBytesPerMb = 1e6;
  result->text += fmt::format("\n  footage: {:.1f} s, {:.1f} MB, {} pictures not written", footage.seconds,
                              static_cast<double>(footage.bytes) / kBytesPerMb, unwritten);
  if (!footage.rig_file.empty()) result->text += fmt::format("; '{}' plays it", footage.rig_file.string());
  for (const std::string& trouble : footage.Troubles()) {
    result->json["warnings"].push_back(trouble);
    result->text += "\nwarning: " + trouble;
  }
}

// The pair rules: of each where its parts were closest, and how long it was broken.
void AddPairs(const control::TrialOutcome& outcome, const core::Layout& layout, CommandResult* result) {
  nlohmann::json& pairs = result->json["pairs"] = nlohmann::json::array();
  constexpr int kMostNamed = 5;
  int broken = 0;
  std::string named;
  for (const control::PairTotal& total : outcome.pairs) {
    const review::PairClash& closest = total.closest;
    const std::string &a = layout.parts[closest.demand.a].name, &b = layout.parts[closest.demand.b].name;
    pairs.push_back({{"a", a},
                     {"b", b},
                     {"required_mm", closest.demand.required_mm},
                     {"authorised", closest.demand.authorised_contact},
                     {"verdict", ToString(closest.verdict)},
                     {"gap_mm", closest.gap ? nlohmann::json(closest.gap->distance_mm) : nullptr},
                     {"at_least_mm", closest.at_least_mm},
                     {"closest_s", total.closest_time_s},
                     {"ever_broken", total.was_broken},
                     {"broken_s", total.broken_s}});
    if (total.was_broken && ++broken <= kMostNamed)
      named += fmt::format("{}{} and {} ({}, {:.1f} mm, {:.1f} s)", named.empty() ? "" : ", ", a, b,
                           ToString(closest.verdict), closest.at_least_mm, total.broken_s);
  }
  if (broken > kMostNamed) named += fmt::format(" and {} more", broken - kMostNamed);
  if (broken > 0) result->text += "\n  pair rules broken: " + named;
}

}  // namespace

void RecordingLog::Print(const sessions::RecordingNews& news) {
  if (context_.tell) context_.tell(news.line);
  const std::lock_guard lock(mutex_);
  lines_.push_back(news.line);
}

void RecordingLog::AddTo(CommandResult* result) const {
  const std::lock_guard lock(mutex_);
  for (const std::string& line : lines_) {
    result->json["warnings"].push_back(line);
    result->text += "\nwarning: " + line;
  }
}

CommandResult SummaryOf(const control::TrialOutcome& outcome, const core::Layout& layout) {
  CommandResult result;
  result.json = {{"session", outcome.session.string()},
                 {"frames", outcome.frames},
                 {"frames_committed", outcome.frames_committed},
                 {"recorded_in", ToString(outcome.recording)},
                 {"warnings", nlohmann::json::array()},
                 {"ended", outcome.end_note},
                 {"parts", nlohmann::json::array()},
                 {"episodes", nlohmann::json::array()},
                 {"skipped",
                  {{"pixels", outcome.skipped.segmentation.skipped_pixels},
                   {"of_pixels", outcome.skipped.segmentation.pixels},
                   {"second_looks", outcome.skipped.segmentation.second_looks},
                   {"unchanged_silhouettes", outcome.skipped.hull.unchanged_silhouettes},
                   {"empty_silhouettes", outcome.skipped.hull.empty_silhouettes},
                   {"untraced_silhouettes", outcome.skipped.hull.untraced_silhouettes},
                   {"unchanged_parts", outcome.skipped.unchanged_parts},
                   {"triangles", outcome.skipped.triangles_skipped},
                   {"of_triangles", outcome.skipped.triangles_in_all},
                   {"queries", outcome.skipped.queries},
                   {"clearances_by_contact", outcome.skipped.clearances_by_contact},
                   {"clearances_by_ball", outcome.skipped.clearances_by_ball},
                   {"clearance_queries", outcome.skipped.clearance_queries},
                   {"of_pairs", outcome.skipped.pairs.pairs},
                   {"unchanged_pairs", outcome.skipped.pairs.unchanged},
                   {"pairs_moved_together", outcome.skipped.pairs.moved_together},
                   {"pairs_settled_by_bounds", outcome.skipped.pairs.settled_by_bounds}}},
                 {"near_misses", nlohmann::json::array()}};
  result.text = fmt::format("{}: {} frames, all on disk, {}", outcome.session.string(), outcome.frames,
                            outcome.end_note);
  if (const std::optional<double> median_ms = outcome.frame_times.MedianMs()) {
    result.json["median_frame_ms"] = *median_ms;
    result.text += fmt::format(" ({:.1f} ms a frame)", *median_ms);
  }
  AddCapture(outcome, &result);
  AddKnocks(outcome.knocks, &result);
  if (outcome.footage) AddFootage(*outcome.footage, &result);
  for (core::PartIndex i = 0; i < layout.parts.size(); ++i) {
    const auto episodes =
        std::count_if(outcome.episodes.begin(), outcome.episodes.end(),
                      [&](const core::ContactEpisode& episode) { return episode.part == i; });
    const std::optional<core::ErrorBudget>& budget = outcome.largest_budgets[i];
    result.json["parts"].push_back(
        {{"name", layout.parts[i].name},
         {"frames_in_contact", outcome.frames_in_contact[i]},
         {"episodes", episodes},
         {"largest_uncertainty_mm", budget ? nlohmann::json(budget->ExpandedMm()) : nullptr},
         {"largest_budget", budget ? JsonOf(*budget) : nlohmann::json()}});
    result.text += fmt::format("\n  {}: in contact in {} frames, {} episodes", layout.parts[i].name,
                               outcome.frames_in_contact[i], episodes);
  }
  AddPairs(outcome, layout, &result);
  for (const core::ContactEpisode& episode : outcome.episodes) {
    result.json["episodes"].push_back({{"part", layout.parts[episode.part].name},
                                       {"begin_frame", episode.begin_frame},
                                       {"peak_frame", episode.peak_frame},
                                       {"end_frame", episode.end_frame},
                                       {"peak_depth_mm", episode.peak_depth_mm}});
  }
  for (const core::NearMiss& miss : outcome.near_misses) {
    result.json["near_misses"].push_back({{"part", layout.parts[miss.part].name},
                                          {"verdict", ToString(miss.verdict)},
                                          {"begin_frame", miss.begin_frame},
                                          {"closest_frame", miss.closest_frame},
                                          {"end_frame", miss.end_frame},
                                          {"lower_mm", miss.closest.interval.lower_mm},
                                          {"upper_mm", miss.closest.interval.upper_mm}});
  }
  return result;
}

}  // namespace elbowroom::cli
