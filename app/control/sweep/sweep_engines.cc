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

#include "app/control/sweep/engine_scripts.h"
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
// The folder of cells is listed for the progress: so seldom that it costs a twentieth of the time, also where
// thousands of sessions lie on a network file system.
constexpr std::chrono::milliseconds kLeastPause{500};
constexpr int kPausesAListing = 20;
// What sbatch itself complains of, in the engine's folder.
constexpr const char* kSaid = "sbatch.said";

// The program of that name in PATH; nothing: there is none.
std::optional<fs::path> InPath(const std::string& name) {
  const char* variable = std::getenv("PATH");
  std::istringstream folders(variable != nullptr ? variable : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder.empty() ? "." : folder) / name;
    if (::access(program.c_str(), X_OK) == 0 && fs::is_regular_file(program)) return program;
  }
  return std::nullopt;
}

// Throws: Error{kFile}: there is none.
fs::path ProgramOf(SweepEngine engine, const std::string& name, const char* package) {
  if (const auto program = InPath(name)) return *program;
  throw core::Error(core::ErrorKind::kFile,
                    fmt::format("--engine {}: no program '{}' is in PATH; install the Debian package {}, or "
                                "use --engine local",
                                ToString(engine), name, package));
}

// The last one that isn't empty: what came before it led to it.
std::string LastLine(const std::string& text) {
  const std::size_t last = text.find_last_not_of(" \n");
  if (last == std::string::npos) return {};
  const std::size_t before = text.rfind('\n', last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  return text.substr(first, last + 1 - first);
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

// The program with its output in these files; it is the process itself, and not a shell's child.
core::ChildProgram WithOutputIn(const fs::path& out, const fs::path& err, const fs::path& program,
                                const std::vector<std::string>& arguments) {
  core::ChildProgram child{"/bin/bash",
                           {"bash", "-c", "exec >\"$1\" 2>\"$2\"; shift 2; exec \"$@\"", "bash", out.string(),
                            err.string(), program.string()}};
  child.arguments.insert(child.arguments.end(), arguments.begin(), arguments.end());
  return child;
}

std::string HostName() {
  std::array<char, 256> name = {};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

std::string TextIn(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
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
    core::WriteWholeFile(folder_ / "task", TaskScript(kMostAttempts));
    std::string numbers;
    for (std::size_t i = 1; i <= request_.sessions.size(); ++i) numbers += fmt::format("{}\n", i);
    core::WriteWholeFile(folder_ / "tasks", numbers);
    if (is_slurm)
      core::WriteWholeFile(Script(), SlurmScript(request_, folder_, name_, threads_, MostTasks()));
  }

  // How many processes were begun again.
  std::int64_t Run(const core::Progress& progress, const std::stop_token& stop) {
    core::Child child(Command());
    core::Woken woken = core::Woken::kTooLate;
    std::chrono::steady_clock::duration pause = kLeastPause;
    while (woken == core::Woken::kTooLate) {
      const auto begin = std::chrono::steady_clock::now();
      progress.Report(std::ssize(CellFilesIn(request_.folder)), 0, "files of cells in the folder");
      const auto now = std::chrono::steady_clock::now();
      pause = std::max<std::chrono::steady_clock::duration>(kLeastPause, kPausesAListing * (now - begin));
      woken = child.WaitForEnd(stop, now + pause);
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
    if (why.empty()) {
      if (const std::string said = LastLine(TextIn(folder_ / kSaid)); !said.empty())
        why = fmt::format("{}; put that right, or submit '{}' where there is a cluster",
                          core::PrintableLine(said, 500), Script().string());
    }
    if (why.empty())
      why = fmt::format("'{}' {}; what it left is in '{}'", program_.string(), core::TextOfEnd(status),
                        folder_.string());
    throw core::Error(core::ErrorKind::kFile, fmt::format("--engine {}: {}", ToString(engine_), why));
  }

 private:
  [[nodiscard]] fs::path Script() const { return folder_ / "sweep.sbatch"; }

  [[nodiscard]] core::ChildProgram Command() const {
    if (engine_ == SweepEngine::kSlurm)
      return WithOutputIn(folder_ / "sbatch.out", folder_ / kSaid, program_, {"--wait", Script().string()});
    return {program_,
            {"parallel", "--will-cite", "--jobs", std::to_string(threads_), "--halt", "now,fail=1",
             "--results", (folder_ / "{#}").string(), "--arg-file", (folder_ / "tasks").string(), "/bin/bash",
             ShellWord((folder_ / "task").string()), "{}"}};
  }

  // Each attempt that was killed has a line.
  [[nodiscard]] std::int64_t CountKilled() const {
    return std::ranges::count(TextIn(folder_ / "killed"), '\n');
  }

  // Of an array, as the cluster says; of one that can't be asked, as many as by Slurm's own settings.
  [[nodiscard]] int MostTasks() const {
    const auto scontrol = InPath("scontrol");
    if (!scontrol) return MostArrayTasks("");
    const fs::path settings = folder_ / "cluster";
    core::Child child(WithOutputIn(settings, folder_ / "cluster.said", *scontrol, {"show", "config"}));
    (void)child.WaitForEnd({}, std::chrono::steady_clock::now() + kTimeToEnd);
    return MostArrayTasks(TextIn(settings));
  }

  // By its name, which is this process's alone, also among those of other machines.
  void CancelArray() const {
    const fs::path scancel = ProgramOf(engine_, "scancel", "slurm-client");
    core::Child child({scancel, {"scancel", "--name", name_}});
    (void)child.WaitForEnd({}, std::chrono::steady_clock::now() + kTimeToEnd);
  }

  const SweepEngine engine_;
  const SweepRequest& request_;
  const int threads_;
  const fs::path folder_;
  const std::string name_ = fmt::format("elbowroom-sweep-{}-{}", HostName(), ::getpid());
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
