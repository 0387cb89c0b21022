#include "sessions/print/svg_drawing.h"

#include <librsvg/rsvg.h>

#include <algorithm>
#include <cstring>

#include "core/error.h"

namespace elbowroom::sessions {
namespace {

void Replace(const std::string& what, const std::string& by, std::string* text) {
  for (std::size_t at = 0; (at = text->find(what, at)) != std::string::npos; at += by.size())
    text->replace(at, what.size(), by);
}

// What librsvg doesn't know, said otherwise: inks, and the middle of a line of text. Only within tags: texts
// stay as they are.
std::string ForLibrary(const std::string& svg, const InkColors& inks) {
  std::string told;
  for (std::size_t at = 0; at < svg.size();) {
    const std::size_t begin = std::min(svg.find('<', at), svg.size());
    const std::size_t end = std::min(svg.find('>', begin), svg.size());
    std::string tag = svg.substr(begin, end - begin);
    for (const auto& [ink, color] : inks) Replace(ink, color, &tag);
    Replace("dominant-baseline=\"central\"", "dy=\"0.35em\"", &tag);
    told += svg.substr(at, begin - at) + tag;
    at = end;
  }
  return told;
}

// Reads on from the front of `bytes`.
cairo_status_t ReadOn(void* bytes, unsigned char* data, unsigned int length) {
  auto& left = *static_cast<std::span<const unsigned char>*>(bytes);
  if (left.size() < length) return CAIRO_STATUS_READ_ERROR;
  std::ranges::copy(left.first(length), data);
  left = left.subspan(length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

SvgDrawing::SvgDrawing(const std::string& svg, const InkColors& inks) {
  const std::string told = ForLibrary(svg, inks);
  GError* error = nullptr;
  svg_.reset(rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(told.data()), told.size(), &error),
             [](RsvgHandle* handle) {
               if (handle != nullptr) g_object_unref(handle);
             });
  const std::string why = error == nullptr ? "" : error->message;
  g_clear_error(&error);
  core::Require(svg_ != nullptr, "an SVG can be read: " + why);
  core::Require(rsvg_handle_get_intrinsic_size_in_pixels(svg_.get(), &width_px_, &height_px_) != FALSE,
                "an SVG says its size");
}

void SvgDrawing::Draw(cairo_t* cairo, const Box& box) const {
  const RsvgRectangle viewport = {box.x, box.y, box.width, box.height};
  rsvg_handle_render_document(svg_.get(), cairo, &viewport, nullptr);
}

PngDrawing::PngDrawing(std::span<const unsigned char> bytes)
    : pixels_(cairo_image_surface_create_from_png_stream(&ReadOn, &bytes), cairo_surface_destroy) {
  core::Require(cairo_surface_status(pixels_.get()) == CAIRO_STATUS_SUCCESS,
                "a document's picture is a PNG file's bytes");
}

void PngDrawing::Draw(cairo_t* cairo, const Box& box) const {
  cairo_save(cairo);
  cairo_translate(cairo, box.x, box.y);
  cairo_scale(cairo, box.width / width_px(), box.height / height_px());
  cairo_set_source_surface(cairo, pixels_.get(), 0.0, 0.0);
  cairo_paint(cairo);
  cairo_restore(cairo);
}

}  // namespace elbowroom::sessions
