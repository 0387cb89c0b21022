#include "cad_import/formats/collada_unit.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <regex>

namespace elbowroom::cad_import {

bool MendUnit(std::string* document) {
  // Metadata stands at the beginning: geometry needn't be searched.
  const std::size_t end = std::min(document->find("</asset>"), document->size());
  const std::size_t tag = document->rfind("<unit", end);
  if (tag == std::string::npos) return false;
  static const std::regex kMeter("\\smeter\\s*=\\s*[\"']([^\"']*)[\"']");
  std::smatch match;
  const auto begin = document->cbegin() + static_cast<std::ptrdiff_t>(tag);
  if (!std::regex_search(begin, std::find(begin, document->cend(), '>'), match, kMeter)) return false;
  std::string number = match[1].str();
  const std::size_t at = tag + static_cast<std::size_t>(match.position(1)), length = number.size();
  std::ranges::replace(number, ',', '.');  // as some write it
  number.erase(0, std::min(number.find_first_not_of(" \t\r\n+"), number.size()));
  double metres = 0.0;
  const auto [end_of_number, error] = std::from_chars(number.data(), number.data() + number.size(), metres);
  const bool is_length = error == std::errc() && metres > 0.0 && std::isfinite(metres);
  number.resize(is_length ? static_cast<std::size_t>(end_of_number - number.data()) : 0);
  document->erase(at, length);
  document->insert(at, is_length ? number : "1");
  return !is_length;
}

}  // namespace elbowroom::cad_import
