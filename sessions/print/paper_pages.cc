#include "sessions/print/paper_pages.h"

#include <algorithm>

namespace elbowroom::sessions {

void PaperPages::Space(double height_pt) {
  if (!is_fresh()) y_ = std::min(y_ + height_pt, kBodyBottom);
}

void PaperPages::Break() {
  pages_.emplace_back();
  y_ = kBodyTop;
}

void PaperPages::Need(double height_pt) {
  if (!is_fresh() && room() < std::min(height_pt, kBodyHeight)) Break();
}

void PaperPages::Mark(const std::string& title, bool is_minor) {
  outline_.push_back({title, is_minor, pages_.size() - 1, y_});
}

}  // namespace elbowroom::sessions
