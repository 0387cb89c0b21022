#include "app/control/sweep/engine_scripts.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <system_error>

#include "core/error.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;

// The number of a line "NAME   = NUMBER".
std::optional<int> NumberOf(std::string_view configuration, std::string_view name) {
  for (std::size_t begin = 0; begin < configuration.size();) {
    const std::size_t end = std::min(configuration.find('\n', begin), configuration.size());
    const std::string_view line = configuration.substr(begin, end - begin);
    begin = end + 1;
    if (!line.starts_with(name)) continue;
    const std::size_t digits = line.find_first_not_of(" \t=", name.size());
    if (digits == name.size() || digits == std::string_view::npos) continue;
    int number = 0;
    const auto [last, error] = std::from_chars(line.data() + digits, line.data() + line.size(), number);
    if (error == std::errc()) return number;
  }
  return std::nullopt;
}

}  // namespace

std::string ShellWord(const std::string& text) {
  if (text.find('\n') != std::string::npos)
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("'{}' has a line's end in its name, which an engine can't pass on; rename "
                                  "it, or use --engine local",
                                  text));
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string CommandsOf(const SweepRequest& request, const std::string& threads) {
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  const SpacingRange& range = request.range;
  std::string more = request.keeps_hulls ? "--keep-hulls " : "";
  for (const SweepRevision& revision : request.revisions)
    for (const std::string& argument : revision.arguments)
      more += fmt::format("--revision {} ", ShellWord(argument));
  std::string commands;
  for (const fs::path& session : request.sessions)
    commands += fmt::format(
        "{} sweep {} --spacing {} {}--out {} --threads {} --cells-only\n", ShellWord(program),
        ShellWord(fs::absolute(session).string()),
        ShellWord(fmt::format("{}={}:{}:{}", range.spacing, range.from_mm, range.to_mm, range.step_mm)), more,
        ShellWord(fs::absolute(request.folder).string()), threads);
  return commands;
}

// What the shell itself says of a process that was killed isn't the process's complaint.
std::string TaskScript(int most_attempts) {
  return fmt::format(
      R"sh(#!/bin/bash
cd "$(dirname "$0")" || exit 1
mapfile -t commands < <(sed -n "$1~${{2:-0}}p" commands)
exec 3>&2 2>/dev/null
trap 'kill -TERM "$process"; wait "$process"; exit 143' TERM INT
failed=0
for i in "${{!commands[@]}}"; do
  for attempt in $(seq {}); do
    eval "exec ${{commands[i]}}" 2>&3 &
    process=$!
    wait "$process"
    status=$?
    ((status > 128)) || break
    echo "line $(($1 + i * ${{2:-0}})) of commands, attempt $attempt: killed by signal $((status - 128))" >>killed
  done
  ((failed != 0)) || failed=$status
done
exit "$failed"
)sh",
      most_attempts);
}

int MostArrayTasks(std::string_view configuration) {
  // The largest number of a task is one less than MaxArraySize.
  const int by_size = NumberOf(configuration, "MaxArraySize").value_or(kMostArrayTasks + 1) - 1;
  const int by_count = NumberOf(configuration, "MaxJobCount").value_or(kMostArrayTasks);
  const int most = std::min({by_size, by_count, kMostArrayTasks});
  if (most >= 1) return most;
  throw core::Error(core::ErrorKind::kFile,
                    "--engine slurm: this cluster takes no arrays of jobs (MaxArraySize in slurm.conf); use "
                    "--engine parallel or local");
}

std::string SlurmScript(const SweepRequest& request, const fs::path& folder, const std::string& name,
                        int threads, int most_tasks) {
  const std::size_t tasks = std::min(request.sessions.size(), static_cast<std::size_t>(most_tasks));
  return fmt::format(
      "#!/bin/bash\n"
      "#SBATCH --job-name={}\n"
      "#SBATCH --array=1-{}\n"
      "#SBATCH --ntasks=1\n"
      "#SBATCH --cpus-per-task={}\n"
      "#SBATCH --output=/dev/null\n"
      "#SBATCH --requeue\n"
      "cd {} || exit 1\n"
      "exec /bin/bash task \"$SLURM_ARRAY_TASK_ID\" {} >\"$SLURM_ARRAY_TASK_ID.out\" "
      "2>\"$SLURM_ARRAY_TASK_ID.err\"\n",
      name, tasks, threads, ShellWord(folder.string()), tasks);
}

}  // namespace elbowroom::control
