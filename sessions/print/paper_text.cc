#include "sessions/print/paper_text.h"

#include <algorithm>
#include <string_view>

#include "core/error.h"

namespace elbowroom::sessions {
namespace {

constexpr double kLineSpacing = 1.12;  // of the font's own
constexpr const char* kFamilies = "Liberation Sans, DejaVu Sans, sans-serif";
constexpr std::string_view kIsolate = "\u2068", kEndOfIsolate = "\u2069";

double Points(int units) { return static_cast<double>(units) / PANGO_SCALE; }
int Units(double points) { return static_cast<int>(points * PANGO_SCALE); }
guint16 Level(double share) { return static_cast<guint16>(share * 65535.0); }

bool IsAscii(const std::string& text) {
  return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

// A layout's text and attributes, put together run by run.
class TextMaker {
 public:
  explicit TextMaker(const TextLook& look) : look_(look), attributes_(pango_attr_list_new()) {}
  ~TextMaker() { pango_attr_list_unref(attributes_); }
  TextMaker(const TextMaker&) = delete;
  TextMaker& operator=(const TextMaker&) = delete;

  void Add(const TextRun& run) {
    const bool is_remark = run.emphasis == Emphasis::kRemark;
    const bool stands_below = run.begins_line || (is_remark && look_.remarks_stand_below);
    if (!text_.empty()) text_ += stands_below ? "\n" : is_remark ? " " : "";
    const std::size_t begin = text_.size();
    const bool is_isolated = run.is_name && !IsAscii(run.text);
    if (is_isolated) text_ += kIsolate;
    text_ += Printable(run.text);
    if (is_isolated) text_ += kEndOfIsolate;
    Insert(pango_attr_insert_hyphens_new(FALSE), begin);  // a broken name isn't told with one
    const bool is_strong = run.emphasis == Emphasis::kStrong;
    if (is_strong || look_.is_strong) Insert(pango_attr_weight_new(PANGO_WEIGHT_BOLD), begin);
    if (is_strong) Insert(pango_attr_scale_new(look_.strong_scale), begin);
    if (is_remark) AddRemark(begin);
    if (look_.holds_lines && !run.is_name) Insert(pango_attr_allow_breaks_new(FALSE), begin);
  }

  void GiveTo(PangoLayout* layout) const {
    pango_layout_set_text(layout, text_.c_str(), static_cast<int>(text_.size()));
    pango_layout_set_attributes(layout, attributes_);
  }

 private:
  void AddRemark(std::size_t begin) {
    const Color& color = look_.remark_color;
    Insert(pango_attr_scale_new(look_.remark_scale), begin);
    Insert(pango_attr_weight_new(PANGO_WEIGHT_NORMAL), begin);
    Insert(pango_attr_foreground_new(Level(color.red), Level(color.green), Level(color.blue)), begin);
  }

  // Up to the text's end. The list takes the attribute.
  void Insert(PangoAttribute* attribute, std::size_t begin) {
    attribute->start_index = static_cast<guint>(begin);
    attribute->end_index = static_cast<guint>(text_.size());
    pango_attr_list_change(attributes_, attribute);
  }

  const TextLook& look_;
  PangoAttrList* attributes_;
  std::string text_;
};

bool HasLetters(PangoContext* context) {
  const std::unique_ptr<PangoLayout, void (*)(void*)> layout(pango_layout_new(context), g_object_unref);
  pango_layout_set_text(layout.get(), "Aa1", -1);
  return pango_layout_get_unknown_glyphs_count(layout.get()) == 0;
}

void SetFont(PangoLayout* layout, double size_pt) {
  PangoFontDescription* font = pango_font_description_new();
  pango_font_description_set_family_static(font, kFamilies);
  pango_font_description_set_size(font, Units(size_pt));
  pango_layout_set_font_description(layout, font);
  pango_font_description_free(font);
}

}  // namespace

Color ColorFrom(const std::string& text) {
  core::Require(text.size() == 7 && text[0] == '#', "a colour is #rrggbb");
  const unsigned long rgb = std::stoul(text.substr(1), nullptr, 16);
  const auto level = [&](unsigned shift) { return static_cast<double>(rgb >> shift & 255U) / 255.0; };
  return {level(16), level(8), level(0)};
}

std::string Printable(const std::string& text) {
  const std::unique_ptr<char, void (*)(void*)> valid(
      g_utf8_make_valid(text.c_str(), static_cast<gssize>(text.size())), g_free);
  std::string printable = valid.get();
  std::ranges::replace_if(
      printable, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, ' ');
  return printable;
}

PaperFonts::PaperFonts() : map_(pango_cairo_font_map_new_for_font_type(CAIRO_FONT_TYPE_FT), g_object_unref) {
  pango_cairo_font_map_set_resolution(PANGO_CAIRO_FONT_MAP(map_.get()), 72.0);
  context_.reset(pango_font_map_create_context(map_.get()), g_object_unref);
  // Letters keep their own widths: paper has no pixels to round them to.
  pango_context_set_round_glyph_positions(context_.get(), FALSE);
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  pango_cairo_context_set_font_options(context_.get(), options);
  cairo_font_options_destroy(options);
  if (!HasLetters(context_.get()))
    throw core::Error(core::ErrorKind::kFile,
                      "a PDF needs a font, and none is installed: install one, such as fonts-dejavu-core");
}

PaperText::PaperText(const PaperFonts& fonts, const RichText& text, const TextLook& look)
    : layout_(pango_layout_new(fonts.context()), g_object_unref), color_(look.color) {
  SetFont(layout_.get(), look.size_pt);
  pango_layout_set_line_spacing(layout_.get(), static_cast<float>(kLineSpacing));
  pango_layout_set_wrap(layout_.get(), PANGO_WRAP_WORD_CHAR);
  if (look.aligns_right) pango_layout_set_alignment(layout_.get(), PANGO_ALIGN_RIGHT);
  if (look.is_cut) pango_layout_set_ellipsize(layout_.get(), PANGO_ELLIPSIZE_END);
  TextMaker maker(look);
  for (const TextRun& run : text.runs) maker.Add(run);
  maker.GiveTo(layout_.get());
}

double PaperText::NaturalWidth() {
  PangoRectangle logical;
  pango_layout_set_width(layout_.get(), -1);
  pango_layout_get_extents(layout_.get(), nullptr, &logical);
  return Points(logical.width);
}

double PaperText::LeastWidth() {
  PangoRectangle logical;
  pango_layout_set_wrap(layout_.get(), PANGO_WRAP_WORD);
  pango_layout_set_width(layout_.get(), 0);
  pango_layout_get_extents(layout_.get(), nullptr, &logical);
  pango_layout_set_wrap(layout_.get(), PANGO_WRAP_WORD_CHAR);
  return Points(logical.width);
}

void PaperText::Wrap(double width_pt) {
  pango_layout_set_width(layout_.get(), Units(width_pt));
  lines_.clear();
  PangoLayoutIter* at = pango_layout_get_iter(layout_.get());
  do {
    PangoRectangle logical;
    pango_layout_iter_get_line_extents(at, nullptr, &logical);
    const double baseline = Points(pango_layout_iter_get_baseline(at));
    lines_.push_back({pango_layout_iter_get_line_readonly(at), Points(logical.x), Points(logical.y),
                      Points(logical.y + logical.height), baseline});
  } while (pango_layout_iter_next_line(at));
  pango_layout_iter_free(at);
}

double PaperText::Height(std::size_t first, std::size_t end) const {
  return first < end ? lines_[end - 1].bottom - lines_[first].top : 0.0;
}

std::size_t PaperText::EndWithin(std::size_t first, double height_pt) const {
  std::size_t end = first;
  while (end < lines_.size() && Height(first, end + 1) <= height_pt) ++end;
  return end;
}

void PaperText::Draw(cairo_t* cairo, std::size_t first, std::size_t end, double x, double y) const {
  cairo_set_source_rgb(cairo, color_.red, color_.green, color_.blue);
  for (std::size_t i = first; i < end; ++i) {
    cairo_move_to(cairo, x + lines_[i].left, y + lines_[i].baseline - lines_[first].top);
    pango_cairo_show_layout_line(cairo, lines_[i].line);
  }
}

}  // namespace elbowroom::sessions
