#include "recon/boards/board_page.h"

#include <fmt/format.h>
#include <hpdf.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

constexpr double kPointsPerMm = 72.0 / 25.4;
constexpr double kPaperMargin = 6.0;  // printers don't print nearer to the paper's edge, mm
constexpr double kBelowMm = 20.0;     // for the ruler and two lines of text
constexpr double kBesideMm = 12.0;    // for the upright ruler
constexpr double kRulerMm = 100.0;
constexpr double kFontPoints = 8.0;

struct Paper {
  const char* name;
  double width_mm;
  double height_mm;
};
constexpr Paper kPapers[] = {{"A4", 210.0, 297.0},  {"A4 landscape", 297.0, 210.0},
                             {"A3", 297.0, 420.0},  {"A3 landscape", 420.0, 297.0},
                             {"A2", 420.0, 594.0},  {"A2 landscape", 594.0, 420.0},
                             {"A1", 594.0, 841.0},  {"A1 landscape", 841.0, 594.0},
                             {"A0", 841.0, 1189.0}, {"A0 landscape", 1189.0, 841.0}};

// libharu goes on after an error and does nothing more; the first one says why.
struct FirstFault {
  HPDF_STATUS status = HPDF_OK;
};

void KeepFirstFault(HPDF_STATUS status, HPDF_STATUS, void* fault) {
  auto* first = static_cast<FirstFault*>(fault);
  if (first->status == HPDF_OK) first->status = status;
}

// Draws in millimetres from the page's lower left corner.
class PageWriter {
 public:
  explicit PageWriter(const BoardPage& layout) : document_(HPDF_New(KeepFirstFault, &fault_)) {
    if (document_ == nullptr) Fail();
    page_ = HPDF_AddPage(document_);
    font_ = HPDF_GetFont(document_, "Helvetica", nullptr);
    HPDF_Page_SetWidth(page_, Points(layout.width_mm));
    HPDF_Page_SetHeight(page_, Points(layout.height_mm));
    if (fault_.status != HPDF_OK) Fail();
  }
  ~PageWriter() { HPDF_Free(document_); }
  PageWriter(const PageWriter&) = delete;
  PageWriter& operator=(const PageWriter&) = delete;

  void SetGrey(double grey) { HPDF_Page_SetGrayFill(page_, static_cast<HPDF_REAL>(grey)); }
  void AddRectangle(const Eigen::AlignedBox2d& box_mm) {
    HPDF_Page_Rectangle(page_, Points(box_mm.min().x()), Points(box_mm.min().y()), Points(box_mm.sizes().x()),
                        Points(box_mm.sizes().y()));
  }
  void AddCircle(const Vector2d& center_mm, double radius_mm) {
    HPDF_Page_Circle(page_, Points(center_mm.x()), Points(center_mm.y()), Points(radius_mm));
  }
  // All that was added since, in one area, so that shapes that touch show no line between them.
  void Fill() { HPDF_Page_Fill(page_); }
  void Line(const Vector2d& from_mm, const Vector2d& to_mm) {
    HPDF_Page_SetLineWidth(page_, Points(0.2));
    HPDF_Page_MoveTo(page_, Points(from_mm.x()), Points(from_mm.y()));
    HPDF_Page_LineTo(page_, Points(to_mm.x()), Points(to_mm.y()));
    HPDF_Page_Stroke(page_);
  }
  // At most `width_mm` wide: the letters become smaller.
  void Text(const std::string& text, const Vector2d& at_mm, double width_mm) {
    HPDF_Page_SetFontAndSize(page_, font_, static_cast<HPDF_REAL>(kFontPoints));
    const double wide_mm = HPDF_Page_TextWidth(page_, text.c_str()) / kPointsPerMm;
    const double shrunk = kFontPoints * std::min(1.0, width_mm / std::max(wide_mm, 1e-6));
    HPDF_Page_SetFontAndSize(page_, font_, static_cast<HPDF_REAL>(shrunk));
    HPDF_Page_BeginText(page_);
    HPDF_Page_TextOut(page_, Points(at_mm.x()), Points(at_mm.y()), text.c_str());
    HPDF_Page_EndText(page_);
  }

  [[nodiscard]] std::string Bytes() {
    HPDF_SaveToStream(document_);
    if (fault_.status != HPDF_OK) Fail();
    HPDF_ResetStream(document_);
    std::string bytes(HPDF_GetStreamSize(document_), '\0');
    auto size = static_cast<HPDF_UINT32>(bytes.size());
    // Its status is that of the stream's end, which is no fault.
    HPDF_ReadFromStream(document_, reinterpret_cast<HPDF_BYTE*>(bytes.data()), &size);
    bytes.resize(size);
    return bytes;
  }

