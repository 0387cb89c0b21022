// The scripts that pages and charts run, bundled from npm packages when the program is built (bundle.mjs),
// with the licences of these packages in a comment.
#pragma once

#include <string_view>

namespace elbowroom::web {

// ECMAScript 5. Defines elbowroomCharts.drawSvg(option as JSON, width, height), which returns SVG text.
[[nodiscard]] std::string_view ChartScript();

// What report.html runs in a browser: charts, the 3-D view, filters. Free of "</script" and "<!--".
[[nodiscard]] std::string_view ReportScript();

// Of ReportScript, in base64, as a Content-Security-Policy names it.
[[nodiscard]] std::string_view ReportScriptSha256();

}  // namespace elbowroom::web
