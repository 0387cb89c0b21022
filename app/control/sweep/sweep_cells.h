// Finished pieces of a sweep, kept as files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/control/sweep/spacing_sweep.h"
#include "review/spacing_study.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// What a stretch of a session's frames shows.
struct SweepCell {
  struct Curve {
    std::vector<std::string> tools;  // the frames in which just these were in use
    review::SpacingCurve curve;
  };
  std::vector<Curve> curves;
  review::StudyCount count;
};

// Text that gives back every bit. Nothing: it isn't what TextOf made under this key.
[[nodiscard]] std::string TextOf(const SweepCell& cell, const std::string& key);
[[nodiscard]] std::optional<SweepCell> ParseSweepCell(const std::string& text, const std::string& key);

// Where a sweep's folder has its cells.
[[nodiscard]] std::filesystem::path CellsIn(const std::filesystem::path& folder);

// The cells of one session and range. Thread: one at a time; several programs may share a folder.
class SweepCells {
 public:
  // A session that is still being recorded keeps none. Throws: core::Error{kFile}.
  SweepCells(const std::filesystem::path& folder, const sessions::SessionReader& session,
             const SpacingRange& range);

  // The name of the cell's file. The frames are those of the positions [first, end).
  [[nodiscard]] std::string NameOf(std::size_t first, std::size_t end) const;
  // Nothing: not kept, or damaged.
  [[nodiscard]] std::optional<SweepCell> Find(std::size_t first, std::size_t end) const;
  // Whole or not at all. Throws: core::Error{kFile}.
  void Keep(std::size_t first, std::size_t end, const SweepCell& cell) const;

 private:
  std::filesystem::path folder_;
  std::string source_;  // what a cell depends on beside its frames; empty: none is kept
};

}  // namespace elbowroom::control
