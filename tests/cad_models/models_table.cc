#include "tests/cad_models/models_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <iterator>
#include <optional>
#include <vector>

#include "cad_import/formats/file_format.h"
#include "core/error.h"
#include "tests/cad_models/model_answers.h"
#include "tests/cad_models/model_comparison.h"
#include "tests/cad_models/model_files.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/support/places.h"

namespace elbowroom::cad_models {
namespace {

namespace fs = std::filesystem;
using reporting::ThreeDigits;

// The two readers of one file follow each other; times are of a machine with that to do.
constexpr int kAtOnce = 2;

struct Surveyed {
  ModelFile file;
  cad_import::FileFormat format{};
  OurAnswer ours;
  TheirAnswer theirs;
  std::vector<std::string> differences;  // where both have read it
};

struct Collections {
  std::vector<ModelFile> files;
  std::vector<std::string> missing;
};

Collections FindCollections() {
  Collections found;
  const auto add = [&](const std::string& name, const std::optional<std::vector<ModelFile>>& files) {
    if (files) {
      found.files.insert(found.files.end(), files->begin(), files->end());
    } else {
      fmt::print(stderr, "cad_models: NOT MEASURED: {} is not on this machine\n", name);
      found.missing.push_back(name);
    }
  };
  add("shared/data/cad", FilesOfFolder(test_support::SharedDataFolder() / "cad", "cad"));
  for (const char* package : {"assimp-testmodels", "occt-misc"}) add(package, FilesOfPackage(package));
  return found;
}

Surveyed Survey(const ModelFile& file) {
  Surveyed result{file,
                  cad_import::FormatOfExtension(file.path),
                  AskOurs("/proc/self/exe", file.path),
                  AskTheirs(ELBOWROOM_SECOND_READER, file.path),
                  {}};
  if (result.ours.error.empty() && result.theirs.error.empty())
    result.differences = DifferencesOf(result.format, result.ours, result.theirs);
  return result;
}

std::string SizeText(const Eigen::Vector3d& size_mm) {
  return fmt::format("{} x {} x {}", ThreeDigits(size_mm.x()), ThreeDigits(size_mm.y()),
                     ThreeDigits(size_mm.z()));
}

// Whether the two agree; where they don't, why not, if anybody knows.
std::string Verdict(const Surveyed& model) {
  const std::string reason = ReasonFor(model.file.name);
  if (!model.theirs.error.empty())
    return reason.empty() ? "it refuses: " + model.theirs.error : "it refuses: " + reason;
  if (model.differences.empty()) return "yes";
  return fmt::format("{}: {}", fmt::join(model.differences, ", "), reason.empty() ? "UNEXPLAINED" : reason);
}

std::string OrDash(const std::optional<std::int64_t>& count) { return count ? std::to_string(*count) : "-"; }

std::string TheirParts(const TheirAnswer& theirs) {
  if (!theirs.pieces || theirs.nodes > 1) return std::to_string(theirs.nodes);
  return std::to_string(*theirs.pieces);
}

std::vector<std::string> RowOf(const Surveyed& model) {
  const OurAnswer& ours = model.ours;
  const TheirAnswer& theirs = model.theirs;
  const bool has_read = theirs.error.empty();
  return {model.file.name,
          std::string(cad_import::ToString(model.format)),
          ours.unit,
          std::to_string(ours.parts),
          fmt::format("{} / {}", ours.instances, ours.shapes),
          std::to_string(ours.triangles),
          SizeText(ours.size_mm),
          ours.watertight ? "yes" : "no",
          ThreeDigits(ours.time_ms),
          fmt::format("{:.0f}", ours.peak_mb),
          theirs.reader.empty() ? "-" : theirs.reader,
          has_read ? TheirParts(theirs) : "-",
          has_read ? OrDash(theirs.triangles) : "-",
          has_read ? SizeText(theirs.size_mm) : "-",
          Verdict(model)};
}

const std::vector<std::string> kHeader = {
    "file",          "format",    "unit",          "parts",        "instances / shapes",
    "triangles",     "size, mm",  "closed",        "ms",           "MB",
    "second reader", "its parts", "its triangles", "its size, mm", "agree"};

std::string WithoutPath(const std::string& line, const ModelFile& file) {
  const std::string path = file.path.string() + ": ";
  return line.starts_with(path) ? line.substr(path.size()) : line;
}

std::string TheirVerdict(const Surveyed& model) {
  if (!model.theirs.error.empty()) return "refuses: " + model.theirs.error;
  return fmt::format("{}: {} triangles, {} mm", model.theirs.reader, OrDash(model.theirs.triangles),
                     SizeText(model.theirs.size_mm));
}

std::vector<std::string> RefusedRowOf(const Surveyed& model) {
  return {model.file.name,
          WithoutPath(model.ours.error, model.file),
          ThreeDigits(model.ours.time_ms),
          fmt::format("{:.0f}", model.ours.peak_mb),
          TheirVerdict(model),
          ReasonFor(model.file.name)};
}

const std::vector<std::string> kRefusedHeader = {
    "file", "the line that the user gets", "ms", "MB", "second reader", "why it is right"};

std::string Summary(const std::vector<Surveyed>& models, const std::vector<std::string>& missing) {
  const auto count = [&](auto holds) { return std::ranges::count_if(models, holds); };
  const auto is_imported = [](const Surveyed& m) { return m.ours.error.empty(); };
  const auto is_compared = [&](const Surveyed& m) { return is_imported(m) && m.theirs.error.empty(); };
  const auto is_crashed = [](const Surveyed& m) {
    return m.ours.error.find("its reader crashed") != std::string::npos;
  };
  const auto is_unexplained = [&](const Surveyed& m) {
    const bool is_odd = is_compared(m) ? !m.differences.empty() : !is_imported(m) && m.theirs.error.empty();
    return is_odd && ReasonFor(m.file.name).empty();
  };
  std::string text = fmt::format(
      "{} files: {} imported, {} refused with one line (of them {} crashed their reader). Of the imported, "
      "the second "
      "reader reads {}; {} agree in size, parts and triangles, {} differ, each for the reason in its row",
      models.size(), count(is_imported), count(std::not_fn(is_imported)), count(is_crashed),
      count(is_compared), count([&](const Surveyed& m) { return is_compared(m) && m.differences.empty(); }),
      count([&](const Surveyed& m) { return is_compared(m) && !m.differences.empty(); }));
  const auto unexplained = count(is_unexplained);
  text += unexplained == 0 ? "." : fmt::format(", but for {} that nobody has explained.", unexplained);
  for (const std::string& name : missing) text += fmt::format(" Not on this machine: {}.", name);
  return text + "\n";
}

}  // namespace

void WriteModelTables(const fs::path& docs, const std::string& only) {
  const Collections collections = FindCollections();
  std::vector<ModelFile> files;
  std::ranges::copy_if(collections.files, std::back_inserter(files),
                       [&](const ModelFile& file) { return file.name.find(only) != std::string::npos; });
  std::vector<Surveyed> models(files.size());
  std::atomic<int> done = 0;
  tbb::task_arena(kAtOnce).execute([&] {
    tbb::parallel_for(std::size_t{0}, files.size(), [&](std::size_t i) {
      models[i] = Survey(files[i]);
      fmt::print(stderr, "models: {} of {}\r", ++done, files.size());
    });
  });
  if (!only.empty() || docs.empty()) {
    for (const Surveyed& model : models)
      fmt::print("{}\n", fmt::join(model.ours.error.empty() ? RowOf(model) : RefusedRowOf(model), " | "));
    fmt::print("{}", Summary(models, collections.missing));
    return;
  }
  reporting::Table imported{kHeader, {}}, refused{kRefusedHeader, {}};
  for (const Surveyed& model : models) {
    if (model.ours.error.empty()) {
      imported.rows.push_back(RowOf(model));
    } else {
      refused.rows.push_back(RefusedRowOf(model));
    }
  }
  const std::string machine = fmt::format("\n{}", reporting::ToLine(reporting::ThisMachine(docs / "..")));
  const fs::path file = docs / "cad_models.md";
  reporting::WriteSection(file, "models_summary", Summary(models, collections.missing) + machine);
  reporting::WriteSection(file, "models", reporting::ToMarkdown(imported));
  reporting::WriteSection(file, "models_refused", reporting::ToMarkdown(refused));
}

}  // namespace elbowroom::cad_models
