#include <fmt/format.h>

#include <algorithm>

#include "sessions/charts/ink.h"
#include "sessions/report/page_data.h"
#include "sessions/report/report_document.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

// What the rows have in common.
struct TouchColumns {
  std::vector<std::string> tools;     // by which a page filters
  std::vector<std::string> statuses;  // likewise; none: the table has no such column
  bool has_pictures = false;
};

std::vector<DocumentColumn> ColumnsOf(const TouchColumns& columns) {
  std::vector<DocumentColumn> all = {{"Touch"}};
  if (columns.has_pictures) all.push_back({"Picture"});
  all.insert(all.end(), {{WithRemark("Peak", "or closest"), true},
                         {"Lasted", true},
                         {WithRemark("Depth or distance", "to the hull"), true},
                         {"Area", true},
                         {WithRemark("Position", "x, y, z in mm"), true},
                         {WithRemark("Spacing", "then"), true},
                         {"Tools"}});
  if (!columns.statuses.empty()) all.push_back({"Status"});
  return all;
}

DocumentCell NameCell(const ReportData& data, const ReportTouch& touch) {
  const double fraction = data.deepest_mm > 0.0 ? touch.depth_mm / data.deepest_mm : 0.0;
  DocumentCell cell(NameOf(touch));
  cell.dot = touch.is_near_miss ? ColorOf(Ink::kCaution) : DepthColour(fraction);
  return cell;
}

RichText ToolText(const ReportTouch& touch) {
  RichText text;
  for (const std::string& tool : touch.tools) {
    if (!text.empty()) text += {.text = ", "};
    text += NameRun(tool);
  }
  return text.empty() ? RichText(kNothing) : text;
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

DocumentCell PictureCell(const ReportPictures& pictures, std::size_t touch) {
  DocumentCell cell;
  const auto at = std::ranges::find(pictures.touches, touch, &ReportPictures::Touch::place);
  if (at != pictures.touches.end()) cell.png = at->png;
  return cell;
}

DocumentRow TouchRow(const ReportData& data, std::size_t i, const TouchColumns& columns,
                     const ReportPictures& pictures) {
  const ReportTouch& touch = data.list.touches[i];
  const auto& at = touch.at_in_world_mm;
  DocumentRow row{.cells = {NameCell(data, touch)}, .is_highlighted = data.list.worst == i};
  row.data = {{"touch", std::to_string(i)},
              {"part", std::to_string(touch.part)},
              {"kind", touch.is_near_miss ? "near" : "touch"},
              {"tools", PlacesOf(touch.tools, columns.tools)},
              {"status", PlacesOf({touch.status}, columns.statuses)}};
  if (columns.has_pictures) row.cells.push_back(PictureCell(pictures, i));
  const double lasted_s = touch.end_s - touch.begin_s + data.frame_period_s;
  row.cells.insert(
      row.cells.end(),
      {WithRemark(fmt::format("{:.2f} s", touch.time_s), fmt::format("frame {}", touch.frame)),
       WithRemark(fmt::format("{:.2f} s", lasted_s), fmt::format("from {:.2f} s", touch.begin_s)),
       DepthText(touch), touch.is_near_miss ? kNothing : fmt::format("{:.0f} mm\u00b2", touch.area_mm2),
       at ? fmt::format("{:.0f}, {:.0f}, {:.0f}", at->x(), at->y(), at->z()) : kNothing,
       SpacingTexts(data, touch.spacing_mm), ToolText(touch)});
  if (!columns.statuses.empty()) row.cells.emplace_back(touch.status);
  return row;
}

DocumentRow GroupHead(const ReportData& data, core::PartIndex part) {
  const auto count = [&](bool near_misses) {
    return std::ranges::count_if(data.list.touches, [&](const ReportTouch& touch) {
      return touch.part == part && touch.is_near_miss == near_misses;
    });
  };
  RichText head = NameText(data.header.layout.parts[part].name);
  head += Remark(fmt::format("touches: {}, near misses: {}", count(false), count(true)));
  return {.cells = {std::move(head)}, .begins_group = true};
}

}  // namespace

RichText DepthText(const ReportTouch& touch) {
  if (!touch.is_near_miss) return Millimetres(touch.depth_mm);
  const core::ClearanceInterval& closest = touch.closest->interval;
  RichText text = touch.closest->has_witnesses
                      ? fmt::format("{} to {}", Millimetres(closest.lower_mm), Millimetres(closest.upper_mm))
                      : "at least " + Millimetres(closest.lower_mm);
  if (!touch.is_sure) text += Remark("maybe not below");
  return text;
}

RichText SpacingTexts(const ReportData& data, const std::vector<double>& spacing_mm) {
  RichText text;
  for (std::size_t i = 0; i < spacing_mm.size(); ++i) {
    text += {.text = Millimetres(spacing_mm[i]), .begins_line = i > 0};
    if (data.spacings.size() > 1)
      text += {.text = data.header.layout.spacings[i].name, .emphasis = Emphasis::kRemark, .is_name = true};
  }
  return text;
}

Section TouchSection(const ReportData& data, const ReportPictures& pictures) {
  if (data.list.touches.empty()) return {};
  const TouchColumns columns{ToolsMarked(data), StatusesOf(data), !pictures.touches.empty()};
  DocumentTable table{ColumnsOf(columns), {}};
  for (std::size_t i = 0; i < data.list.touches.size(); ++i) {
    const core::PartIndex part = data.list.touches[i].part;
    if (i == 0 || data.list.touches[i - 1].part != part) table.rows.push_back(GroupHead(data, part));
    table.rows.push_back(TouchRow(data, i, columns, pictures));
  }
  const std::string left_out =
      data.list.left_out == 0
          ? ""
          : fmt::format(" These are the worst; the session has {} more.", data.list.left_out);
  const std::string lead = fmt::format(
      "By part. The deepest touch is highlighted. A near miss is an approach below the required {} that "
      "ended without a touch; the real distance may be larger: the hull is larger than the hand.{}",
      Millimetres(data.header.trial.required_clearance_mm), left_out);
  return {.id = "touches",
          .blocks = {Heading{"Every touch and near miss"}, Paragraph{lead, true}, std::move(table)}};
}

}  // namespace elbowroom::sessions
