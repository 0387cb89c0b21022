// A cluster of Slurm with this machine as its only node, on the loopback address.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "core/system/child_process.h"

namespace elbowroom::tests {

// Its two daemons run while this lives; they are root's, since slurmd starts jobs for others.
class OneNodeSlurm {
 public:
  // Why there can be none here; empty: nothing is in the way.
  [[nodiscard]] static std::string Missing();

  // In `folder`, with `processors` to share among jobs. Waits until the node takes jobs.
  // Throws: std::runtime_error with the end of the daemons' logs where it doesn't within half a minute.
  OneNodeSlurm(const std::filesystem::path& folder, int processors);

  // For programs that are to find it.
  [[nodiscard]] std::map<std::string, std::string> Environment() const;
  // What `squeue` lists: a line for each job that waits or runs.
  [[nodiscard]] std::string Queue() const;

 private:
  std::filesystem::path folder_;
  std::unique_ptr<core::Child> controller_, node_;
};

}  // namespace elbowroom::tests
