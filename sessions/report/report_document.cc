#include "sessions/report/report_document.h"

#include <fmt/format.h>

#include <utility>

namespace elbowroom::sessions {
namespace {

std::string TitleOf(const ReportData& data) {
  return data.header.trial.task.empty() ? "Trial" : data.header.trial.task;
}

std::vector<std::string> FactsOf(const ReportData& data) {
  std::vector<std::string> facts;
  if (!data.header.trial.participant.empty()) facts.push_back("participant " + data.header.trial.participant);
  if (!data.header.trial.condition.empty()) facts.push_back("condition " + data.header.trial.condition);
  if (data.header.trial.order > 0) facts.push_back(fmt::format("trial {}", data.header.trial.order));
  if (!data.header.trial.block.empty()) facts.push_back("block " + data.header.trial.block);
  facts.push_back("started " + data.header.started_at_utc);
  facts.push_back(fmt::format("{} frames over {:.1f} s", data.frames.size(), data.end_s - data.begin_s));
  facts.push_back(fmt::format("rig {}, {} camera{}", data.header.rig.name, data.header.rig.cameras.size(),
                              data.header.rig.cameras.size() == 1 ? "" : "s"));
  return facts;
}

RichText FooterOf(const ReportData& data) {
  RichText footer("Made from ");
  footer += Strong(data.session_name);
  footer += {.text = fmt::format(
                 ", which holds every frame behind these figures; beside this page: report.pdf (the same to "
                 "print), touches.bcfzip (the touches for CAD programs, BCF 2.1), contacts.csv (each part in "
                 "contact in each frame), clearance.csv (how far each part was){}.",
                 data.stamps.empty() ? "" : ", stamps.csv (which picture of each camera each frame took)")};
  return footer;
}

}  // namespace

Section ModelSection(const ReportPictures& pictures) {
  Section section{.id = "model", .blocks = {}, .is_for_screens = true};
  if (pictures.model.moments.empty()) return section;
  section.blocks = {
      Heading{"In space"},
      Paragraph{"Parts, the hull of a moment and its contact points; balls are touches and near misses. A "
                "row of the table of touches selects its moment here, a ball its row. Drag to turn, wheel to "
                "come nearer.",
                true},
      ModelView{}};
  return section;
}

ChartSections DrawCharts(const ReportData& data, ChartPainters* painters) {
  return {TimelineSection(data, painters), SpacingSection(data, painters), ApproachSection(data, painters)};
}

Document ReportDocument(const ReportData& data, const ReportPictures& pictures, ChartSections charts,
                        ChartPainters* painters) {
  Document document;
  document.kicker = "Elbowroom trial report";
  document.title = TitleOf(data);
  document.facts = FactsOf(data);
  document.footer = FooterOf(data);
  document.source = data.session_name;
  document.made_at_utc = data.ended_at_utc.value_or(data.header.started_at_utc);
  for (Section& section : std::vector{
           SummarySection(data), std::move(charts.timeline), ModelSection(pictures), PictureSection(pictures),
           TouchSection(data, pictures), ProcedureSection(data), std::move(charts.spacing),
           std::move(charts.approach), PairSection(data, pictures.pairs, painters), PartSection(data),
           TrustSection(data), HeatSection(data, pictures), EventSection(data), ReadingSection(data),
           SkippedSection(data), RigSection(data)}) {
    if (!section.blocks.empty()) document.sections.push_back(std::move(section));
  }
  return document;
}

}  // namespace elbowroom::sessions
