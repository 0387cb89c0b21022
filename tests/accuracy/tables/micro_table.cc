// docs/performance.md, "micro".
#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "core/error.h"
#include "tests/accuracy/measurements.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

double InNanoseconds(double time, const std::string& unit) {
  if (unit == "ns") return time;
  if (unit == "us") return 1e3 * time;
  return unit == "ms" ? 1e6 * time : 1e9 * time;
}

std::string Readable(double time_ns) {
  if (time_ns < 1e3) return reporting::ThreeDigits(time_ns) + " ns";
  if (time_ns < 1e6) return reporting::ThreeDigits(1e-3 * time_ns) + " us";
  return reporting::ThreeDigits(1e-6 * time_ns) + " ms";
}

// With repetitions the file has their median; without, the one run.
bool IsTold(const nlohmann::json& run) {
  return run.value("run_type", "") == "iteration" ? run.value("repetitions", 1) <= 1
                                                  : run.value("aggregate_name", "") == "median";
}

// Google Benchmark writes counters of no mean as NaN, which JSON doesn't know.
std::string WithoutNan(const std::string& json) {
  return std::regex_replace(json, std::regex(": -?NaN\\b"), ": null");
}

}  // namespace

void WriteMicroTable(const std::filesystem::path& docs, const std::filesystem::path& json) {
  std::ifstream stream(json);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const nlohmann::json file = nlohmann::json::parse(WithoutNan(text), nullptr, false);
  if (!file.is_object() || !file.contains("benchmarks")) {
    throw core::Error(
        core::ErrorKind::kFormat,
        fmt::format("{}: not what Google Benchmark writes with --benchmark_out", json.string()));
  }
  reporting::Table table{{"benchmark", "time", "time an item"}, {}};
  for (const nlohmann::json& run : file["benchmarks"]) {
    if (!IsTold(run)) continue;
    const double time_ns =
        InNanoseconds(run.at("real_time").get<double>(), run.at("time_unit").get<std::string>());
    const double items_a_second = run.value("items_per_second", 0.0);
    table.rows.push_back({run.at("run_name").get<std::string>(), Readable(time_ns),
                          items_a_second > 0.0 ? Readable(1e9 / items_a_second) : "-"});
  }
  const reporting::Machine machine = reporting::ThisMachine(docs / "..");
  reporting::WriteSection(docs / "performance.md", "micro",
                          reporting::ToMarkdown(table) + "\n" + reporting::ToLine(machine));
}

}  // namespace elbowroom::accuracy
