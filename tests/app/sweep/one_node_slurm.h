// A cluster of Slurm with this machine as its only node, on the loopback address.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "core/system/child_process.h"

namespace elbowroom::tests {

// Its two daemons run while this lives; they are root's, since slurmd starts jobs for others.
class OneNodeSlurm {
 public:
  // In `folder`, with `processors` to share among jobs; `max_array_size` as in slurm.conf, where 1001 is
  // Slurm's own. Null, and why: the daemons aren't installed, this user isn't root, or the node takes no jobs
  // within half a minute.
  [[nodiscard]] static std::unique_ptr<OneNodeSlurm> Start(const std::filesystem::path& folder,
                                                           int processors, std::string* why_not,
                                                           int max_array_size = 1001);

  // For programs that are to find it.
  [[nodiscard]] std::map<std::string, std::string> Environment() const;
  // What `squeue` lists: a line for each job that waits or runs.
  [[nodiscard]] std::string Queue() const;

 private:
  explicit OneNodeSlurm(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::filesystem::path folder_;
  std::unique_ptr<core::Child> controller_, node_;
};

}  // namespace elbowroom::tests
