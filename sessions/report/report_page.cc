#include "sessions/report/report_page.h"

#include <fmt/format.h>

#include "sessions/report/html_page.h"
#include "sessions/report/markup.h"
#include "sessions/report/page_data.h"

namespace elbowroom::sessions {
namespace {

std::string TitleOf(const ReportData& data) {
  return data.header.trial.task.empty() ? "Trial" : Escaped(data.header.trial.task);
}

std::string PageHeader(const ReportData& data) {
  std::string facts;
  const auto add = [&](const std::string& fact) { facts += (facts.empty() ? "" : " &middot; ") + fact; };
  if (!data.header.trial.participant.empty()) add("participant " + Escaped(data.header.trial.participant));
  add("started " + Escaped(data.header.started_at_utc));
  add(fmt::format("{} frames over {:.1f} s", data.frames.size(), data.end_s - data.begin_s));
  add(fmt::format("rig {}, {} camera{}", Escaped(data.header.rig.name), data.header.rig.cameras.size(),
                  data.header.rig.cameras.size() == 1 ? "" : "s"));
  return fmt::format(
      "<header><p class='kicker'>Elbowroom trial report</p><h1>{}</h1><p class='facts'>{}</p></header>\n",
      TitleOf(data), facts);
}

std::string PageFooter(const ReportData& data) {
  return fmt::format(
      "<footer>Made from <b>{}</b>, which holds every frame behind these figures; contacts.csv beside this "
      "page lists each part in contact in each frame, clearance.csv how far each part was{}.</footer>\n",
      Escaped(data.session_name),
      data.stamps.empty() ? "" : ", stamps.csv which picture of each camera each frame took");
}

}  // namespace

std::string ModelSection(const ReportPictures& pictures) {
  if (pictures.model.moments.empty()) return "";
  return "<section id='model'><h2>In space</h2><p class='lead'>Parts, the hull of a moment and its contact "
         "points; balls are touches and near misses. A row of the table of touches selects its moment here, "
         "a "
         "ball its row. Drag to turn, wheel to come nearer.</p>\n<div class='model-place'><p>This view needs "
         "JavaScript and WebGL; the pictures of this page don&rsquo;t.</p></div></section>\n";
}

std::string ReportPage(const ReportData& data, const ReportPictures& pictures) {
  PageCharts charts;
  std::string body = PageHeader(data) + SummarySection(data) + TimelineSection(data, &charts) +
                     ModelSection(pictures) + PictureSection(pictures) + TouchSection(data, pictures) +
                     SpacingSection(data, &charts) + ApproachSection(data, &charts) + PartSection(data) +
                     TrustSection(data) + HeatSection(data, pictures) + EventSection(data) +
                     ReadingSection(data) + RigSection(data) + PageFooter(data);
  return HtmlPage(TitleOf(data), body, PageDataJson(data, charts, pictures.model));
}

}  // namespace elbowroom::sessions
