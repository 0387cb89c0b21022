#include "sessions/report/report_page.h"

#include <fmt/format.h>

#include "sessions/report/html_page.h"
#include "sessions/report/markup.h"

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

std::string ReportPage(const ReportData& data, const ReportPictures& pictures) {
  return HtmlPage(TitleOf(data), PageHeader(data) + SummarySection(data) + TimelineSection(data) +
                                     PictureSection(pictures) + SpacingSection(data) + EpisodeSection(data) +
                                     NearMissSection(data) + PartSection(data) + TrustSection(data) +
                                     HeatSection(data, pictures) + EventSection(data) + ReadingSection(data) +
                                     RigSection(data) + PageFooter(data));
}

}  // namespace elbowroom::sessions
