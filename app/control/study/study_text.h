// Figures of a study in words.
#pragma once

#include <optional>
#include <string>

namespace elbowroom::control {

inline constexpr const char* kNoFigure = "\u2013";

// "shortfall_mm": "shortfall, mm"; "answer:presence": "answer to 'presence'".
[[nodiscard]] std::string NameOfMeasure(const std::string& measure);

// What is compared in a study: the measure, or "step 'timed', s, beyond 'real'" where there is a baseline.
[[nodiscard]] std::string NameOfCompared(const std::string& measure, const std::string& baseline);

// "121.5", as many decimals as a length here has.
[[nodiscard]] std::string LengthText(double length_mm);
[[nodiscard]] std::string LengthText(const std::optional<double>& length_mm);  // nothing: kNoFigure

// Four digits that count: "0.6325", "121.5", "12345".
[[nodiscard]] std::string NumberText(double number);
[[nodiscard]] std::string NumberText(const std::optional<double>& number);  // nothing: kNoFigure

// "0.079", "< 0.001".
[[nodiscard]] std::string ProbabilityText(double p);

// "p = 0.079", "p < 0.001".
[[nodiscard]] std::string PText(double p);

// "1 participant", "4 participants".
[[nodiscard]] std::string CountText(std::size_t count, const char* what);

}  // namespace elbowroom::control
