#include <fmt/format.h>

#include "sessions/report/html_table.h"
#include "sessions/report/markup.h"
#include "sessions/report/report_page.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

std::string Texts(const std::map<std::string, std::string>& texts, const std::string& key_title) {
  HtmlTable table({{key_title}, {"Value"}});
  for (const auto& [key, value] : texts) table.Add({Escaped(key), Escaped(value)});
  return table.empty() ? "" : table.Html();
}

std::string CameraTable(const core::Rig& rig) {
  HtmlTable table({{"Camera"},
                   {"Image", true},
                   {"Lens"},
                   {"Focal lengths <small>x, y in px</small>", true},
                   {"Centre <small>x, y, z in mm</small>", true}});
  for (const core::CameraModel& camera : rig.cameras) {
    const core::CameraCalibration& c = camera.calibration();
    const Eigen::Vector3d& at = camera.center_in_world();
    table.Add({Escaped(c.name), fmt::format("{} &times; {}", c.image_width_px, c.image_height_px),
               Escaped(core::ToString(c.distortion_model)),
               fmt::format("{:.1f}, {:.1f}", c.camera_matrix(0, 0), c.camera_matrix(1, 1)),
               fmt::format("{:.0f}, {:.0f}, {:.0f}", at.x(), at.y(), at.z())});
  }
  return table.Html();
}

}  // namespace

std::string ReadingSection(const ReportData& data) {
  const bool abstains = data.header.rig.unseen == core::UnseenPolicy::kAbstain;
  return fmt::format(
      "<section><h2>How to read this</h2><ul>\n"
      "<li>Real objects (hands, tools, cables) are known by their <b>visual hull</b>: all the space that "
      "every camera&rsquo;s "
      "silhouette allows. The hull holds the whole of what the silhouettes show and somewhat more, so it "
      "over-estimates: <b>contact errs on the safe side</b>. A reported touch may have been a near miss; a "
      "part that is "
      "clear was missed by everything in the silhouettes.</li>\n"
      "<li>A <b>touch</b> is a run of frames in which a part reaches into the hull; gaps of a few frames are "
      "bridged.</li>\n"
      "<li><b>Depth</b> is how far inside the hull the deepest sample of the part&rsquo;s surface lies, "
      "measured to the "
      "hull&rsquo;s surface; it is never over-stated for that sample. It is a distance, not a force.</li>\n"
      "<li>In a frame a part is in <b>contact</b>, <b>near</b> (not in contact, closer than was asked to be "
      "told), "
      "<b>clear</b>, or <b>undecided</b> (too close to call). <b>Near</b> errs on the safe side as contact "
      "does: the real distance may be larger. <b>Clear</b> is sure, as far as the silhouettes are "
      "right.</li>\n"
      "<li><b>Space needed</b> lies between the largest spacing with a touch and the smallest one above it "
      "that was "
      "held for at least {:.0f} s without any. Trying a value between the two narrows it. It says nothing of "
      "values that "
      "were not tried.</li>\n"
      "<li>A point that a camera can&rsquo;t see counts as {}.</li>\n</ul></section>\n",
      kTriedFor_s, abstains ? "open for that camera: the others decide" : "empty");
}

std::string RigSection(const ReportData& data) {
  const core::Rig& rig = data.header.rig;
  const Eigen::Vector3d &low = rig.workspace_mm.min(), &high = rig.workspace_mm.max();
  std::string section = fmt::format(
      "<section><h2>Rig and software</h2><p class='lead'>Rig {}; workspace {:.0f}, {:.0f}, "
      "{:.0f} to {:.0f}, {:.0f}, {:.0f} mm.</p>\n",
      Escaped(rig.name), low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
  section += CameraTable(rig) + SkewOfCameras(data) + Texts(data.header.versions, "Component") +
             Texts(data.header.settings, "Setting");
  if (data.ended_at_utc) section += "<p class='lead'>Ended " + Escaped(*data.ended_at_utc) + ".</p>\n";
  return section + "</section>\n";
}

}  // namespace elbowroom::sessions
