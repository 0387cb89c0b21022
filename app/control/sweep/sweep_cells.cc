#include "app/control/sweep/sweep_cells.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "app/control/versions.h"
#include "core/error.h"
#include "core/system/file_hash.h"
#include "core/system/file_sync.h"
#include "core/system/whole_file.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kCellFormat = "elbowroom-sweep-cells-2";
constexpr std::size_t kHashDigits = 32;

std::string HashOfContent(const fs::path& path) {
  std::string digits;
  for (const std::byte byte : core::HashOfFile(path)) digits += fmt::format("{:02x}", byte);
  return digits;
}

json JsonOf(const std::optional<double>& length_mm) { return length_mm ? json(*length_mm) : json(); }
std::optional<double> LengthFrom(const json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

json JsonOf(const review::PartAtSpacing& part) {
  return json::array({part.frames_in_contact, part.frames_near, part.frames_undecided, part.frames_clear,
                      part.deepest_mm, part.lower_mm, part.upper_mm,
                      part.closest_frame ? json(*part.closest_frame) : json()});
}
review::PartAtSpacing PartAtSpacingFrom(const json& value) {
  review::PartAtSpacing part{value.at(0), value.at(1), value.at(2), value.at(3),
                             value.at(4), value.at(5), value.at(6)};
  if (!value.at(7).is_null()) part.closest_frame = value.at(7).get<core::FrameIndex>();
  return part;
}

json JsonOf(const review::PartCurve& curve) {
  json steps = json::array();
  for (const review::PartAtSpacing& step : curve.steps) steps.push_back(JsonOf(step));
  return json::array(
      {curve.frames, JsonOf(curve.largest_touched_mm), JsonOf(curve.smallest_free_mm), std::move(steps)});
}
review::PartCurve PartCurveFrom(const json& value) {
  review::PartCurve curve{value.at(0), {}, LengthFrom(value.at(1)), LengthFrom(value.at(2))};
  for (const json& step : value.at(3)) curve.steps.push_back(PartAtSpacingFrom(step));
  return curve;
}

json JsonOf(const SweepCell& cell) {
  json curves = json::array();
  for (const review::PartCurve& curve : cell.part.curves) curves.push_back(JsonOf(curve));
  const review::StudyCount& count = cell.part.count;
  return json::array({cell.tools, std::move(curves),
                      json::array({count.asked, count.settled_by_motion, count.unmoved, count.queries,
                                   count.unchanged_frames})});
}
SweepCell CellFrom(const json& value) {
  SweepCell cell;
  cell.tools = value.at(0).get<std::vector<std::vector<std::string>>>();
  for (const json& curve : value.at(1)) cell.part.curves.push_back(PartCurveFrom(curve));
  const json& count = value.at(2);
  cell.part.count = {count.at(0), count.at(1), count.at(2), count.at(3), count.at(4)};
  return cell;
}

}  // namespace

std::string HashOfText(std::string_view text) {
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

// CBOR, RFC 8949: doubles keep their bits, strings their bytes. The hash of it stands behind.
std::string BytesOf(const SweepCellsByKey& cells) {
  json all = json::object();
  for (const auto& [key, cell] : cells) all[key] = JsonOf(cell);
  std::string bytes;
  json::to_cbor(json::array({kCellFormat, std::move(all)}), bytes);
  return bytes + HashOfText(bytes);
}

std::optional<SweepCellsByKey> ParseSweepCells(const std::string& bytes) {
  if (bytes.size() < kHashDigits) return std::nullopt;
  const std::string_view body = std::string_view(bytes).substr(0, bytes.size() - kHashDigits);
  if (bytes.substr(body.size()) != HashOfText(body)) return std::nullopt;
  try {
    const json whole = json::from_cbor(body);
    if (whole.at(0) != kCellFormat) return std::nullopt;
    SweepCellsByKey cells;
    for (const auto& [key, cell] : whole.at(1).items()) cells.emplace(key, CellFrom(cell));
    return cells;
  } catch (const json::exception&) {
    return std::nullopt;  // of another version of this program, whose format has the same name
  }
}

fs::path CellsIn(const fs::path& folder) { return folder / "cells"; }

std::set<std::string> CellFilesIn(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code none;
  const fs::path cells = CellsIn(folder);
  for (const auto& entry : fs::recursive_directory_iterator(cells, none))
    // A file that is being written has an extension.
    if (entry.is_regular_file() && !entry.path().has_extension())
      names.insert(entry.path().lexically_relative(cells).string());
  return names;
}

SweepCells::SweepCells(const fs::path& folder, const sessions::SessionReader& session,
                       const SpacingRange& range) {
  // The program itself is in it, too: another build may judge otherwise.
  static const std::string program = HashOfContent("/proc/self/exe");
  source_ = fmt::format("{} {} {} {} {} ", kCellFormat, ProgramVersion(), program, session.recording_id(),
                        HashOfContent(session.path()));
  folder_ = CellsIn(folder) / HashOfText(source_);
  source_ +=
      fmt::format("{} {:a} {:a} {:a}", HashOfText(range.spacing), range.from_mm, range.to_mm, range.step_mm);
  keeps_ = session.status() != sessions::SessionStatus::kRecording;
  if (!keeps_) return;
  core::MakeFolder(folder_);
  for (const auto& entry : fs::directory_iterator(folder_)) {
    if (entry.path().has_extension()) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    auto cells = ParseSweepCells({std::istreambuf_iterator<char>(file), {}});
    if (!cells) continue;
    const std::string name = entry.path().lexically_relative(CellsIn(folder)).string();
    for (const auto& [key, cell] : *cells) files_.emplace(key, name);
    cells_.merge(*cells);
  }
}

CellKey SweepCells::KeyOf(const CellQuestion& question) const {
  std::string text = fmt::format("{} {} {} {} {}", source_, question.first, question.end, question.mesh_hash,
                                 question.moves ? "moves" : "stays");
  for (const core::RigidTransform& pose : question.world_from_part) {
    for (const double value : pose.rotation.reshaped()) text += fmt::format(" {:a}", value);
    for (const double value : pose.translation_mm) text += fmt::format(" {:a}", value);
  }
  return HashOfText(text);
}

const SweepCell* SweepCells::Find(const CellKey& key) const {
  const auto found = cells_.find(key);
  return found == cells_.end() ? nullptr : &found->second;
}

std::string SweepCells::FileOf(const CellKey& key) const {
  const auto found = files_.find(key);
  return found == files_.end() ? "" : found->second;
}

std::optional<fs::path> SweepCells::FolderForHulls() const {
  if (!keeps_) return std::nullopt;
  return folder_.parent_path().parent_path() / "hulls" / folder_.filename();
}

void SweepCells::Keep(const SweepCellsByKey& cells) {
  if (keeps_) {
    const std::string bytes = BytesOf(cells);
    core::WriteWholeFile(folder_ / bytes.substr(bytes.size() - kHashDigits), bytes);
  }
  for (const auto& [key, cell] : cells) cells_.emplace(key, cell);
}

}  // namespace elbowroom::control
