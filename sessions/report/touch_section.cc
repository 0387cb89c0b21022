#include <fmt/format.h>

#include <algorithm>

#include "sessions/charts/ink.h"
#include "sessions/report/markup.h"
#include "sessions/report/page_data.h"
#include "sessions/report/report_page.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

// Which columns the table has beside those that every touch fills.
struct TouchColumns {
  bool has_status = false;
  bool has_pictures = false;

  [[nodiscard]] int count() const { return 7 + (has_status ? 1 : 0) + (has_pictures ? 1 : 0); }
};

std::string Cell(const std::string& html, bool is_number) {
  return fmt::format("<td{}>{}</td>", is_number ? " class='n'" : "", html);
}

std::string TouchHead(const TouchColumns& columns) {
  return fmt::format(
      "<thead><tr><th>Touch</th>{}<th class='n'>Peak <small>or closest</small></th>"
      "<th class='n'>Lasted</th><th class='n'>Depth or distance <small>to the hull</small></th>"
      "<th class='n'>Area</th><th class='n'>Position <small>x, y, z in mm</small></th>"
      "<th class='n'>Spacing <small>then</small></th><th>Tools</th>{}</tr></thead>\n",
      columns.has_pictures ? "<th>Picture</th>" : "", columns.has_status ? "<th>Status</th>" : "");
}

std::string DepthCell(const ReportTouch& touch) {
  if (!touch.is_near_miss) return Millimetres(touch.depth_mm);
  const core::ClearanceInterval& closest = touch.closest->interval;
  return (touch.closest->has_witnesses
              ? fmt::format("{} to {}", Millimetres(closest.lower_mm), Millimetres(closest.upper_mm))
              : "at least " + Millimetres(closest.lower_mm)) +
         (touch.is_sure ? "" : "<small>maybe not below</small>");
}

std::string NameCell(const ReportData& data, const ReportTouch& touch) {
  const double fraction = data.deepest_mm > 0.0 ? touch.depth_mm / data.deepest_mm : 0.0;
  return fmt::format("<span class='dot' style='background:{}'></span>{}",
                     touch.is_near_miss ? ColorOf(Ink::kCaution) : DepthColour(fraction), NameOf(touch));
}

std::string ToolCell(const ReportTouch& touch) {
  std::string text;
  for (const std::string& tool : touch.tools)
    text += (text.empty() ? "" : ", ") + ("<bdi>" + Escaped(tool) + "</bdi>");
  return text.empty() ? "&ndash;" : text;
}

// Numbers of names in `names`, as the filters compare them.
std::string PlacesOf(const std::vector<std::string>& wanted, const std::vector<std::string>& names) {
  std::string places;
  for (const std::string& name : wanted) {
    const auto at = std::ranges::find(names, name);
    if (at != names.end()) places += fmt::format("{}{}", places.empty() ? "" : " ", at - names.begin());
  }
  return places;
}

std::string PictureCell(const ReportPictures& pictures, std::size_t touch) {
  const auto at = std::ranges::find(pictures.touches, touch, &ReportPictures::Touch::place);
  if (at == pictures.touches.end()) return "<td></td>";
  return fmt::format("<td><img class='snapshot' alt='' src='{}'></td>", PngAsDataUrl(at->png));
}

std::string TouchRow(const ReportData& data, std::size_t i, const TouchColumns& columns,
                     const ReportPictures& pictures) {
  const ReportTouch& touch = data.list.touches[i];
  const auto& at = touch.at_in_world_mm;
  std::string row = fmt::format(
      "<tr{} data-touch='{}' data-part='{}' data-kind='{}' data-tools='{}' data-status='{}'>",
      data.list.worst == i ? " class='worst'" : "", i, touch.part, touch.is_near_miss ? "near" : "touch",
      PlacesOf(touch.tools, ToolsMarked(data)), PlacesOf({touch.status}, StatusesOf(data)));
  row += Cell(NameCell(data, touch), false);
  if (columns.has_pictures) row += PictureCell(pictures, i);
  row += Cell(fmt::format("{:.2f} s <small>frame {}</small>", touch.time_s, touch.frame), true);
  row += Cell(fmt::format("{:.2f} s <small>from {:.2f} s</small>",
                          touch.end_s - touch.begin_s + data.frame_period_s, touch.begin_s),
              true);
  row += Cell(DepthCell(touch), true);
  row += Cell(touch.is_near_miss ? "&ndash;" : fmt::format("{:.0f} mm&sup2;", touch.area_mm2), true);
  row += Cell(at ? fmt::format("{:.0f}, {:.0f}, {:.0f}", at->x(), at->y(), at->z()) : "&ndash;", true);
  row += Cell(SpacingTexts(data, touch.spacing_mm), true) + Cell(ToolCell(touch), false);
  if (columns.has_status) row += Cell(Escaped(touch.status), false);
  return row + "</tr>\n";
}

std::string GroupHead(const ReportData& data, core::PartIndex part, const TouchColumns& columns) {
  const auto count = [&](bool near_misses) {
    return std::ranges::count_if(data.list.touches, [&](const ReportTouch& touch) {
      return touch.part == part && touch.is_near_miss == near_misses;
    });
  };
  return fmt::format(
      "<tr class='group'><th colspan='{}' scope='rowgroup'><bdi>{}</bdi> <small>touches: {}, near misses: "
      "{}</small></th></tr>\n",
      columns.count(), Escaped(data.header.layout.parts[part].name), count(false), count(true));
}

}  // namespace

std::string SpacingTexts(const ReportData& data, const std::vector<double>& spacing_mm) {
  std::string text;
  for (std::size_t i = 0; i < spacing_mm.size(); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : "<br>", Millimetres(spacing_mm[i]));
    if (data.spacings.size() > 1)
      text += " <small><bdi>" + Escaped(data.header.layout.spacings[i].name) + "</bdi></small>";
  }
  return text;
}

std::string TouchSection(const ReportData& data, const ReportPictures& pictures) {
  if (data.list.touches.empty()) return "";
  const TouchColumns columns{!StatusesOf(data).empty(), !pictures.touches.empty()};
  std::string rows;
  for (std::size_t i = 0; i < data.list.touches.size(); ++i) {
    const core::PartIndex part = data.list.touches[i].part;
    const bool begins = i == 0 || data.list.touches[i - 1].part != part;
    if (begins) rows += (i == 0 ? "" : "</tbody>") + ("<tbody>" + GroupHead(data, part, columns));
    rows += TouchRow(data, i, columns, pictures);
  }
  const std::string left_out =
      data.list.left_out == 0
          ? ""
          : fmt::format(" These are the worst; the session has {} more.", data.list.left_out);
  return fmt::format(
      "<section id='touches'><h2>Every touch and near miss</h2><p class='lead'>By part. The deepest touch is "
      "highlighted. A near miss is an approach below the required {} that ended without a touch; the real "
      "distance may be larger: the hull is larger than the hand.{}</p>\n<div class='scroll'><table>{}{}"
      "</tbody></table></div></section>\n",
      Millimetres(data.header.trial.required_clearance_mm), left_out, TouchHead(columns), rows);
}

}  // namespace elbowroom::sessions
