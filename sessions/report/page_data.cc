#include "sessions/report/page_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "sessions/report/page_json.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

using Json = nlohmann::json;

std::string AsciiJson(const Json& json) {
  return WithoutTags(json.dump(-1, ' ', true, Json::error_handler_t::replace));
}

Json MomentOf(const ReportTouch& touch, const ReportModel& model) {
  const auto at = std::ranges::find(model.moments, touch.frame, &ReportModel::Moment::frame);
  return at == model.moments.end() ? Json() : Json(at - model.moments.begin());
}

Json TouchJson(const ReportData& data, const ReportTouch& touch, const ReportModel& model) {
  const std::string told = fmt::format("{} on {}, frame {} ({:.2f} s).", NameOf(touch),
                                       data.header.layout.parts[touch.part].name, touch.frame, touch.time_s);
  Json json = {
      {"kind", touch.is_near_miss ? "near" : "touch"}, {"moment", MomentOf(touch, model)}, {"told", told}};
  if (const auto& at = touch.at_in_world_mm) json["at"] = {at->x(), at->y(), at->z()};
  return json;
}

}  // namespace

std::vector<std::string> StatusesOf(const ReportData& data) {
  std::set<std::string> statuses;
  for (const ReportTouch& touch : data.list.touches)
    if (!touch.status.empty()) statuses.insert(touch.status);
  return {statuses.begin(), statuses.end()};
}

std::string PageDataJson(const ReportData& data, const PageCharts& charts, const ReportModel& model) {
  Json touches = Json::array(), parts = Json::array();
  for (const ReportTouch& touch : data.list.touches) touches.push_back(TouchJson(data, touch, model));
  for (const core::Part& part : data.header.layout.parts) parts.push_back(part.name);
  const Json names = {{"parts", parts}, {"tools", ToolsMarked(data)}, {"statuses", StatusesOf(data)}};
  return fmt::format(R"({{"charts":{},"touches":{},"names":{},"first_touch":{},"model":{}}})", charts.Json(),
                     AsciiJson(touches), AsciiJson(names), data.list.worst.value_or(0),
                     ModelJson(data.header.layout, data.header.rig.workspace_mm, model));
}

std::string PageDataJson(const PageCharts& charts) {
  return fmt::format(R"({{"charts":{},"touches":[]}})", charts.Json());
}

}  // namespace elbowroom::sessions
