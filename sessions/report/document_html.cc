#include "sessions/report/document_html.h"

#include <fmt/format.h>

#include "sessions/report/html_table.h"
#include "sessions/report/markup.h"

namespace elbowroom::sessions {
namespace {

// Keeps "240 mm" on one line.
std::string WithUnitsHeld(std::string html) {
  for (std::size_t at = 0; (at = html.find(" mm", at)) != std::string::npos;) html.replace(at, 1, "&nbsp;");
  return html;
}

std::string Html(const RichText& text) {
  std::string html;
  for (const TextRun& run : text.runs) {
    std::string part = Escaped(run.text);
    if (run.is_name) part = "<bdi>" + part + "</bdi>";
    if (run.emphasis == Emphasis::kStrong) part = "<b>" + part + "</b>";
    if (run.emphasis == Emphasis::kRemark) part = (html.empty() ? "<small>" : " <small>") + part + "</small>";
    if (run.begins_line && !html.empty()) html += "<br>";
    html += part;
  }
  return html;
}

std::string TileTitle(const Tile& tile) {
  const std::string title = Escaped(tile.title);
  return tile.section_id.empty() ? title : fmt::format("<a href='#{}'>{}</a>", tile.section_id, title);
}

std::string Html(const DocumentCell& cell) {
  if (!cell.png.empty()) return fmt::format("<img class='snapshot' alt='' src='{}'>", PngAsDataUrl(cell.png));
  const std::string dot =
      cell.dot.empty() ? "" : fmt::format("<span class='dot' style='background:{}'></span>", cell.dot);
  return dot + Html(cell.text);
}

std::string Attributes(const DocumentRow& row) {
  std::string attributes;
  for (const auto& [name, value] : row.data) attributes += fmt::format(" data-{}='{}'", name, Escaped(value));
  return attributes;
}

// One overload for each kind of block.
class BlockWriter {
 public:
  explicit BlockWriter(PageCharts* charts) : charts_(charts) {}

  std::string operator()(const Heading& heading) const {
    const char* tag = heading.is_minor ? "h3" : "h2";
    return fmt::format("<{0}>{1}</{0}>\n", tag, Escaped(heading.text));
  }
  std::string operator()(const Paragraph& paragraph) const {
    return fmt::format("<p{}>{}</p>\n", paragraph.is_quiet ? " class='lead'" : "", Html(paragraph.text));
  }
  std::string operator()(const Bullets& bullets) const {
    std::string items;
    for (const RichText& item : bullets.items) items += "<li>" + Html(item) + "</li>\n";
    return "<ul>\n" + items + "</ul>\n";
  }
  std::string operator()(const Verdict& verdict) const {
    constexpr const char* kClasses[] = {"", " touched", " broken"};
    std::string texts;
    for (const std::string& text : verdict.paragraphs) texts += "<p>" + WithUnitsHeld(Escaped(text)) + "</p>";
    return fmt::format("<div class='verdict{}'>{}</div>\n",
                       kClasses[static_cast<std::size_t>(verdict.outcome)], texts);
  }
  std::string operator()(const Tiles& tiles) const {
    std::string html;
    for (const Tile& tile : tiles.tiles)
      html += fmt::format("<div><dt>{}</dt><dd>{}<small>{}</small></dd></div>", TileTitle(tile),
                          Escaped(tile.value), Escaped(tile.remark));
    return "<dl class='tiles'>" + html + "</dl>\n";
  }
  std::string operator()(const DocumentTable& table) const {
    std::vector<TableColumn> columns;
    for (const DocumentColumn& column : table.columns)
      columns.push_back({Html(column.title), column.is_number});
    HtmlTable html(std::move(columns));
    for (const DocumentRow& row : table.rows) AddRow(row, &html);
    return html.Html();
  }
  std::string operator()(const DrawnChart& chart) const { return charts_->Add(chart); }
  std::string operator()(const Picture& picture) const {
    return fmt::format("<figure><img alt='{}' src='{}'><figcaption>{}</figcaption></figure>\n",
                       Escaped(picture.alternative), PngAsDataUrl(picture.png), Escaped(picture.caption));
  }
  std::string operator()(const ModelView&) const {
    return "<div class='model-place'><p>This view needs JavaScript and WebGL; the pictures of this page "
           "don&rsquo;t.</p></div>";
  }

 private:
  static void AddRow(const DocumentRow& row, HtmlTable* html) {
    if (row.begins_group) return html->BeginGroup(Html(row.cells.front()));
    std::vector<std::string> cells;
    for (const DocumentCell& cell : row.cells) cells.push_back(Html(cell));
    html->Add(cells, row.is_highlighted ? "worst" : "", Attributes(row));
  }

  PageCharts* charts_;
};

std::string Html(const Section& section, PageCharts* charts) {
  std::string html = section.id.empty() ? "<section>" : fmt::format("<section id='{}'>", section.id);
  for (const Block& block : section.blocks) html += std::visit(BlockWriter(charts), block);
  return html + "</section>\n";
}

}  // namespace

std::string DocumentHtml(const Document& document, PageCharts* charts) {
  std::string facts;
  for (const std::string& fact : document.facts) facts += (facts.empty() ? "" : " &middot; ") + Escaped(fact);
  std::string html =
      fmt::format("<header><p class='kicker'>{}</p><h1>{}</h1><p class='facts'>{}</p></header>\n",
                  Escaped(document.kicker), Escaped(document.title), facts);
  for (const Section& section : document.sections) html += Html(section, charts);
  return html + "<footer>" + Html(document.footer) + "</footer>\n";
}

}  // namespace elbowroom::sessions
