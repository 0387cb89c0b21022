#include "cad_import/import_worker.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <charconv>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cad_import/file_reader.h"
#include "cad_import/import_protocol.h"
#include "cad_import/model/import_options.h"
#include "cad_import/packed_model.h"
#include "core/error.h"
#include "core/progress.h"
#include "core/system/child_process.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;

// The model may take this fraction (1 / 4) of the memory limit: it is handed over in memory, and the parent
// reads it whole.
constexpr double kResultShare = 4.0;
// The limit of processor time, in multiples of the time limit, which the parent watches: the child may run
// many threads.
constexpr double kCpuSlack = 64.0;

std::atomic<bool> serves_imports{false};

void Say(const auto& message) {
  const std::string line = ToLine(message);
  if (!core::WriteAll(kMessageDescriptor, std::as_bytes(std::span(line)))) std::_Exit(EXIT_FAILURE);
}

[[noreturn]] void FailForMemory() {
  (void)!::write(kMessageDescriptor, kOutOfMemoryLine.data(), kOutOfMemoryLine.size());
  std::_Exit(EXIT_FAILURE);
}

void LimitTo(const ImportLimits& limits) {
  const auto memory_bytes = static_cast<double>(limits.memory_bytes);
  core::LimitMyself({.memory_bytes = memory_bytes,
                     .file_bytes = memory_bytes / kResultShare,
                     .cpu_s = limits.time_s * kCpuSlack + 1.0});
  std::set_new_handler(FailForMemory);
}

struct Request {
  std::filesystem::path file;
  ImportOptions options;
};

template <typename Number>
Number ParseNumber(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  core::Require(error == std::errc{} && end == text.data() + text.size(), "a parent's request has numbers");
  return number;
}

Request ParseRequest(std::span<char* const> arguments) {
  core::Require(arguments.size() == 6, "a parent's request has six words");
  Request request{arguments[0], {}};
  request.options.unit = core::ParseLengthUnit(arguments[1]);
  request.options.unit_if_file_has_none = core::ParseLengthUnit(arguments[2]);
  if (const auto tolerance_mm = ParseNumber<double>(arguments[3]); tolerance_mm > 0.0)
    request.options.tolerance_mm = tolerance_mm;
  request.options.limits.memory_bytes = ParseNumber<std::int64_t>(arguments[4]);
  request.options.limits.time_s = ParseNumber<double>(arguments[5]);
  return request;
}

[[noreturn]] void Work(const Request& request) {
  const core::Progress progress([](std::int64_t done, std::int64_t total, const std::string& what) {
    Say(ProgressMessage{done, total, what});
  });
  try {
    PrepareToRead(request.file);
    LimitTo(request.options.limits);
    const PackedModel content = ReadCadFile(request.file, request.options, progress);
    if (core::WriteAll(kResultDescriptor, Pack(content.model, content.referred))) {
      Say(DoneMessage{});
      std::_Exit(EXIT_SUCCESS);
    }
    Say(FailureMessage{
        ErrorKind::kCad,
        fmt::format("{}: its model can't be handed over; export a coarser one", request.file.string())});
  } catch (const Error& error) {
    Say(FailureMessage{error.kind(), error.what()});
  } catch (const std::bad_alloc&) {
    FailForMemory();
  } catch (const std::exception& exception) {
    Say(FailureMessage{ErrorKind::kCad, fmt::format("{}: can't be read ({}); export it again",
                                                    request.file.string(), exception.what())});
  }
  std::_Exit(EXIT_FAILURE);  // without the libraries' destructors
}

}  // namespace

void ServeImport(int argc, char** argv) {
  serves_imports = true;
  const std::span<char* const> arguments(argv, static_cast<std::size_t>(argc));
  if (arguments.size() >= 2 && arguments[1] == kImportWorkerArgument)
    Work(ParseRequest(arguments.subspan(2)));
}

bool ServesImports() { return serves_imports; }

}  // namespace elbowroom::cad_import
