// cad_models: the program behind `./dev bench models`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include "cad_import/import_worker.h"
#include "tests/cad_models/model_answers.h"
#include "tests/cad_models/models_table.h"

int main(int argc, char** argv) {
  using namespace elbowroom;
  cad_import::ServeImport(argc, argv);
  ::setenv("ELBOWROOM_CACHE", "off", 1);
  CLI::App app{
      "Imports every CAD file there is, asks another reader, and writes the tables of docs/cad_models.md."};
  std::filesystem::path docs, one;
  std::string only;
  app.add_option("--docs", docs, "folder of the documents");
  app.add_option("--one", one, "import this file and print what it holds, as JSON");
  app.add_option("--only", only, "print the rows of files whose names hold this; write nothing");
  try {
    app.parse(argc, argv);
    if (!one.empty()) {
      cad_models::ServeOurAnswer(one);
    } else {
      cad_models::WriteModelTables(docs, only);
    }
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "cad_models: {}\n", error.what());
    return 1;
  }
  return 0;
}
