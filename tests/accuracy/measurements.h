// What `./dev bench` measures, and the tables and pictures that it leaves in docs/.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace elbowroom::accuracy {

// Each writes its sections of a document in `docs` and tells stderr how far it
// is. Throws: core::Error for what can't be written or run.

// accuracy.md, "budget". Throws also: core::Error{kRange} naming a term that exceeds its ceiling.
void MeasureBudget(const std::filesystem::path& docs);

// plane_sweep.md, "work" and "work_methods": the paper's figures of its plane sweep beside ours.
void MeasureSweepWork(const std::filesystem::path& docs);
// accuracy.md, "finger", "finger_directions", "finger_cameras"; docs/pictures/finger_width.{svg,png}.
void MeasureFinger(const std::filesystem::path& docs);

// accuracy.md, "chain", "chain_words", "chain_rigs"; docs/pictures/verdict_words.{svg,png}: the whole chain,
// from the board to the verdict, against the true object; `frames` of each of three rigs.
void MeasureChain(const std::filesystem::path& docs, int frames = 10'000);

// performance.md, "methods"; docs/pictures/view_methods.{svg,png}.
void MeasureMethods(const std::filesystem::path& docs);

// performance.md, "paper_setup": views a second of 320 x 240 from the paper's three cameras, 50 planes,
// beside its own.
void MeasurePaperSetup(const std::filesystem::path& docs);

// performance.md, "cost": instructions by callgrind, of `view_cost` (the program).
void MeasureCost(const std::filesystem::path& docs, const std::filesystem::path& view_cost);

// performance.md, "frames": the demo's motion, whole frames with their pictures in memory, `count` of them on
// one thread and on two; still and empty scenes beside.
void MeasureFrames(const std::filesystem::path& docs, int count = 10'000);

// performance.md, "memory": what each stage of the demo's frames asks the heap for, on one thread and on two.
void MeasureMemory(const std::filesystem::path& docs);

// cad_import.md, "import": whole commands of `program` (elbowroom) on a mesh file of a million triangles.
void MeasureImport(const std::filesystem::path& docs, const std::filesystem::path& program);

// calibration.md, "calibrate": whole runs of `program` (elbowroom) on pictures of a board.
void MeasureCalibration(const std::filesystem::path& docs, const std::filesystem::path& program);

// segmentation.md, "light": time and error of both methods when the light changes; light.md, "watch": what
// watching the light costs.
void MeasureLight(const std::filesystem::path& docs);

// performance.md, "pictures": the console's pictures of the demo's motion, with what stays kept and drawn
// anew, and how these differ.
void MeasurePictures(const std::filesystem::path& docs);

// performance.md, "detail": large parts drawn whole and by levels of detail, and how the pictures differ.
void MeasureDetail(const std::filesystem::path& docs);

// durability.md, "logging": frames with and without a session writer, and how soon they are on the disk.
void MeasureLogging(const std::filesystem::path& docs);

// scale.md, "growth", "engines", "change", "store", "site": sweeps by `program` (elbowroom) of so many
// simulated sessions of so many seconds each, by every engine, beside whether the results are the same;
// "hulls" and "hull_bounds": what bounds of the hulls, kept with the cells, would spare a changed part.
void MeasureScale(const std::filesystem::path& docs, const std::filesystem::path& program,
                  const std::vector<int>& sizes, double session_s = 16.0);

// performance.md, "judging" and "judging_cost"; docs/pictures/{contact,clearance}_methods.{svg,png}.
void MeasureJudging(const std::filesystem::path& docs);

// performance.md, "hard": contacts, clearance, recovery, heat map and view for shapes that are hard on
// purpose.
void MeasureHardShapes(const std::filesystem::path& docs);

// paper_collision.md, all its sections.
void MeasureCollisions(const std::filesystem::path& docs);

// performance.md, "micro": what Google Benchmark wrote into `json`.
void WriteMicroTable(const std::filesystem::path& docs, const std::filesystem::path& json);

// performance.md, "aims": what its tables "methods" and "micro" say of each aim. Throws also:
// core::Error{kFormat} where one of them lacks a figure.
void WriteAimsTable(const std::filesystem::path& docs);

}  // namespace elbowroom::accuracy
