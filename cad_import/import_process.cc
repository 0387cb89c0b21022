#include "cad_import/import_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "cad_import/formats/file_format.h"
#include "cad_import/import_protocol.h"
#include "cad_import/import_worker.h"
#include "cad_import/model/file_unit.h"
#include "core/error.h"
#include "core/system/child_process.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;
using Clock = std::chrono::steady_clock;

// Lines as they come through the pipe.
class MessageReader {
 public:
  explicit MessageReader(const core::Descriptor& pipe) : pipe_(pipe) {}

  // Reads what is there. False: nothing more will come.
  bool Read(const std::function<void(const ImportMessage&)>& hear) {
    std::array<char, 4096> chunk{};
    const ssize_t size = ::read(pipe_.number(), chunk.data(), chunk.size());
    if (size < 0) return errno == EINTR;
    if (size == 0) return false;
    for (const char letter : std::string_view(chunk.data(), static_cast<std::size_t>(size))) {
      if (letter == '\n') {
        hear(ParseMessage(line_));
        line_.clear();
      } else if (line_.size() < kLongestMessageBytes) {
        line_ += letter;
      }
    }
    return true;
  }

 private:
  const core::Descriptor& pipe_;
  std::string line_;
};

std::string MemoryText(std::int64_t bytes) {
  constexpr double kGib = 1024.0 * 1024.0 * 1024.0;
  return fmt::format("{:.3g} GiB", static_cast<double>(bytes) / kGib);
}

// The error for a child that ended without a last message.
Error ErrorOfEnd(const std::string& where, int status, const ImportLimits& limits) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU) {
      return {ErrorKind::kCad, fmt::format("{}: reading it took more than {} s of the processor; export a "
                                           "simpler model",
                                           where, limits.time_s)};
    }
    if (signal == SIGKILL) {
      return {ErrorKind::kCad,
              fmt::format("{}: reading it was stopped from outside, perhaps as the system was "
                          "short of memory; try it again, or with a smaller --memory-gib",
                          where)};
    }
    if (signal == SIGXFSZ) {
      return {ErrorKind::kCad,
              fmt::format("{}: it makes a larger model than the limit of {} allows; export a coarser one",
                          where, MemoryText(limits.memory_bytes))};
    }
    return {ErrorKind::kCad,
            fmt::format("{}: its reader crashed ({}), so the file is damaged or of a kind that the reader "
                        "can't take; export it again, or in another format",
                        where, ::sigabbrev_np(signal))};
  }
  return {ErrorKind::kCad,
          fmt::format("{}: its reader ended without an answer (status {}); export it again, or in "
                      "another format",
                      where, WEXITSTATUS(status))};
}

}  // namespace

MappedFile ImportInChild(const std::filesystem::path& file, const ImportOptions& options,
                         const core::Progress& progress, const std::stop_token& stop) {
  core::Require(ServesImports(), "a program that imports calls ServeImport first");
  const std::string where = file.string();
  core::Pipe pipe = core::MakePipe();
  const core::Descriptor result = core::MakeMemoryFile("import");
  core::Child child({.arguments = {"elbowroom", std::string(kImportWorkerArgument), where,
                                   NameOrDash(options.unit), NameOrDash(options.unit_if_file_has_none),
                                   fmt::format("{}", options.tolerance_mm.value_or(0.0)),
                                   fmt::format("{}", options.limits.memory_bytes),
                                   fmt::format("{}", options.limits.time_s)},
                     .gives = {&pipe.to, &result}});
  pipe.to.Close();

  const std::optional<FileFormat> format = FindFormat(file);
  const char* coarser = format && IsBoundaryRepresentation(*format) ? "--tolerance or " : "";
  bool is_done = false;
  std::optional<Error> failure;
  const auto hear = [&](const ImportMessage& message) {
    if (const auto* step = std::get_if<ProgressMessage>(&message)) {
      progress.Report(step->done, step->total, step->what);
    } else if (const auto* failed = std::get_if<FailureMessage>(&message)) {
      failure.emplace(failed->kind, failed->what);
    } else if (std::holds_alternative<OutOfMemoryMessage>(message)) {
      failure.emplace(
          ErrorKind::kCad,
          fmt::format("{}: reading it takes more than {} of memory; export a simpler model, or run "
                      "`elbowroom import` on it with a larger {}--memory-gib",
                      where, MemoryText(options.limits.memory_bytes), coarser));
    } else if (std::holds_alternative<DoneMessage>(message)) {
      is_done = true;
    }
  };
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(options.limits.time_s));
  const auto check = [&](core::Woken woken) {
    if (woken == core::Woken::kReady) return;
    core::ThrowIfStopped(stop, "import of " + where);
    throw Error(
        ErrorKind::kCad,
        fmt::format("{}: reading it takes more than {} s; export a simpler model, or run `elbowroom import` "
                    "on it with a larger {}--time-s",
                    where, options.limits.time_s, coarser));
  };
  MessageReader reader(pipe.from);
  do {
    check(core::WaitToRead(pipe.from, stop, deadline));
  } while (reader.Read(hear));
  // It has closed the pipe, so it is about to end; or it never will.
  check(child.WaitForEnd(stop, deadline));
  const int status = child.Wait();
  if (failure) throw Error(*failure);
  if (!is_done || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw ErrorOfEnd(where, status, options.limits);
  // Nothing that the child may have left behind can change it from here on.
  const bool is_sealed = ::fcntl(result.number(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_WRITE) == 0;
  std::optional<MappedFile> packed = is_sealed ? MappedFile::Of(result.number()) : std::nullopt;
  if (packed) return *std::move(packed);
  throw Error(ErrorKind::kCad, fmt::format("{}: its model can't be read back; import it again", where));
}

}  // namespace elbowroom::cad_import
