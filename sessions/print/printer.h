// Pango, Cairo and librsvg, as a module that is loaded on first use.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sessions/document/document.h"
#include "sessions/print/svg_pixels.h"

namespace elbowroom::sessions {

// A colour's name in a document or an SVG, and the colour: {"var(--ink)", "#1d2733"}.
using InkColors = std::vector<std::pair<std::string, std::string>>;

struct Printer {
  std::string (*pdf)(const Document& document, const InkColors& inks);
  void (*paint)(const std::string& svg, double left_px, const PixelsToPaint& pixels);
};

// Loads it at the first call. Throws: Error{kFile} if that fails. Thread: any.
[[nodiscard]] const Printer& LoadedPrinter();

}  // namespace elbowroom::sessions

// The module's entry.
extern "C" const elbowroom::sessions::Printer& ElbowroomPrinter();
