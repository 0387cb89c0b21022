#include <fmt/format.h>

#include "sessions/report/report_document.h"

namespace elbowroom::sessions {
namespace {

void AddTexts(const std::map<std::string, std::string>& texts, const char* key_title,
              std::vector<Block>* blocks) {
  DocumentTable table{{{key_title}, {"Value"}}, {}};
  for (const auto& [key, value] : texts) table.rows.push_back({{key, value}});
  if (!table.rows.empty()) blocks->push_back(std::move(table));
}

DocumentTable CameraTable(const core::Rig& rig) {
  DocumentTable table{{{"Camera"},
                       {"Image", true},
                       {"Lens"},
                       {WithRemark("Focal lengths", "x, y in px"), true},
                       {WithRemark("Centre", "x, y, z in mm"), true}},
                      {}};
  for (const core::CameraModel& camera : rig.cameras) {
    const core::CameraCalibration& c = camera.calibration();
    const Eigen::Vector3d& at = camera.center_in_world();
    table.rows.push_back({{c.name, fmt::format("{} \u00d7 {}", c.image_width_px, c.image_height_px),
                           std::string(core::ToString(c.distortion_model)),
                           fmt::format("{:.1f}, {:.1f}", c.camera_matrix(0, 0), c.camera_matrix(1, 1)),
                           fmt::format("{:.0f}, {:.0f}, {:.0f}", at.x(), at.y(), at.z())}});
  }
  return table;
}

// Runs in turn plain and strong, beginning with a plain one.
RichText InTurn(const std::vector<std::string>& texts) {
  RichText rich;
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (!texts[i].empty())
      rich += {.text = texts[i], .emphasis = i % 2 == 1 ? Emphasis::kStrong : Emphasis::kPlain};
  return rich;
}

}  // namespace

Section ReadingSection(const ReportData& data) {
  const bool abstains = data.header.rig.unseen == core::UnseenPolicy::kAbstain;
  Bullets bullets;
  bullets.items = {
      InTurn({"Real objects (hands, tools, cables) are known by their ", "visual hull",
              ": all the space that every camera\u2019s silhouette allows. The hull holds the whole of what "
              "the silhouettes show and somewhat more, so it over-estimates: ",
              "contact errs on the safe side",
              ". A reported touch may have been a near miss; a part that is clear was missed by everything "
              "in the silhouettes."}),
      InTurn(
          {"A ", "touch",
           " is a run of frames in which a part reaches into the hull; gaps of a few frames are bridged."}),
      InTurn({"", "Depth",
              " is how far inside the hull the deepest sample of the part\u2019s surface lies, measured to "
              "the hull\u2019s surface; it is never over-stated for that sample. It is a distance, not a "
              "force."}),
      InTurn({"In a frame a part is in ", "contact", ", ", "near",
              " (not in contact, closer than was asked to be told), ", "clear", ", or ", "undecided",
              " (too close to call). ", "Near",
              " errs on the safe side as contact does: the real distance may be larger. ", "Clear",
              " is sure, as far as the silhouettes are right."}),
      InTurn(
          {"", "Space needed",
           fmt::format(" lies between the largest spacing with a touch and the smallest one above it that "
                       "was held for at least {:.0f} s without any. Trying a value between the two narrows "
                       "it. It says nothing of values that were not tried.",
                       kTriedFor_s)}),
      fmt::format("A point that a camera can\u2019t see counts as {}.",
                  abstains ? "open for that camera: the others decide" : "empty")};
  return {.blocks = {Heading{"How to read this"}, std::move(bullets)}};
}

Section RigSection(const ReportData& data) {
  const core::Rig& rig = data.header.rig;
  const Eigen::Vector3d &low = rig.workspace_mm.min(), &high = rig.workspace_mm.max();
  Section section{
      .blocks = {
          Heading{"Rig and software"},
          Paragraph{fmt::format("Rig {}; workspace {:.0f}, {:.0f}, {:.0f} to {:.0f}, {:.0f}, {:.0f} mm.",
                                rig.name, low.x(), low.y(), low.z(), high.x(), high.y(), high.z()),
                    true},
          CameraTable(rig)}};
  for (Block& block : SkewOfCameras(data)) section.blocks.push_back(std::move(block));
  AddTexts(data.header.versions, "Component", &section.blocks);
  AddTexts(data.header.settings, "Setting", &section.blocks);
  if (data.ended_at_utc) section.blocks.emplace_back(Paragraph{"Ended " + *data.ended_at_utc + ".", true});
  return section;
}

}  // namespace elbowroom::sessions
