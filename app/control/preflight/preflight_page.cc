#include "app/control/preflight/preflight_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/system/utc_time.h"
#include "recon/images/picture_encoder.h"
#include "sessions/report/html_page.h"
#include "sessions/report/html_table.h"
#include "sessions/report/markup.h"
#include "sessions/report/whole_files.h"

namespace elbowroom::control {
namespace {

using sessions::Escaped;

// The words are those of the console's panel.
struct Look {
  const char* word;
  const char* color;  // of the style sheet
};

Look LookOf(PreflightState state) {
  switch (state) {
    case PreflightState::kWell:
      return {"well", "--free"};
    case PreflightState::kAttention:
      return {"see to it", "--caution"};
    case PreflightState::kFault:
      return {"fault", "--touched"};
  }
  return {"", "--quiet"};
}

std::string StateHtml(PreflightState state) {
  const Look look = LookOf(state);
  return fmt::format("<span class='dot' style='background:var({})'></span>{}", look.color, look.word);
}

std::string Headline(const std::vector<PreflightRow>& rows) {
  const auto worst = std::ranges::max_element(rows, {}, &PreflightRow::state);
  const auto open = std::ranges::count_if(rows, [](const PreflightRow& row) { return !row.advice.empty(); });
  if (worst == rows.end() || worst->state == PreflightState::kWell)
    return "<section><div class='verdict'><p>Ready for a trial.</p></div></section>\n";
  const bool is_fault = worst->state == PreflightState::kFault;
  return fmt::format(
      "<section><div class='verdict {}'><p>{}</p><p>{} of {} lines have something to "
      "do.</p></div></section>\n",
      is_fault ? "touched" : "broken",
      is_fault ? "Not ready for a trial." : "A trial can run; do first what stands below.", open,
      rows.size());
}

std::string AdviceHtml(const PreflightRow& row) {
  if (row.advice.empty()) return "-";
  std::string html = fmt::format("<b>{}</b>", Escaped(row.advice.front()));
  for (std::size_t i = 1; i < row.advice.size(); ++i)
    html += fmt::format("<br><small>{}</small>", Escaped(row.advice[i]));
  return html;
}

std::string Table(const std::vector<PreflightRow>& rows) {
  sessions::HtmlTable table({{""}, {"state"}, {"what is"}, {"what to do"}});
  for (const PreflightRow& row : rows)
    table.Add({Escaped(row.subject), StateHtml(row.state), Escaped(row.finding), AdviceHtml(row)});
  return "<section><h2>All lines</h2>" + table.Html() + "</section>\n";
}

std::string Pictures(const std::vector<PreflightRow>& rows, const RigHealth& health) {
  std::string html =
      "<section><h2>What each camera sees</h2><div style='display:grid;gap:16px;"
      "grid-template-columns:repeat(auto-fit,minmax(300px,1fr))'>";
  for (const CameraHealth& camera : health.cameras) {
    const auto row = std::ranges::find(rows, camera.name, &PreflightRow::subject);
    if (row == rows.end()) continue;
    const std::string picture =
        camera.picture.empty()
            ? std::string("<p class='facts'>no picture came</p>")
            : fmt::format("<img alt='{}' src='{}'>", Escaped("what camera " + camera.name + " sees"),
                          sessions::PngAsDataUrl(recon::EncodePicture(camera.picture, ".png")));
    html += fmt::format("<figure>{}<figcaption>{} <b>{}</b>: {}{}</figcaption></figure>", picture,
                        StateHtml(row->state), Escaped(camera.name), Escaped(row->finding),
                        row->advice.empty() ? std::string() : "<br>" + AdviceHtml(*row));
  }
  return html + "</div></section>\n";
}

}  // namespace

std::filesystem::path WritePreflightPage(const std::string& rig_name, const std::vector<PreflightRow>& rows,
                                         const RigHealth& health, const std::filesystem::path& folder) {
  const std::string header = fmt::format(
      "<header><p class='kicker'>Elbowroom preflight</p><h1>{}</h1><p class='facts'>{} &middot; {} cameras, "
      "looked at for {:.0f} s</p></header>\n",
      Escaped(rig_name), Escaped(core::NowUtc()), health.cameras.size(), health.seconds);
  const std::string page = sessions::HtmlPage(Escaped(rig_name + ": preflight"),
                                              header + Headline(rows) + Pictures(rows, health) + Table(rows));
  sessions::WriteWholeFiles(folder, {{"preflight.html", page}});
  return folder / "preflight.html";
}

}  // namespace elbowroom::control
