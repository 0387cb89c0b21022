#include "app/control/sweep/sweep_cells.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <string_view>

#include "app/control/versions.h"
#include "core/error.h"
#include "core/system/file_sync.h"
#include "core/system/whole_file.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCellFormat = "elbowroom-sweep-cell-1";

std::string HexOf(const XXH128_hash_t& hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}
std::string HashOfText(std::string_view text) { return HexOf(XXH3_128bits(text.data(), text.size())); }

// Of all that is in the file. Throws: Error{kFile}.
std::string HashOfContent(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
  XXH3_128bits_reset(state.get());
  std::vector<char> piece(std::size_t{1} << 20U);
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    XXH3_128bits_update(state.get(), piece.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (!file.eof())
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("'{}' can't be read; check it and its disk", path.string()));
  return HexOf(XXH3_128bits_digest(state.get()));
}

// A name as one word of a cell's text.
std::string WordOf(const std::string& name) {
  std::string word = "'";
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = byte > ' ' && byte != '%' && byte != 0x7f;
    word += is_plain ? std::string(1, c) : fmt::format("%{:02x}", byte);
  }
  return word;
}

// Takes a cell's text word by word. After the first word that isn't what it should be, all are wrong.
class CellWords {
 public:
  explicit CellWords(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool is_sound() const { return is_sound_; }
  [[nodiscard]] bool is_at_end() const { return is_sound_ && rest_.empty(); }

  std::string_view Word() {
    const std::size_t end = rest_.find_first_of(" \n");
    if (end == std::string_view::npos) {
      is_sound_ = false;
      return {};
    }
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return word;
  }

  std::int64_t Count() {
    const std::string_view word = Word();
    std::int64_t count = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (error != std::errc() || end != word.data() + word.size() || count < 0) is_sound_ = false;
    return is_sound_ ? count : 0;
  }

  double Length() {
    const std::string word(Word());
    char* end = nullptr;
    const double length_mm = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != '\0') is_sound_ = false;
    return length_mm;
  }

  std::optional<double> MaybeLength() {
    if (!rest_.starts_with("- ")) return Length();
    rest_.remove_prefix(2);
    return std::nullopt;
  }

  std::optional<core::FrameIndex> MaybeFrame() {
    if (!rest_.starts_with("-\n")) return Count();
    rest_.remove_prefix(2);
    return std::nullopt;
  }

  std::string Name() {
    const std::string_view word = Word();
    if (!word.starts_with('\'')) is_sound_ = false;
    std::string name;
    for (std::size_t i = 1; i < word.size(); ++i) {
      if (word[i] != '%') {
        name += word[i];
        continue;
      }
      unsigned byte = 0;
      if (i + 2 >= word.size() ||
          std::from_chars(&word[i + 1], &word[i + 1] + 2, byte, 16).ptr != &word[i + 1] + 2)
        is_sound_ = false;
      name += static_cast<char>(byte);
      i += 2;
    }
    return name;
  }

 private:
  std::string_view rest_;
  bool is_sound_ = true;
};

// The next word is this many things; false where the text can't hold so many.
bool IsPlausibleCount(std::int64_t count) { return count <= 1'000'000; }

std::string MaybeText(const std::optional<double>& length_mm) {
  return length_mm ? fmt::format("{:a}", *length_mm) : "-";
}

void AppendCurve(const SweepCell::Curve& of_tools, std::string* text) {
  const review::SpacingCurve& curve = of_tools.curve;
  *text += fmt::format("{}", of_tools.tools.size());
  for (const std::string& tool : of_tools.tools) *text += fmt::format(" {}", WordOf(tool));
  *text += fmt::format("\n{} {} {} {} {}\n", curve.frames, MaybeText(curve.largest_touched_mm),
                       MaybeText(curve.smallest_free_mm), curve.steps.size(),
                       curve.steps.empty() ? 0 : curve.steps.front().parts.size());
  for (const review::StudyStep& step : curve.steps) {
    *text += fmt::format("{:a}\n", step.spacing_mm);
    for (const review::PartAtSpacing& part : step.parts)
      *text += fmt::format("{} {} {} {} {:a} {:a} {:a} {}\n", part.frames_in_contact, part.frames_near,
                           part.frames_undecided, part.frames_clear, part.deepest_mm, part.lower_mm,
                           part.upper_mm, part.closest_frame ? std::to_string(*part.closest_frame) : "-");
  }
}

