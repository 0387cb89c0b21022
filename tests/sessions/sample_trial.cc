#include "tests/sessions/sample_trial.h"

#include <algorithm>
#include <cmath>

#include "sessions/session_writer.h"
#include "tests/sessions/sample_session.h"

namespace elbowroom::tests {
namespace {

constexpr double kFramesPerSecond = 10.0;
constexpr const char* kSpacingName = "PMT to payload A";

core::SessionHeader TrialHeader(const TrialPlan& plan) {
  core::SessionHeader header = SampleHeader();
  header.trial = {
      "3", "Screw the pipe into the receptacle and plug the power cable", plan.estimate_mm, 0.0, {"tongs"}};
  header.layout.spacings = {{kSpacingName, "payload A", "PMT box", core::Axis::kZ, 100.0, 300.0, 140.0}};
  header.versions = {
      {"elbowroom", "0.1.0"}, {"OpenGL", "Mesa llvmpipe (LLVM 15.0.6, 256 bits)"}, {"SQLite", "3.40.1"}};
  return header;
}

// How deep the touch is at that time; nothing outside it. Deepest in the middle.
std::optional<double> DepthAt(const TouchPlan& touch, double time_s) {
  if (time_s < touch.begin_s || time_s > touch.end_s) return std::nullopt;
  const double share = (time_s - touch.begin_s) / (touch.end_s - touch.begin_s);
  return touch.depth_mm * (0.1 + 0.9 * std::sin(3.14159265 * share));
}

double SpacingAt(const TrialPlan& plan, double time_s) {
  const double opened_steps = std::ceil((time_s - plan.opened_at_s) * kFramesPerSecond - 1e-9);
  return std::clamp(240.0 + 20.0 * opened_steps, 140.0, 240.0);
}

core::FrameRecord FrameAt(const core::SessionHeader& header, const TrialPlan& plan, core::FrameIndex frame) {
  core::FrameRecord record;
  record.frame = frame;
  record.time_s = static_cast<double>(frame) / kFramesPerSecond;
  record.masks =
      std::make_shared<const std::vector<core::SoftMask>>(2, core::SoftMask{core::BitMask(130, 97), {}});
  record.spacing_mm = {SpacingAt(plan, record.time_s)};
  record.contacts.resize(header.layout.parts.size());
  for (core::PartIndex i = 0; i < record.contacts.size(); ++i) record.contacts[i].part = i;
  for (const TouchPlan& touch : plan.touches) {
    const auto depth_mm = DepthAt(touch, record.time_s);
    if (!depth_mm) continue;
    core::PartContact& contact = record.contacts[static_cast<std::size_t>(touch.part)];
    contact.verdict = core::Verdict::kContact;
    contact.deepest = core::ContactPoint{{30.0 + *depth_mm, -12.0, 141.0}, *depth_mm, 4.0};
    contact.contact_area_mm2 = 20.0 * *depth_mm;
    contact.contact_point_count = 1 + static_cast<std::int64_t>(10.0 * *depth_mm);
    contact.points = {*contact.deepest};
  }
  return record;
}

void AppendEvents(sessions::SessionWriter& writer, const TrialPlan& plan, const core::FrameRecord& record) {
  const double before_mm = SpacingAt(plan, record.time_s - 1.0 / kFramesPerSecond);
  const auto happened = [&](auto what) {
    writer.Append(core::SessionEvent{record.frame, record.time_s, what});
  };
  if (before_mm != record.spacing_mm[0])
    happened(core::SpacingChanged{kSpacingName, before_mm, record.spacing_mm[0]});
  if (record.frame == 200) happened(core::ToolMarked{"tongs", true});
  if (record.frame == 500) happened(core::ToolMarked{"tongs", false});
}

core::ContactEpisode EpisodeOf(const core::SessionHeader& header, const TrialPlan& plan,
                               const TouchPlan& touch) {
  core::ContactEpisode episode;
  episode.part = static_cast<core::PartIndex>(touch.part);
  episode.begin_frame = static_cast<core::FrameIndex>(std::ceil(touch.begin_s * kFramesPerSecond - 1e-9));
  episode.end_frame = static_cast<core::FrameIndex>(std::floor(touch.end_s * kFramesPerSecond + 1e-9));
  for (core::FrameIndex frame = episode.begin_frame; frame <= episode.end_frame; ++frame) {
    const core::FrameRecord record = FrameAt(header, plan, frame);
    const core::PartContact& contact = record.contacts[episode.part];
    if (!contact.deepest || contact.deepest->depth_mm <= episode.peak_depth_mm) continue;
    episode.peak_frame = frame;
    episode.peak_time_s = record.time_s;
    episode.peak_depth_mm = contact.deepest->depth_mm;
    episode.peak_area_mm2 = contact.contact_area_mm2;
    episode.peak_position_in_world_mm = contact.deepest->position_in_world_mm;
    episode.spacing_at_peak_mm = record.spacing_mm;
  }
  episode.begin_time_s = static_cast<double>(episode.begin_frame) / kFramesPerSecond;
  episode.end_time_s = static_cast<double>(episode.end_frame) / kFramesPerSecond;
  episode.frames_in_contact = episode.end_frame - episode.begin_frame + 1;
  return episode;
}

}  // namespace

TrialPlan UsualTrial() {
  TrialPlan plan;
  plan.touches = {{1, 4.0, 5.2, 6.0},    {1, 8.1, 9.0, 11.0},  {0, 11.0, 16.4, 4.0}, {1, 14.0, 18.7, 23.0},
                  {1, 21.5, 29.9, 41.5}, {0, 24.0, 25.0, 2.2}, {1, 31.0, 33.0, 17.0}};
  return plan;
}

void WriteTrial(const std::filesystem::path& path, const TrialPlan& plan) {
  const core::SessionHeader header = TrialHeader(plan);
  sessions::SessionWriter writer(path, header);
  const auto frames = static_cast<core::FrameIndex>(std::lround(plan.duration_s * kFramesPerSecond));
  for (core::FrameIndex frame = 0; frame < frames; ++frame) {
    core::FrameRecord record = FrameAt(header, plan, frame);
    AppendEvents(writer, plan, record);
    writer.Append(std::move(record));
  }
  if (!plan.is_finished) return;
  std::vector<core::ContactEpisode> episodes;
  for (const TouchPlan& touch : plan.touches) {
    episodes.push_back(EpisodeOf(header, plan, touch));
    episodes.back().id = static_cast<core::EpisodeId>(episodes.size());
  }
  writer.Finish({episodes, {}, {}});
}

}  // namespace elbowroom::tests
