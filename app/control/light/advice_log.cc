#include "app/control/light/advice_log.h"

#include <algorithm>
#include <cctype>
#include <iterator>

namespace elbowroom::control {
namespace {

std::string WithoutNumbers(const std::string& text) {
  std::string kept;
  std::ranges::copy_if(text, std::back_inserter(kept),
                       [](unsigned char c) { return std::isdigit(c) == 0 && c != '.'; });
  return kept;
}

}  // namespace

std::vector<std::string> AdviceLog::Add(const std::string& camera, const std::vector<std::string>& advice,
                                        double time_s) {
  std::vector<std::string> notes;
  std::map<std::string, Standing>& standing = standing_[camera];
  for (const std::string& text : advice) {
    const auto [found, is_new] = standing.try_emplace(WithoutNumbers(text), Standing{text, time_s});
    found->second.last_s = time_s;
    if (!is_new) continue;
    notes.push_back(text);
    given_.push_back(text);
  }
  std::erase_if(standing, [&](const auto& entry) {
    if (time_s - entry.second.last_s < kForgetS) return false;
    notes.push_back("no longer: " + entry.second.text);
    return true;
  });
  return notes;
}

}  // namespace elbowroom::control