SweepCell::Curve ParseCurve(CellWords* words) {
  SweepCell::Curve of_tools;
  const std::int64_t tools = words->Count();
  for (std::int64_t i = 0; i < tools && words->is_sound(); ++i) of_tools.tools.push_back(words->Name());
  review::SpacingCurve& curve = of_tools.curve;
  curve.frames = words->Count();
  curve.largest_touched_mm = words->MaybeLength();
  curve.smallest_free_mm = words->MaybeLength();
  const std::int64_t steps = words->Count(), parts = words->Count();
  for (std::int64_t i = 0; i < steps && words->is_sound(); ++i) {
    review::StudyStep step{words->Length(), {}};
    for (std::int64_t k = 0; k < parts && words->is_sound(); ++k) {
      review::PartAtSpacing part;
      part.frames_in_contact = words->Count();
      part.frames_near = words->Count();
      part.frames_undecided = words->Count();
      part.frames_clear = words->Count();
      part.deepest_mm = words->Length();
      part.lower_mm = words->Length();
      part.upper_mm = words->Length();
      part.closest_frame = words->MaybeFrame();
      step.parts.push_back(part);
    }
    curve.steps.push_back(std::move(step));
  }
  return of_tools;
}

}  // namespace

std::string TextOf(const SweepCell& cell, const std::string& key) {
  const review::StudyCount& count = cell.count;
  std::string text =
      fmt::format("{} {}\n{} {} {} {} {}\n{}\n", kCellFormat, key, count.asked, count.settled_by_motion,
                  count.unmoved, count.queries, count.unchanged_frames, cell.curves.size());
  for (const SweepCell::Curve& curve : cell.curves) AppendCurve(curve, &text);
  return text + HashOfText(text) + "\n";
}

std::optional<SweepCell> ParseSweepCell(const std::string& text, const std::string& key) {
  constexpr std::size_t kHashAndNewline = 33;
  if (text.size() < kHashAndNewline) return std::nullopt;
  const std::string_view body = std::string_view(text).substr(0, text.size() - kHashAndNewline);
  if (text.substr(body.size()) != HashOfText(body) + "\n") return std::nullopt;
  CellWords words(body);
  if (words.Word() != kCellFormat || words.Word() != key) return std::nullopt;
  SweepCell cell;
  cell.count = {words.Count(), words.Count(), words.Count(), words.Count(), words.Count()};
  const std::int64_t curves = words.Count();
  if (!IsPlausibleCount(curves)) return std::nullopt;
  for (std::int64_t i = 0; i < curves && words.is_sound(); ++i) cell.curves.push_back(ParseCurve(&words));
  if (!words.is_at_end()) return std::nullopt;
  return cell;
}

fs::path CellsIn(const fs::path& folder) { return folder / "cells"; }

SweepCells::SweepCells(const fs::path& folder, const sessions::SessionReader& session,
                       const SpacingRange& range)
    : folder_(CellsIn(folder)) {
  if (session.status() == sessions::SessionStatus::kRecording) return;
  core::MakeFolder(folder_);
  // The program itself is in it, too: another build may judge otherwise.
  static const std::string program = HashOfContent("/proc/self/exe");
  source_ = fmt::format("{} {} {} {} {} {} {:a} {:a} {:a}", kCellFormat, ProgramVersion(), program,
                        session.recording_id(), HashOfContent(session.path()), WordOf(range.spacing),
                        range.from_mm, range.to_mm, range.step_mm);
}

std::string SweepCells::NameOf(std::size_t first, std::size_t end) const {
  return HashOfText(fmt::format("{} {} {}", source_, first, end));
}

std::optional<SweepCell> SweepCells::Find(std::size_t first, std::size_t end) const {
  if (source_.empty()) return std::nullopt;
  const std::string key = NameOf(first, end);
  std::ifstream file(folder_ / key, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  return ParseSweepCell(text, key);
}

void SweepCells::Keep(std::size_t first, std::size_t end, const SweepCell& cell) const {
  if (source_.empty()) return;
  const std::string key = NameOf(first, end);
  core::WriteWholeFile(folder_ / key, TextOf(cell, key));
}

}  // namespace elbowroom::control
