#include "app/control/versions.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <Eigen/Core>
#include <chrono>

namespace elbowroom::control {

std::string ProgramVersion() { return ELBOWROOM_VERSION; }

std::map<std::string, std::string> SoftwareVersions() {
  std::map<std::string, std::string> versions = {
      {"elbowroom", ProgramVersion()},
      {"compiler", __VERSION__},
      {"eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)}};
  utsname system{};
  if (uname(&system) == 0)
    versions["system"] = fmt::format("{} {} {}", system.sysname, system.release, system.machine);
  return versions;
}

std::string NowUtc() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

}  // namespace elbowroom::control
