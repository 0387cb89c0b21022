// memory_use --docs DOCS: what the demo's frames ask the heap for. It is a program of its own, since its
// malloc counts: the times that elbowroom_measure takes are without that.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>

#include "tests/accuracy/measurements.h"

int main(int argc, char** argv) {
  CLI::App app{"Counts the allocations of the demo's frames, stage by stage, and writes the table in docs/."};
  std::filesystem::path docs;
  app.add_option("--docs", docs, "folder of the documents")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    elbowroom::accuracy::MeasureMemory(docs);
  } catch (const std::exception& error) {
    fmt::print(stderr, "memory_use: {}\n", error.what());
    return 1;
  }
  return 0;
}
