// The scripts with which an engine begins a sweep's processes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "app/control/sweep/spacing_sweep.h"

namespace elbowroom::control {

// As one word of a shell's command. Throws: core::Error{kFile}: it has a line's end.
[[nodiscard]] std::string ShellWord(const std::string& text);

// A line for each session: the command that has its cells kept.
[[nodiscard]] std::string CommandsOf(const SweepRequest& request, const std::string& threads);

// Runs line FIRST of `commands` beside it, and each STEPth line after that (no STEP: no other), one after the
// other. A process that is killed is begun again, `most_attempts` times in all, and has a line in `killed`
// for each. Ends with the status of the first that failed; the others are run all the same.
[[nodiscard]] std::string TaskScript(int most_attempts);

// An array has no more tasks than this, whatever the cluster would take: so many are Slurm's own default.
inline constexpr int kMostArrayTasks = 1000;
// How many tasks an array may have, by what `scontrol show config` says; empty: nothing is known.
// Throws: core::Error{kFile}: the cluster takes no arrays.
[[nodiscard]] int MostArrayTasks(std::string_view configuration);

// The script of one array of jobs; it is submitted from anywhere. Its tasks take the sessions in turn, so
// that no array is too large for a cluster, and one name takes all of them out of the queue.
[[nodiscard]] std::string SlurmScript(const SweepRequest& request, const std::filesystem::path& folder,
                                      const std::string& name, int threads, int most_tasks);

}  // namespace elbowroom::control
