#include "app/control/sweep/sweep_engines.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "app/control/sweep/sweep_cells.h"
#include "core/error.h"
#include "core/system/child_process.h"
#include "core/system/file_sync.h"
#include "core/system/whole_file.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

// In the order of the enum.
constexpr std::array<std::string_view, 3> kEngineNames = {"local", "parallel", "slurm"};
// How long an engine's program may take to end its processes, before it is killed.
constexpr std::chrono::seconds kTimeToEnd{5};

// The program of that name in PATH. Throws: Error{kFile}.
fs::path ProgramOf(SweepEngine engine, const std::string& name, const char* package) {
  const char* variable = std::getenv("PATH");
  std::istringstream folders(variable != nullptr ? variable : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder.empty() ? "." : folder) / name;
    if (::access(program.c_str(), X_OK) == 0 && fs::is_regular_file(program)) return program;
  }
  throw core::Error(core::ErrorKind::kFile,
                    fmt::format("--engine {}: no program '{}' is in PATH; install the Debian package {}, or "
                                "use --engine local",
                                ToString(engine), name, package));
}

// As one word of a shell's command.
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

// A line for each session: the command that has its cells kept.
std::string CommandsOf(const SweepRequest& request, const std::string& threads) {
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  const SpacingRange& range = request.range;
  std::string revisions;
  for (const SweepRevision& revision : request.revisions)
    for (const std::string& argument : revision.arguments)
      revisions += fmt::format("--revision {} ", ShellWord(argument));
  std::string commands;
  for (const fs::path& session : request.sessions)
    commands += fmt::format(
        "{} sweep {} --spacing {} {}--out {} --threads {} --cells-only\n", ShellWord(program),
        ShellWord(fs::absolute(session).string()),
        ShellWord(fmt::format("{}={}:{}:{}", range.spacing, range.from_mm, range.to_mm, range.step_mm)),
        revisions, ShellWord(fs::absolute(request.folder).string()), threads);
  return commands;
}

// A task runs the line of `commands` that it is given the number of. What the shell itself says of a process
// that was killed isn't the process's complaint.
std::string TaskScript() {
  return fmt::format(
      R"sh(#!/bin/bash
cd "$(dirname "$0")" || exit 1
command=$(sed -n "${{1}}p" commands)
exec 3>&2 2>/dev/null
trap 'kill -TERM "$process"; wait "$process"; exit 143' TERM INT
for attempt in $(seq {}); do
  eval "exec $command" 2>&3 &
  process=$!
  wait "$process"
  status=$?
  ((status > 128)) || break
  echo "task $1, attempt $attempt: killed by signal $((status - 128))" >>killed
done
exit "$status"
)sh",
      kMostAttempts);
}

// The script of an array of jobs, one a session; it is submitted from anywhere.
std::string SlurmScript(const SweepRequest& request, const fs::path& folder, const std::string& name,
                        int threads) {
  return fmt::format(
      "#!/bin/bash\n"
      "#SBATCH --job-name={}\n"
      "#SBATCH --array=1-{}\n"
      "#SBATCH --ntasks=1\n"
      "#SBATCH --cpus-per-task={}\n"
      "#SBATCH --output=/dev/null\n"
      "#SBATCH --requeue\n"
      "cd {} || exit 1\n"
      "exec /bin/bash task \"$SLURM_ARRAY_TASK_ID\" >\"$SLURM_ARRAY_TASK_ID.out\" "
      "2>\"$SLURM_ARRAY_TASK_ID.err\"\n",
      name, request.sessions.size(), threads, ShellWord(folder.string()));
}

// What the process complained of that complained first; empty: none did. The others may only say that they
// were ended for its sake, so the time counts and not the name.
std::string FirstComplaint(const fs::path& folder) {
  std::map<fs::file_time_type, fs::path> complaints;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".err" && entry.file_size() > 0)
      complaints.emplace(entry.last_write_time(), entry.path());
  }
  for (const auto& [time, path] : complaints) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);)
      if (!line.empty()) return core::PrintableLine(line, 500);
  }
  return {};
}

// Ends the engine's program, and what it started. GNU parallel ends its jobs at the second request.
void End(core::Child* child) {
  const auto deadline = std::chrono::steady_clock::now() + kTimeToEnd;
  for (int request = 0; request < 2 && !child->Status(); ++request) {
    child->AskToEnd();
    (void)child->WaitForEnd({}, std::chrono::steady_clock::now() + 300ms);
  }
  (void)child->WaitForEnd({}, deadline);
}

class EngineRun {
 public:
  EngineRun(SweepEngine engine, const SweepRequest& request, int threads)
      : engine_(engine),
        request_(request),
        threads_(std::max(threads, 1)),
        folder_(fs::absolute(request.folder) / "engine") {}

