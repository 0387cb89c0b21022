#include "tests/recon/recording/recorded_tables.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace elbowroom::recon::testing {
namespace {

std::vector<std::vector<std::string>> Rows(const std::filesystem::path& path, const std::string& header) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line) || line != header) throw std::runtime_error(path.string() + ": " + line);
  std::vector<std::vector<std::string>> rows;
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

}  // namespace

std::vector<StampRow> StampRowsOf(const std::filesystem::path& stamps_csv) {
  std::vector<StampRow> stamps;
  for (const auto& row : Rows(stamps_csv, "frame,time_s,picture"))
    stamps.push_back({std::stoll(row.at(0)), row.at(1), std::stoull(row.at(2))});
  return stamps;
}

std::vector<LossRow> LossRowsOf(const std::filesystem::path& losses_csv) {
  std::vector<LossRow> losses;
  for (const auto& row : Rows(losses_csv, "first,last,reason"))
    losses.push_back({std::stoull(row.at(0)), std::stoull(row.at(1)), row.at(2)});
  return losses;
}

}  // namespace elbowroom::recon::testing
