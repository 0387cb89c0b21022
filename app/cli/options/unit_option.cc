#include "app/cli/options/unit_option.h"

#include <fmt/format.h>

namespace elbowroom::cli {

CLI::Validator NumberWithin(double least, double most) {
  return {[=](const std::string& text) -> std::string {
            const std::optional<double> number = ParseNumber(text);
            return number && *number >= least && *number <= most
                       ? ""
                       : fmt::format("must be a number from {:g} to {:g}, not {}", least, most, text);
          },
          fmt::format("FLOAT in [{:g} - {:g}]", least, most)};
}

}  // namespace elbowroom::cli
