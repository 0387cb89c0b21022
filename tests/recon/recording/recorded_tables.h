// The tables of a recorded camera, read by other means than the program's.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace elbowroom::recon::testing {

struct StampRow {
  std::int64_t frame = 0;
  std::string time_s;  // as it stands there
  std::uint64_t picture = 0;
};
[[nodiscard]] std::vector<StampRow> StampRowsOf(const std::filesystem::path& stamps_csv);

struct LossRow {
  std::uint64_t first = 0, last = 0;
  std::string reason;
};
[[nodiscard]] std::vector<LossRow> LossRowsOf(const std::filesystem::path& losses_csv);

}  // namespace elbowroom::recon::testing
