// A document's blocks on pages.
#pragma once

#include "sessions/document/document.h"
#include "sessions/print/paper_pages.h"
#include "sessions/print/printer.h"

namespace elbowroom::sessions {

[[nodiscard]] PaperPages PagesOf(const PaperFonts& fonts, const Document& document, const InkColors& inks);

}  // namespace elbowroom::sessions
