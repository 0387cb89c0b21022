#include "sessions/report/html_page.h"

#include <fmt/format.h>

#include "sessions/charts/ink.h"
#include "web/bundle.h"

namespace elbowroom::sessions {

namespace {

constexpr const char* kReportStyle = R"css(
:root { color-scheme: light dark; --line: #dde3e9; --paper: #ffffff; --wash: #f4f6f8; --worst: #fdf1e8; --chosen: #dcebf8; }
@media screen and (prefers-color-scheme: dark) {
  :root { --line: #39434e; --paper: #1c232b; --wash: #12171c; --worst: #3a2a20; --chosen: #1f3850; } }
* { box-sizing: border-box; }
body { margin: 0; overflow-wrap: break-word; background: var(--wash); color: var(--ink);
  font: 15px/1.5 "Segoe UI", "Helvetica Neue", Arial, "Liberation Sans", sans-serif; }
main { max-width: 1120px; margin: 0 auto; padding: 36px 40px 56px; background: var(--paper); }
header { margin-bottom: 22px; }
.kicker { color: var(--quiet); font-size: 12px; letter-spacing: .09em; text-transform: uppercase; margin: 0 0 4px; }
h1 { font-size: 27px; line-height: 1.25; margin: 0 0 6px; font-weight: 600; overflow-wrap: anywhere; }
h2 { font-size: 18px; font-weight: 600; margin: 40px 0 4px; padding-top: 14px; border-top: 1px solid var(--line); }
h3 { font-size: 14px; font-weight: 600; margin: 20px 0 4px; }
p { margin: 6px 0; max-width: 76ch; }
.facts, .lead { color: var(--quiet); }
.verdict { border-left: 6px solid var(--free); background: var(--wash); padding: 14px 20px; margin: 18px 0; }
.verdict.touched { border-color: var(--touched); }
.verdict.broken { border-color: var(--caution); }
.verdict p { max-width: none; margin: 0; }
.verdict p:first-child { font-size: 19px; line-height: 1.4; font-weight: 600; }
.verdict p + p { margin-top: 6px; color: var(--quiet); }
dl.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 12px; margin: 0; }
dl.tiles div { border: 1px solid var(--line); border-radius: 4px; padding: 10px 14px; }
dl.tiles dt { color: var(--quiet); font-size: 12.5px; }
dl.tiles dd { margin: 2px 0 0; font-size: 20px; font-weight: 600; font-variant-numeric: tabular-nums; }
dl.tiles dd small { display: block; font-size: 12.5px; font-weight: 400; color: var(--quiet); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; min-width: 66%; margin: 10px 0 4px; font-size: 13.5px; font-variant-numeric: tabular-nums; }
th { text-align: left; vertical-align: bottom; font-weight: 600; color: var(--quiet); font-size: 12.5px; line-height: 1.3;
  border-bottom: 2px solid var(--line); padding: 6px 11px; }
td { border-bottom: 1px solid var(--line); padding: 5px 11px; vertical-align: top; overflow-wrap: anywhere; }
th:first-child, td:first-child { padding-left: 4px; }
th:first-child:not(.n) { min-width: 150px; }
th.n, td.n { text-align: right; white-space: nowrap; overflow-wrap: normal; }
td.n small { display: block; white-space: normal; overflow-wrap: break-word; }
th small { display: block; }
th small, td small { font-weight: 400; color: var(--quiet); font-size: 12px; }
tr.worst td { background: var(--worst); }
tr.group th { border-top: 2px solid var(--line); padding-top: 14px; color: var(--ink); font-size: 14px; overflow-wrap: anywhere; }
tr.selected td { background: var(--chosen); }
.runs tr[data-touch] { cursor: pointer; }
tr[data-touch]:focus-visible { outline: 2px solid var(--spacing); outline-offset: -2px; }
img.snapshot { display: block; width: 160px; border-radius: 3px; }
figure.chart svg { max-width: 100%; height: auto; }
.chart-place svg { height: 100%; margin: 0; }
.model-place { height: 460px; border: 1px solid var(--line); border-radius: 4px; overflow: hidden; }
.model-place canvas { display: block; width: 100%; height: 100%; touch-action: none; }
.model-place > p { padding: 12px 16px; color: var(--quiet); }
.told { color: var(--quiet); min-height: 1.5em; overflow-wrap: anywhere; }
form.filters, form.switches { display: flex; flex-wrap: wrap; gap: 8px 18px; margin: 10px 0; font-size: 13.5px; }
form.filters label, form.switches label { color: var(--quiet); max-width: 100%; }
form.filters select, form.filters input { max-width: 220px; font: inherit; color: var(--ink); background: var(--paper);
  border: 1px solid var(--line); border-radius: 3px; padding: 2px 6px; }
form.filters output { color: var(--quiet); }
[hidden] { display: none !important; }
.dot { display: inline-block; width: 10px; height: 10px; border-radius: 2px; margin-right: 7px; }
figure { margin: 12px 0; }
figure img { display: block; max-width: 100%; border: 1px solid var(--line); border-radius: 4px; }
figcaption { color: var(--quiet); font-size: 13.5px; margin-top: 6px; max-width: 90ch; }
ul { padding-left: 20px; max-width: 80ch; margin: 8px 0; }
li { margin: 5px 0; }
svg { display: block; width: 100%; height: auto; margin: 10px 0 0; font-family: inherit; }
svg .tick, svg .remark, svg .quiet { fill: var(--quiet); }
svg .name, svg .number { fill: var(--ink); }
svg .tick, svg .remark { font-size: 11.5px; }
svg .name, svg .quiet { font-size: 12.5px; }
svg .grid { stroke: var(--grid); stroke-width: 1; }
svg .axis { stroke: #94a1ad; stroke-width: 1; }
footer { margin-top: 40px; padding-top: 12px; border-top: 1px solid var(--line); color: var(--quiet); font-size: 12.5px; }
@media print {
  body { background: none; font-size: 10.5pt; }
  main { max-width: none; padding: 0; }
  * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
  h2, h3 { break-after: avoid; }
  form.filters, form.switches, #model { display: none; }
  svg, figure, tr, .verdict, dl.tiles { break-inside: avoid; }
  thead { display: table-header-group; }
  .scroll { overflow: visible; }
}
@media (max-width: 640px) {
  main { padding: 20px 14px 40px; }
  h1 { font-size: 22px; }
  .model-place { height: 320px; }
  .chart-place { min-width: 620px; }
  figure.chart { overflow-x: auto; }
  td, th { padding: 5px 7px; }
}
@page { margin: 16mm 14mm; }
)css";

}  // namespace

std::string HtmlPage(const std::string& title, const std::string& body, const std::string& data_json) {
  const bool runs = !data_json.empty();
  const std::string policy = fmt::format(
      "default-src 'none'; img-src data: blob:; style-src 'unsafe-inline'; base-uri 'none'; form-action "
      "'none'{}",
      runs ? fmt::format("; script-src 'sha256-{}'", web::ReportScriptSha256()) : "");
  const std::string scripts =
      runs
          ? fmt::format("<script type='application/json' id='report-data'>{}</script>\n<script>{}</script>\n",
                        data_json, web::ReportScript())
          : "";
  return fmt::format(
      "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>"
      "<meta http-equiv='Content-Security-Policy' content=\"{}\">"
      "<meta name='viewport' content='width=device-width, "
      "initial-scale=1'>\n<title>{}</title>\n<style>:root {{ {}}}\n@media screen and (prefers-color-scheme: "
      "dark) {{ :root {{ {}}} }}\n{}</style>"
      "</head>\n<body><main>\n{}</main>\n{}</body></html>\n",
      policy, title, LightInks(), DarkInks(), kReportStyle, body, scripts);
}

}  // namespace elbowroom::sessions
