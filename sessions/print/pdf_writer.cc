#include "sessions/print/pdf_writer.h"

#include <cairo-pdf.h>
#include <fmt/format.h>

#include <memory>
#include <new>

#include "core/error.h"
#include "sessions/print/paper_blocks.h"
#include "sessions/print/paper_look.h"

namespace elbowroom::sessions {
namespace {

constexpr std::size_t kLongestOutlineTitle = 120;  // bytes
constexpr double kRunningSize = 7.5;

cairo_status_t Append(void* text, const unsigned char* data, unsigned int length) {
  try {
    static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), length);
  } catch (const std::bad_alloc&) {
    return CAIRO_STATUS_NO_MEMORY;
  }
  return CAIRO_STATUS_SUCCESS;
}

std::string OutlineTitle(const std::string& title) {
  std::string text = Printable(title);
  if (text.size() <= kLongestOutlineTitle) return text;
  std::size_t end = kLongestOutlineTitle;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "\u2026";
}

// One overload for each kind of thing on a page.
class Drawer {
 public:
  explicit Drawer(cairo_t* cairo) : cairo_(cairo) {}

  void operator()(const PlacedLines& lines) const {
    lines.text.Draw(cairo_, lines.first, lines.end, lines.x, lines.y);
  }
  void operator()(const PlacedFill& fill) const {
    SetColor(fill.color);
    cairo_rectangle(cairo_, fill.box.x, fill.box.y, fill.box.width, fill.box.height);
    cairo_fill(cairo_);
  }
  void operator()(const PlacedFrame& frame) const {
    SetColor(frame.color);
    cairo_set_line_width(cairo_, 0.6);
    cairo_rectangle(cairo_, frame.box.x, frame.box.y, frame.box.width, frame.box.height);
    cairo_stroke(cairo_);
  }
  void operator()(const PlacedSvg& svg) const { svg.drawing.Draw(cairo_, svg.box); }
  void operator()(const PlacedPng& png) const { png.drawing.Draw(cairo_, png.box); }

 private:
  void SetColor(const Color& color) const {
    cairo_set_source_rgb(cairo_, color.red, color.green, color.blue);
  }

  cairo_t* cairo_;
};

// One line between the margins, cut where it is too long.
void DrawRunning(cairo_t* cairo, const PaperFonts& fonts, const std::string& text, double y, bool is_right) {
  TextLook look = BodyLook(true);
  look.size_pt = kRunningSize;
  look.is_cut = true;
  look.aligns_right = is_right;
  constexpr double kShare = 0.72;  // of the width, for what stands at the left
  const double width = (is_right ? 1.0 - kShare : kShare) * kBodyWidth;
  PaperText line(fonts, text, look);
  line.Wrap(width);
  line.Draw(cairo, 0, 1, is_right ? kMarginX + kBodyWidth - width : kMarginX, y);
}

void DrawPages(cairo_t* cairo, const PaperFonts& fonts, const PaperPages& pages, const Document& document) {
  const std::size_t count = pages.pages().size();
  for (std::size_t i = 0; i < count; ++i) {
    for (const Placed& thing : pages.pages()[i]) std::visit(Drawer(cairo), thing);
    if (i > 0) {
      DrawRunning(cairo, fonts, document.title, kBodyTop - 26.0, false);
      DrawRunning(cairo, fonts, document.kicker, kBodyTop - 26.0, true);
    }
    DrawRunning(cairo, fonts, document.source, kBodyBottom + 18.0, false);
    DrawRunning(cairo, fonts, fmt::format("page {} of {}", i + 1, count), kBodyBottom + 18.0, true);
    cairo_show_page(cairo);
  }
}

void AddOutline(cairo_surface_t* pdf, const PaperPages& pages) {
  int parent = CAIRO_PDF_OUTLINE_ROOT;
  for (const OutlineEntry& entry : pages.outline()) {
    const std::string place = fmt::format("page={} pos=[{:.1f} {:.1f}]", entry.page + 1, kMarginX, entry.y);
    const int at = cairo_pdf_surface_add_outline(pdf, entry.is_minor ? parent : CAIRO_PDF_OUTLINE_ROOT,
                                                 OutlineTitle(entry.title).c_str(), place.c_str(),
                                                 CAIRO_PDF_OUTLINE_FLAG_OPEN);
    if (!entry.is_minor) parent = at;
  }
}

void RequireGood(cairo_status_t status) {
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  core::Require(status == CAIRO_STATUS_SUCCESS,
                std::string("a PDF can be drawn: ") + cairo_status_to_string(status));
}

}  // namespace

std::string WritePdf(const Document& document, const InkColors& inks) {
  const PaperFonts fonts;
  const PaperPages pages = PagesOf(fonts, document, inks);
  std::string bytes;
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> pdf(
      cairo_pdf_surface_create_for_stream(&Append, &bytes, kPaperWidth, kPaperHeight), cairo_surface_destroy);
  cairo_pdf_surface_set_metadata(pdf.get(), CAIRO_PDF_METADATA_TITLE, OutlineTitle(document.title).c_str());
  cairo_pdf_surface_set_metadata(pdf.get(), CAIRO_PDF_METADATA_SUBJECT, Printable(document.kicker).c_str());
  cairo_pdf_surface_set_metadata(pdf.get(), CAIRO_PDF_METADATA_CREATOR, "Elbowroom");
  cairo_pdf_surface_set_metadata(pdf.get(), CAIRO_PDF_METADATA_CREATE_DATE, document.made_at_utc.c_str());
  const std::unique_ptr<cairo_t, void (*)(cairo_t*)> cairo(cairo_create(pdf.get()), cairo_destroy);
  DrawPages(cairo.get(), fonts, pages, document);
  AddOutline(pdf.get(), pages);
  RequireGood(cairo_status(cairo.get()));
  cairo_surface_finish(pdf.get());
  RequireGood(cairo_surface_status(pdf.get()));
  return bytes;
}

}  // namespace elbowroom::sessions
