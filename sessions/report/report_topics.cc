#include "sessions/report/report_topics.h"

#include <fmt/format.h>

#include <map>

#include "sessions/bcf/review_import.h"
#include "sessions/report/report_document.h"

namespace elbowroom::sessions {
namespace {

constexpr const char* kAuthor = "elbowroom";
constexpr const char* kReal = "what is real (hands, tools)";

// From in front and above, far enough to see what is around the place.
TopicCamera CameraAt(const Eigen::Vector3d& place_mm) {
  constexpr double kDistanceMm = 700.0;
  TopicCamera camera;
  camera.direction = Eigen::Vector3d(-0.55, 0.69, -0.47).normalized();
  camera.up = camera.direction.cross(Eigen::Vector3d::UnitZ()).normalized().cross(camera.direction);
  camera.eye_mm = place_mm - kDistanceMm * camera.direction;
  return camera;
}

std::string SpacingsText(const core::Layout& layout, const ReportTouch& touch) {
  std::string text;
  for (core::SpacingIndex i = 0; i < touch.spacing_mm.size(); ++i)
    text += fmt::format("\n{}: {:.1f} mm", layout.spacings[i].name, touch.spacing_mm[i]);
  return text;
}

std::string HowFar(const ReportTouch& touch) {
  if (!touch.is_near_miss)
    return fmt::format("at least {:.1f} mm deep, over {:.0f} mm\u00b2", touch.depth_mm, touch.area_mm2);
  return PlainText(DepthText(touch)) + " away";
}

std::string DescriptionOf(const core::SessionHeader& header, const ReportTouch& touch) {
  std::string text = fmt::format(
      "What is real {} '{}' from {:.2f} to {:.2f} s of the trial of '{}': {}, worst at {:.2f} s (frame {}).",
      touch.is_near_miss ? "came too near to" : "touched", header.layout.parts[touch.part].name,
      touch.begin_s, touch.end_s, header.trial.participant, HowFar(touch), touch.time_s, touch.frame);
  if (touch.at_in_world_mm)
    text += fmt::format("\nPlace (world, mm): {:.1f}, {:.1f}, {:.1f}", touch.at_in_world_mm->x(),
                        touch.at_in_world_mm->y(), touch.at_in_world_mm->z());
  text += SpacingsText(header.layout, touch);
  for (const std::string& tool : touch.tools) text += "\ntool in use: " + tool;
  return text;
}

// Status, comments and times, as the session has them.
void AddReview(const core::Finding& finding, BcfTopic* topic) {
  topic->id = finding.id;
  topic->status = TopicStatusOf(finding.status());
  for (const core::ReviewRemark& remark : finding.remarks) {
    topic->modified_at_utc = remark.at_utc;
    topic->modified_by = remark.by;
    if (!remark.comment.empty())
      topic->comments.push_back(
          {core::RemarkId(finding.id, remark), remark.at_utc, remark.by, remark.comment});
  }
}

BcfTopic TopicOf(const SessionReader& session, const core::Finding& finding) {
  BcfTopic topic;
  topic.type = "Clash";
  topic.created_at_utc = session.ended_at_utc().value_or(session.header().started_at_utc);
  topic.created_by = kAuthor;
  topic.labels = {std::string(core::ToString(finding.kind)), finding.part};
  topic.components = {finding.part, kReal};
  AddReview(finding, &topic);
  return topic;
}

BcfTopic TopicOfAbsent(const SessionReader& session, const core::Finding& finding) {
  BcfTopic topic = TopicOf(session, finding);
  const bool is_gone = finding.presence == core::FindingPresence::kGone;
  topic.title = fmt::format("{} on {} ({})", core::ToString(finding.kind), finding.part,
                            is_gone ? "gone" : "not checked again");
  topic.labels.emplace_back(core::ToString(finding.presence));
  topic.description =
      fmt::format("From {:.2f} to {:.2f} s. In this replay {}", finding.begin_s, finding.end_s,
                  is_gone ? "its part and time were judged again, and it isn't there."
                          : "its part or time wasn't judged again.");
  return topic;
}

}  // namespace

std::vector<BcfTopic> TopicsOf(const SessionReader& session, const TouchList& list,
                               const ReportPictures& pictures) {
  const core::SessionHeader& header = session.header();
  std::map<core::FindingId, core::Finding> findings;
  for (core::Finding& finding : session.findings()) findings.emplace(finding.id, std::move(finding));
  std::vector<BcfTopic> topics;
  for (const ReportTouch& touch : list.touches) {
    BcfTopic topic = TopicOf(session, findings.at(touch.finding_id));
    topic.title =
        fmt::format("{}: {}, {}", NameOf(touch), header.layout.parts[touch.part].name, HowFar(touch));
    topic.description = DescriptionOf(header, touch);
    topic.labels.insert(topic.labels.end(), touch.tools.begin(), touch.tools.end());
    if (touch.at_in_world_mm) topic.camera = CameraAt(*touch.at_in_world_mm);
    topics.push_back(std::move(topic));
  }
  for (const ReportPictures::Touch& picture : pictures.touches) {
    topics[picture.place].camera = picture.camera;
    topics[picture.place].cut = picture.cut;
    topics[picture.place].snapshot_png = picture.png;
  }
  for (const auto& [id, finding] : findings)
    if (finding.presence != core::FindingPresence::kHere) topics.push_back(TopicOfAbsent(session, finding));
  return topics;
}

}  // namespace elbowroom::sessions
