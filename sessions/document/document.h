// What a report says, as values: a page and a PDF are made from the same document.
#pragma once

#include <concepts>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "sessions/charts/chart.h"

namespace elbowroom::sessions {

enum class Emphasis { kPlain, kStrong, kRemark };

// Plain text in UTF-8; nothing in it is markup.
struct TextRun {
  std::string text;
  Emphasis emphasis = Emphasis::kPlain;
  bool is_name = false;      // somebody else's words: their direction is their own
  bool begins_line = false;  // after a line break
};

struct RichText {
  std::vector<TextRun> runs;

  RichText() = default;
  RichText(std::string text);  // NOLINT(google-explicit-constructor): a text is a rich text of one run
  RichText(const char* text) : RichText(std::string(text)) {}  // NOLINT(google-explicit-constructor)

  RichText& operator+=(TextRun run);
  [[nodiscard]] bool empty() const { return runs.empty(); }
};

[[nodiscard]] TextRun Strong(std::string text);
[[nodiscard]] TextRun Remark(std::string text);
[[nodiscard]] TextRun NameRun(std::string text);
[[nodiscard]] RichText NameText(std::string text);  // of one NameRun
// "140 mm" with a quiet "frame 3".
[[nodiscard]] RichText WithRemark(std::string text, std::string remark);
[[nodiscard]] std::string PlainText(const RichText& text);  // lines are joined by spaces

struct Heading {
  std::string text;
  bool is_minor = false;  // below a section's
};

struct Paragraph {
  RichText text;
  bool is_quiet = false;
};

struct Bullets {
  std::vector<RichText> items = {};
};

// What the reader must know first.
struct Verdict {
  enum class Outcome { kFree, kTouched, kDoubtful };
  Outcome outcome = Outcome::kFree;
  std::vector<std::string> paragraphs;  // the first is the verdict
};

struct Tile {
  std::string title;
  std::string value;
  std::string remark = {};
  std::string section_id = {};  // that says more; empty: none
};
struct Tiles {
  std::vector<Tile> tiles;
};

struct DocumentColumn {
  RichText title;
  bool is_number = false;  // aligned to the right; breaks at line breaks and within names only
};

struct DocumentCell {
  RichText text;
  std::string dot = {};                     // colour of a mark before the text (an ink or #rrggbb)
  std::span<const unsigned char> png = {};  // instead of the text

  DocumentCell() = default;
  template <std::convertible_to<RichText> Text>
  DocumentCell(Text&& content)  // NOLINT(google-explicit-constructor): most cells are a text
      : text(std::forward<Text>(content)) {}
};

struct DocumentRow {
  std::vector<DocumentCell> cells;  // one a column; of the head of a group, one
  bool is_highlighted = false;
  bool begins_group = false;                                   // it is the head of those that follow
  std::vector<std::pair<std::string, std::string>> data = {};  // what a page's script reads of the row
};

struct DocumentTable {
  std::vector<DocumentColumn> columns;
  std::vector<DocumentRow> rows = {};
};

struct DrawnChart {
  Chart chart;
  // Its colours are inks (ink.h).
  std::string svg;
  std::string paper_svg;  // narrower, so that its texts are as large as a report's on paper
};

struct Picture {
  std::span<const unsigned char> png;
  std::string caption;
  std::string alternative;  // for those who can't see it
};

// Where a page has its 3-D view.
struct ModelView {};

using Block =
    std::variant<Heading, Paragraph, Bullets, Verdict, Tiles, DocumentTable, DrawnChart, Picture, ModelView>;

struct Section {
  std::string id = {};
  std::vector<Block> blocks = {};
  bool is_for_screens = false;  // left out on paper
};

// Its pictures' bytes are the caller's.
struct Document {
  std::string kicker;
  std::string title;
  std::vector<std::string> facts;
  std::vector<Section> sections;
  RichText footer;
  std::string source;       // the file that the document is of
  std::string made_at_utc;  // ISO 8601: what the document is of, not when it was written
};

}  // namespace elbowroom::sessions
