// The charts of a page: as pictures, and as what its script draws anew.
#pragma once

#include <string>

#include "sessions/document/document.h"

namespace elbowroom::sessions {

class PageCharts {
 public:
  // HTML: a <figure> with the chart's picture, which the script replaces by the chart.
  [[nodiscard]] std::string Add(const DrawnChart& drawn);
  // What web/page/charts_in_page.js takes, as JSON in ASCII without "<".
  [[nodiscard]] std::string Json() const { return "[" + json_ + "]"; }

 private:
  std::size_t count_ = 0;
  std::string json_;
};

}  // namespace elbowroom::sessions
