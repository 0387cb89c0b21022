#include "app/control/study/study_text.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace elbowroom::control {

std::string NameOfMeasure(const std::string& measure) {
  static const std::map<std::string, std::string> kNames = {
      {"needed_mm", "space needed, mm"},     {"needed_without_tools_mm", "space needed without tools, mm"},
      {"shortfall_mm", "shortfall, mm"},     {"estimate_before_mm", "estimate before, mm"},
      {"trial_s", "length of the trial, s"}, {"touches", "touches"}};
  if (const auto known = kNames.find(measure); known != kNames.end()) return known->second;
  const std::size_t colon = measure.find(':');
  const std::string kind = measure.substr(0, colon), rest = measure.substr(colon + 1);
  if (kind == "step_s") return fmt::format("step '{}', s", rest);
  if (kind == "answer") return fmt::format("answer to '{}'", rest);
  if (kind == "score") return fmt::format("score '{}'", rest);
  if (kind == "score_before") return fmt::format("score '{}' before the trial", rest);
  return measure;
}

std::string NameOfCompared(const std::string& measure, const std::string& baseline) {
  const std::string name = NameOfMeasure(measure);
  return baseline.empty() ? name : fmt::format("{}, beyond '{}'", name, baseline);
}

std::string LengthText(double length_mm) {
  constexpr double kShownAsZero = 0.05;
  return fmt::format("{:.1f}", std::abs(length_mm) < kShownAsZero ? 0.0 : length_mm);
}

std::string LengthText(const std::optional<double>& length_mm) {
  return length_mm ? LengthText(*length_mm) : kNoFigure;
}

std::string NumberText(double number) {
  constexpr double kWithoutDecimals = 1e4, kWithPowers = 1e9;
  const double size = std::abs(number);
  return size >= kWithoutDecimals && size < kWithPowers ? fmt::format("{:.0f}", number)
                                                        : fmt::format("{:.4g}", number);
}

std::string NumberText(const std::optional<double>& number) {
  return number ? NumberText(*number) : kNoFigure;
}

std::string ProbabilityText(double p) {
  constexpr double kSmallest = 0.001;
  return p < kSmallest ? "< 0.001" : fmt::format("{:.3f}", p);
}

std::string PText(double p) {
  const std::string value = ProbabilityText(p);
  return value.starts_with('<') ? "p " + value : "p = " + value;
}

std::string CountText(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace elbowroom::control