  void Find() {
    if (engine_ == SweepEngine::kParallel) {
      program_ = ProgramOf(engine_, "parallel", "parallel");
    } else {
      program_ = ProgramOf(engine_, "sbatch", "slurm-client");
    }
  }

  void Write() {
    std::error_code none;
    fs::remove_all(folder_, none);
    core::MakeFolder(folder_);
    const bool is_slurm = engine_ == SweepEngine::kSlurm;
    core::WriteWholeFile(folder_ / "commands",
                         CommandsOf(request_, is_slurm ? std::to_string(threads_) : "1"));
    core::WriteWholeFile(folder_ / "task", TaskScript());
    std::string numbers;
    for (std::size_t i = 1; i <= request_.sessions.size(); ++i) numbers += fmt::format("{}\n", i);
    core::WriteWholeFile(folder_ / "tasks", numbers);
    if (is_slurm) core::WriteWholeFile(Script(), SlurmScript(request_, folder_, name_, threads_));
  }

  // How many processes were begun again.
  std::int64_t Run(const core::Progress& progress, const std::stop_token& stop) {
    core::Child child(Command());
    core::Woken woken = core::Woken::kTooLate;
    while (woken == core::Woken::kTooLate) {
      woken = child.WaitForEnd(stop, std::chrono::steady_clock::now() + 500ms);
      progress.Report(std::ssize(CellFilesIn(request_.folder)), 0, "files of cells in the folder");
    }
    if (woken == core::Woken::kStopped) {
      End(&child);
      if (engine_ == SweepEngine::kSlurm) CancelArray();
      core::ThrowIfStopped(stop, "the sweep");
    }
    const int status = child.Wait();
    if (status == 0) return CountKilled();
    std::string why = FirstComplaint(folder_);
    if (why.empty() && CountKilled() > 0)
      why = fmt::format(
          "a process was killed {} times; '{}' says by what: is there enough memory for {} processes?",
          kMostAttempts, (folder_ / "killed").string(), threads_);
    if (why.empty())
      why = fmt::format("'{}' {}; what it left is in '{}'", program_.string(), core::TextOfEnd(status),
                        folder_.string());
    throw core::Error(core::ErrorKind::kFile, fmt::format("--engine {}: {}", ToString(engine_), why));
  }

 private:
  [[nodiscard]] fs::path Script() const { return folder_ / "sweep.sbatch"; }

  [[nodiscard]] core::ChildProgram Command() const {
    if (engine_ == SweepEngine::kSlurm) return {program_, {"sbatch", "--wait", Script().string()}};
    return {program_,
            {"parallel", "--will-cite", "--jobs", std::to_string(threads_), "--halt", "now,fail=1",
             "--results", (folder_ / "{#}").string(), "--arg-file", (folder_ / "tasks").string(), "/bin/bash",
             ShellWord((folder_ / "task").string()), "{}"}};
  }

  // Each attempt that was killed has a line.
  [[nodiscard]] std::int64_t CountKilled() const {
    std::ifstream file(folder_ / "killed");
    return std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n');
  }

  // By its name, which is this process's alone.
  void CancelArray() const {
    const fs::path scancel = ProgramOf(engine_, "scancel", "slurm-client");
    core::Child child({scancel, {"scancel", "--name", name_}});
    (void)child.WaitForEnd({}, std::chrono::steady_clock::now() + kTimeToEnd);
  }

  const SweepEngine engine_;
  const SweepRequest& request_;
  const int threads_;
  const fs::path folder_;
  const std::string name_ = fmt::format("elbowroom-sweep-{}", ::getpid());
  fs::path program_;
};

}  // namespace

std::optional<SweepEngine> ParseSweepEngine(std::string_view text) {
  const auto name = std::ranges::find(kEngineNames, text);
  if (name == kEngineNames.end()) return std::nullopt;
  return static_cast<SweepEngine>(name - kEngineNames.begin());
}

std::string_view ToString(SweepEngine engine) { return kEngineNames.at(static_cast<std::size_t>(engine)); }

EngineOutcome RunSweepEngine(SweepEngine engine, const SweepRequest& request, int threads,
                             const core::Progress& progress, const std::stop_token& stop) {
  EngineOutcome outcome{CellFilesIn(request.folder)};
  if (engine == SweepEngine::kLocal) return outcome;
  EngineRun run(engine, request, threads);
  CheckSweep(request, stop);
  run.Write();  // also where the program is missing: Slurm's script can be submitted elsewhere
  run.Find();
  outcome.begun_again = run.Run(progress, stop);
  return outcome;
}

}  // namespace elbowroom::control
