#include "app/control/versions.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <Eigen/Core>

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

}  // namespace elbowroom::control
