// Finished pieces of a sweep, kept as files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/control/sweep/spacing_sweep.h"
#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"
#include "review/spacing_study.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// What a stretch of a session's frames shows of one part.
struct SweepCell {
  std::vector<std::vector<std::string>> tools;  // of each group of frames: those in use
  review::PartStudy part;                       // its curves: one a group
};

// What a cell depends on beside its session and range.
struct CellQuestion {
  std::size_t first = 0, end = 0;  // positions of its frames among those that are swept
  std::string mesh_hash;           // core::ContentHash
  bool moves = false;              // with the spacing that is swept
  // Of the part at each step, for each set of spacings that the frames have.
  std::vector<core::RigidTransform> world_from_part;
};

using CellKey = std::string;  // 32 hex digits
using SweepCellsByKey = std::map<CellKey, SweepCell>;

// Bytes that give back every bit of the cells. Nothing: they aren't what BytesOf made.
[[nodiscard]] std::string BytesOf(const SweepCellsByKey& cells);
[[nodiscard]] std::optional<SweepCellsByKey> ParseSweepCells(const std::string& bytes);

// 128-bit XXH3 as 32 hex digits: what is kept is named after it.
[[nodiscard]] std::string HashOfText(std::string_view text);

// Where a sweep's folder has its cells: a folder for each session, with a file for each set of cells that
// were found together. Two such folders are merged by copying one into the other.
[[nodiscard]] std::filesystem::path CellsIn(const std::filesystem::path& folder);

// The files there, from CellsIn on.
[[nodiscard]] std::set<std::string> CellFilesIn(const std::filesystem::path& folder);

// The cells of one session and range. Thread: one at a time; several programs may share a folder.
class SweepCells {
 public:
  // Reads what is kept of the session; files that are damaged count as not there. A session that is still
  // being recorded keeps none. Throws: core::Error{kFile}.
  SweepCells(const std::filesystem::path& folder, const sessions::SessionReader& session,
             const SpacingRange& range);

  [[nodiscard]] CellKey KeyOf(const CellQuestion& question) const;
  // Null: not kept.
  [[nodiscard]] const SweepCell* Find(const CellKey& key) const;
  // The name of the file that it was read from, as CellFilesIn gives it; empty: it wasn't there at first.
  [[nodiscard]] std::string FileOf(const CellKey& key) const;
  // Where hulls of the session are kept. Nothing: it is still being recorded.
  [[nodiscard]] std::optional<std::filesystem::path> FolderForHulls() const;
  // In one file, whole or not at all. Throws: core::Error{kFile}.
  void Keep(const SweepCellsByKey& cells);

 private:
  std::filesystem::path folder_;
  std::string source_;  // what all cells depend on
  bool keeps_ = false;
  SweepCellsByKey cells_;
  std::map<CellKey, std::string> files_;
};

}  // namespace elbowroom::control
