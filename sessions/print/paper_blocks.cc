#include "sessions/print/paper_blocks.h"

#include <algorithm>
#include <span>

#include "sessions/print/paper_look.h"
#include "sessions/print/paper_table.h"

namespace elbowroom::sessions {
namespace {

constexpr double kTitleSize = 19.0;
constexpr double kHeadingSize = 12.5;
constexpr double kMinorHeadingSize = 10.0;
constexpr double kVerdictSize = 12.0;
constexpr double kBarWidth = 4.0;  // beside the verdict
constexpr double kVerdictPad = 12.0;
constexpr double kBulletIndent = 11.0;
constexpr double kTileGap = 6.0;
constexpr double kPictureWidth = 380.0;
// A picture is drawn smaller, down to this share, to stand on the page where it belongs.
constexpr double kSmallestPicture = 0.62;
constexpr double kLeastBesideHeading = 70.0;  // of a table, below its heading, and without pictures

// Whether its first row has one, below the head of a group or not.
bool BeginsWithPicture(const DocumentTable& table) {
  const auto first = std::ranges::find_if_not(table.rows, &DocumentRow::begins_group);
  return first != table.rows.end() &&
         std::ranges::any_of(first->cells, [](const DocumentCell& cell) { return !cell.png.empty(); });
}

// Puts blocks on pages, one overload for each kind.
class BlockPlacer {
 public:
  BlockPlacer(const PaperFonts& fonts, const InkColors& inks, PaperPages* pages)
      : fonts_(fonts), inks_(inks), pages_(*pages) {}

  void Title(const Document& document) {
    RichText kicker(document.kicker), facts;
    for (const std::string& fact : document.facts) {
      if (!facts.empty()) facts += {.text = "  \u00b7  "};
      facts += NameRun(fact);
    }
    TextLook small = BodyLook(true);
    small.size_pt = 8.0;
    Flow(kicker, small);
    pages_.Mark(document.title, false);
    Flow(document.title, StrongLook(kTitleSize));
    pages_.Space(4.0);
    Flow(facts, BodyLook(true));
    pages_.Space(8.0);
  }

  void Place(std::span<const Block> blocks) {
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (std::holds_alternative<Heading>(blocks[i])) pages_.Need(HeightWithNext(blocks.subspan(i)));
      std::visit(*this, blocks[i]);
    }
  }

  void Footer(const RichText& text) {
    pages_.Space(14.0);
    TextLook look = BodyLook(true);
    look.size_pt = 8.0;
    pages_.Need(30.0);
    pages_.Put(PlacedFill{{kMarginX, pages_.y(), kBodyWidth, 0.5}, kLine});
    pages_.Down(5.0);
    Flow(text, look);
  }