 private:
  [[nodiscard]] static HPDF_REAL Points(double mm) { return static_cast<HPDF_REAL>(mm * kPointsPerMm); }
  [[noreturn]] void Fail() const {
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("the board's PDF can't be made (libharu's error {:#x})", fault_.status));
  }

  FirstFault fault_;
  HPDF_Doc document_;
  HPDF_Page page_ = nullptr;
  HPDF_Font font_ = nullptr;
};

// A tick each 10 mm, from `start` along `along`; ticks point to `across`.
void DrawRuler(PageWriter& page, const Vector2d& start, const Vector2d& along, const Vector2d& across) {
  constexpr double kTickMm = 10.0, kShortMm = 1.5, kLongMm = 3.0;
  page.Line(start, start + kRulerMm * along);
  for (int i = 0; i <= 10; ++i) {
    const Vector2d tick = start + i * kTickMm * along;
    page.Line(tick, tick + (i % 10 == 0 ? kLongMm : kShortMm) * across);
  }
}

void DrawShapes(PageWriter& page, const BoardDrawing& drawing, const Vector2d& origin) {
  const auto moved = [&origin](Eigen::AlignedBox2d box) { return box.translate(origin); };
  if (drawing.inverted) {
    page.SetGrey(0.0);
    page.AddRectangle(moved(drawing.ground));
    page.Fill();
  }
  page.SetGrey(drawing.inverted ? 1.0 : 0.0);
  for (const Eigen::AlignedBox2d& box : drawing.rectangles) page.AddRectangle(moved(box));
  for (const DrawnCircle& circle : drawing.circles)
    page.AddCircle(circle.center_in_board + origin, circle.radius_mm);
  page.Fill();
}

}  // namespace

BoardPage PageFor(const BoardDrawing& drawing) {
  const Vector2d board = drawing.ground.sizes();
  const Vector2d needed(std::max(board.x(), kRulerMm) + kBesideMm + 2.0 * kPaperMargin,
                        std::max(board.y(), kRulerMm) + kBelowMm + 2.0 * kPaperMargin);
  BoardPage page{"custom", needed.x(), needed.y(), {}};
  for (const Paper& paper : kPapers) {
    if (paper.width_mm < needed.x() || paper.height_mm < needed.y()) continue;
    page = {paper.name, paper.width_mm, paper.height_mm, {}};
    break;
  }
  // The board is in the middle of what the rulers leave.
  const Vector2d middle(0.5 * (page.width_mm + kBesideMm), 0.5 * (page.height_mm + kBelowMm));
  page.origin_on_page_mm = middle - drawing.ground.center();
  return page;
}

std::string BoardAsToml(const Board& board) {
  std::string text = fmt::format("board = {{ type = \"{}\", columns = {}, rows = {}, square_mm = {}",
                                 ToString(board.kind), board.columns, board.rows, board.square_mm);
  if (board.has_markers())
    text += fmt::format(", marker_mm = {}, dictionary = \"{}\"", board.marker_mm, board.dictionary);
  if (board.kind == BoardKind::kCharuco)
    text += fmt::format(", layout = \"{}\"", board.layout == CharucoLayout::kLegacy ? "legacy" : "current");
  if (board.inverted) text += ", inverted = true";
  return text + " }";
}

std::string BoardAsPdf(const Board& board, const BoardPage& page) {
  const BoardDrawing drawing = DrawBoard(board);
  PageWriter writer(page);
  DrawShapes(writer, drawing, page.origin_on_page_mm);
  writer.SetGrey(0.0);
  const Vector2d x(1.0, 0.0), y(0.0, 1.0);
  const double left = kPaperMargin + kBesideMm, below = kPaperMargin + kBelowMm;
  DrawRuler(writer, {left, below - 5.0}, x, y);
  DrawRuler(writer, {kPaperMargin + 2.0, below}, y, x);
  const double room_mm = page.width_mm - left - kPaperMargin;
  writer.Text("Print at 100 %, not fitted to the page. Both rulers are then 100 mm long.",
              {left, below - 11.0}, room_mm);
  writer.Text(BoardAsToml(board), {left, below - 16.0}, room_mm);
  return writer.Bytes();
}

}  // namespace elbowroom::recon
