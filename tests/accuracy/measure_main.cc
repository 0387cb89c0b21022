// elbowroom_measure WHAT: the programs behind `./dev bench`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <vector>

#include "cad_import/import_worker.h"
#include "core/system/kept_memory.h"
#include "tests/accuracy/measurements.h"

int main(int argc, char** argv) {
  elbowroom::cad_import::ServeImport(argc, argv);  // returns unless this is a child that imports
  elbowroom::core::KeepFreedMemory();              // as the program does
  using namespace elbowroom::accuracy;
  CLI::App app{"Measures accuracy and speed, and writes the tables and pictures in docs/."};
  std::filesystem::path docs, view_cost, program, json;
  app.add_option("--docs", docs, "folder of the documents")->required();
  app.require_subcommand(1);
  app.fallthrough();
  app.add_subcommand("budget", "the paper's error budget")->callback([&] { MeasureBudget(docs); });
  app.add_subcommand("finger", "the paper's moving finger: how wide it is everywhere")->callback([&] {
    MeasureFinger(docs);
  });
  int chain_frames = 10'000;
  CLI::App* chain = app.add_subcommand("chain", "the whole chain: how often each verdict is right");
  chain->add_option("--count", chain_frames, "frames a rig")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  chain->callback([&] { MeasureChain(docs, chain_frames); });
  app.add_subcommand("work", "the paper's figures of its plane sweep beside ours")->callback([&] {
    MeasureSweepWork(docs);
  });
  app.add_subcommand("methods", "run time against error")->callback([&] { MeasureMethods(docs); });
  app.add_subcommand("paper", "the paper's own set-up: views a second")->callback([&] {
    MeasurePaperSetup(docs);
  });
  app.add_subcommand("collision", "the paper's collision method beside the exact one")->callback([&] {
    MeasureCollisions(docs);
  });
  app.add_subcommand("judging", "contacts and clearance: run time against error, and against what is asked")
      ->callback([&] { MeasureJudging(docs); });
  app.add_subcommand("hard", "shapes that are hard on purpose: half, 99 %, worst")->callback([&] {
    MeasureHardShapes(docs);
  });
  int frame_count = 10'000;
  CLI::App* frames = app.add_subcommand("frames", "whole frames of the demo");
  frames->add_option("--count", frame_count, "frames a run")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  frames->callback([&] { MeasureFrames(docs, frame_count); });
  CLI::App* imports = app.add_subcommand("import", "what an import costs");
  imports->add_option("PROGRAM", program, "elbowroom")->required();
  imports->callback([&] { MeasureImport(docs, program); });
  CLI::App* calibrations = app.add_subcommand("calibration", "what a calibration costs");
  calibrations->add_option("PROGRAM", program, "elbowroom")->required();
  calibrations->callback([&] { MeasureCalibration(docs, program); });
  app.add_subcommand("pictures", "the console's pictures of a moving hand")->callback([&] {
    MeasurePictures(docs);
  });
  app.add_subcommand("detail", "parts drawn whole and by levels")->callback([&] { MeasureDetail(docs); });
  app.add_subcommand("light", "segmentation when the light changes")->callback([&] { MeasureLight(docs); });
  app.add_subcommand("logging", "what recording costs a frame")->callback([&] { MeasureLogging(docs); });
  std::vector<int> sizes{25, 50, 100, 200};
  CLI::App* scale = app.add_subcommand("scale", "what sweeps of many sessions cost");
  scale->add_option("PROGRAM", program, "elbowroom")->required();
  scale->add_option("--sessions", sizes, "how many, in turn")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  double session_s = 16.0;
  scale->add_option("--seconds", session_s, "of a participant of usual speed")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  scale->callback([&] { MeasureScale(docs, program, sizes, session_s); });
  CLI::App* cost = app.add_subcommand("cost", "instructions by callgrind");
  cost->add_option("PROGRAM", view_cost, "view_cost")->required();
  cost->callback([&] { MeasureCost(docs, view_cost); });
  app.add_subcommand("aims", "the tables of methods and steps against the aims")->callback([&] {
    WriteAimsTable(docs);
  });
  CLI::App* micro = app.add_subcommand("micro", "Google Benchmark's results as a table");
  micro->add_option("JSON", json, "what --benchmark_out wrote")->required();
  micro->callback([&] { WriteMicroTable(docs, json); });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "elbowroom_measure: {}\n", error.what());
    return 1;
  }
  return 0;
}