  void operator()(const Heading& heading) {
    pages_.Space(heading.is_minor ? 8.0 : 20.0);
    if (!heading.is_minor && !pages_.is_fresh()) {
      pages_.Put(PlacedFill{{kMarginX, pages_.y(), kBodyWidth, 0.6}, kLine});
      pages_.Down(7.0);
    }
    pages_.Mark(heading.text, heading.is_minor);
    Flow(heading.text, HeadingLook(heading));
    pages_.Space(2.0);
  }
  void operator()(const Paragraph& paragraph) {
    Flow(paragraph.text, BodyLook(paragraph.is_quiet));
    pages_.Space(4.0);
  }
  void operator()(const Bullets& bullets) {
    pages_.Space(2.0);
    for (const RichText& item : bullets.items) {
      pages_.Need(std::min(TextHeight(item, BodyLook(false)), 0.5 * kBodyHeight));
      PaperText dot(fonts_, "\u2022", BodyLook(false));
      dot.Wrap(kBulletIndent);
      pages_.Put(PlacedLines{dot, 0, 1, kMarginX + 2.0, pages_.y()});
      Flow(item, BodyLook(false), kBulletIndent);
      pages_.Space(3.0);
    }
  }
  void operator()(const Verdict& verdict) {
    constexpr const char* kInks[] = {"var(--free)", "var(--touched)", "var(--caution)"};
    const Color bar = InkColor(kInks[static_cast<std::size_t>(verdict.outcome)], inks_);
    for (std::size_t i = 0; i < verdict.paragraphs.size(); ++i) {
      TextLook look = i == 0 ? StrongLook(kVerdictSize) : BodyLook(true);
      Flow(verdict.paragraphs[i], look, kBarWidth + kVerdictPad, &bar);
    }
    pages_.Space(8.0);
  }
  void operator()(const Tiles& tiles);
  void operator()(const DocumentTable& table) {
    pages_.Space(4.0);
    PlaceTable(fonts_, table, inks_, &pages_);
    pages_.Space(8.0);
  }
  void operator()(const DrawnChart& chart) {
    const SvgDrawing drawing(chart.paper_svg, inks_);
    const Box box = ChartBox(drawing);
    pages_.Space(4.0);
    pages_.Need(box.height);
    pages_.Put(PlacedSvg{drawing, {kMarginX, pages_.y(), box.width, box.height}});
    pages_.Down(box.height);
    pages_.Space(6.0);
  }
  void operator()(const Picture& picture);
  void operator()(const ModelView&) {}

 private:
  // Puts a text, line by line, over as many pages as it takes; with `bar`, on a wash with a bar of that
  // colour at its left.
  void Flow(const RichText& text, const TextLook& look, double indent = 0.0, const Color* bar = nullptr) {
    const double pad = bar == nullptr ? 0.0 : 5.0;
    PaperText lines(fonts_, text, look);
    lines.Wrap(kBodyWidth - indent - (bar == nullptr ? 0.0 : kVerdictPad));
    for (std::size_t at = 0; at < lines.line_count();) {
      std::size_t end = lines.EndWithin(at, pages_.room() - 2.0 * pad);
      if (end == at && pages_.is_fresh()) ++end;  // a line higher than a page
      if (end == at) {
        pages_.Break();
        continue;
      }
      const double height = lines.Height(at, end) + 2.0 * pad;
      if (bar != nullptr) {
        pages_.Put(PlacedFill{{kMarginX, pages_.y(), kBodyWidth, height}, kWash});
        pages_.Put(PlacedFill{{kMarginX, pages_.y(), kBarWidth, height}, *bar});
      }
      pages_.Put(PlacedLines{lines, at, end, kMarginX + indent, pages_.y() + pad});
      pages_.Down(height);
      at = end;
    }
  }

  static TextLook HeadingLook(const Heading& heading) {
    return StrongLook(heading.is_minor ? kMinorHeadingSize : kHeadingSize);
  }

  static Box ChartBox(const SvgDrawing& drawing) {
    const double scale = std::min(kBodyWidth / drawing.width_px(), kBodyHeight / drawing.height_px());
    return {0.0, 0.0, scale * drawing.width_px(), scale * drawing.height_px()};
  }

  static double FullWidth(const PngDrawing& drawing) {
    const double aspect = drawing.height_px() / drawing.width_px();
    return std::min({kPictureWidth, drawing.width_px(), 0.9 * kBodyHeight / aspect});
  }

  // With what is above it. A long caption may go on on the next page.
  double CaptionHeight(const Picture& picture) const {
    return std::min(TextHeight(picture.caption, BodyLook(true)), 60.0) + 10.0;
  }

  double TextHeight(const RichText& text, const TextLook& look) const {
    PaperText lines(fonts_, text, look);
    lines.Wrap(kBodyWidth);
    return lines.Height();
  }

  // Of a heading and what belongs on its page: introducing text, and the beginning of what follows.
  double HeightWithNext(std::span<const Block> blocks) const {
    double height = 0.0;
    for (const Block& block : blocks) {
      if (const auto* heading = std::get_if<Heading>(&block)) {
        height += TextHeight(heading->text, HeadingLook(*heading)) + 29.0;
      } else if (const auto* text = std::get_if<Paragraph>(&block)) {
        height += TextHeight(text->text, BodyLook(text->is_quiet)) + 4.0;
      } else if (const auto* chart = std::get_if<DrawnChart>(&block)) {
        return height + ChartBox(SvgDrawing(chart->paper_svg, inks_)).height + 4.0;
      } else if (const auto* picture = std::get_if<Picture>(&block)) {
        const PngDrawing drawing(picture->png);
        const double smallest =
            kSmallestPicture * FullWidth(drawing) * drawing.height_px() / drawing.width_px();
        return height + smallest + CaptionHeight(*picture) + 8.0;
      } else {
        const auto* table = std::get_if<DocumentTable>(&block);
        const bool has_pictures = table != nullptr && BeginsWithPicture(*table);
        return height + (has_pictures ? kSnapshotWidth : 0.0) + kLeastBesideHeading;
      }
    }
    return height;
  }

  const PaperFonts& fonts_;
  const InkColors& inks_;
  PaperPages& pages_;
};

void BlockPlacer::operator()(const Tiles& tiles) {
  const std::size_t in_a_row = tiles.tiles.size() > 4 ? 3 : std::max<std::size_t>(tiles.tiles.size(), 1);
  const double gaps = kTileGap * static_cast<double>(in_a_row - 1);
  const double width = (kBodyWidth - gaps) / static_cast<double>(in_a_row);
  const TextLook look{.size_pt = 7.5,
                      .color = kInk,
                      .strong_scale = 13.0 / 7.5,
                      .remark_scale = 1.0,
                      .remark_color = kQuietInk,
                      .remarks_stand_below = true};
  std::vector<PaperRow> rows;
  for (std::size_t i = 0; i < tiles.tiles.size(); ++i) {
    if (i % in_a_row == 0) rows.push_back({.cells = {}, .rule = 0.0, .is_framed = true});
    const Tile& tile = tiles.tiles[i];
    RichText text;
    text += Remark(tile.title);
    text += {.text = tile.value, .emphasis = Emphasis::kStrong, .begins_line = true};
    if (!tile.remark.empty()) text += Remark(tile.remark);
    PaperCell& cell = rows.back().cells.emplace_back();
    cell.text.emplace(fonts_, text, look);
    cell.left = kMarginX + static_cast<double>(i % in_a_row) * (width + kTileGap);
    cell.width = width;
    cell.text->Wrap(width - 8.0);
  }
  for (const PaperRow& row : rows) {
    PlaceRows(nullptr, {row}, &pages_);
    pages_.Space(kTileGap);
  }
}

void BlockPlacer::operator()(const Picture& picture) {
  const PngDrawing drawing(picture.png);
  const double aspect = drawing.height_px() / drawing.width_px();
  double width = FullWidth(drawing);
  const double fits = (pages_.room() - CaptionHeight(picture)) / aspect;
  if (fits >= kSmallestPicture * width) width = std::min(width, fits);
  pages_.Space(6.0);
  pages_.Need(width * aspect + CaptionHeight(picture) - 6.5);
  pages_.Put(PlacedPng{drawing, {kMarginX, pages_.y(), width, width * aspect}});
  pages_.Down(width * aspect + 4.0);
  Flow(picture.caption, BodyLook(true));
  pages_.Space(4.0);
}

}  // namespace

PaperPages PagesOf(const PaperFonts& fonts, const Document& document, const InkColors& inks) {
  PaperPages pages;
  BlockPlacer placer(fonts, inks, &pages);
  placer.Title(document);
  for (const Section& section : document.sections)
    if (!section.is_for_screens) placer.Place(section.blocks);
  placer.Footer(document.footer);
  return pages;
}

}  // namespace elbowroom::sessions
