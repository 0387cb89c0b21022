#include "recon/footage/stamped_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>

#include "core/error.h"
#include "core/system/configuration_file.h"

namespace elbowroom::recon {
namespace {

using core::FrameIndex;

// More frames than days of footage have.
constexpr FrameIndex kMostFrames = 100'000'000;

std::vector<std::string_view> Fields(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    std::string_view field = line.substr(0, comma);
    while (!field.empty() && (field.front() == ' ' || field.front() == '"')) field.remove_prefix(1);
    while (!field.empty() && (field.back() == ' ' || field.back() == '"' || field.back() == '\r'))
      field.remove_suffix(1);
    fields.push_back(field);
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

template <typename Number>
std::optional<Number> Parsed(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// A table of stamps, line by line.
class StampTable {
 public:
  StampTable(const std::filesystem::path& path, const std::string& who)
      : who_(fmt::format("{}: stamps '{}'", who, path.string())),
        text_(core::ReadConfiguration(path, who_, "table of stamps")) {}

  FrameTable Read() {
    std::string line;
    if (!std::getline(text_, line)) Fail("is empty; it needs the columns frame and time_s");
    ReadHeader(line);
    FrameTable table;
    while (std::getline(text_, line)) {
      ++line_;
      if (line.find_first_not_of(" \r\t") != std::string::npos) ReadLine(line, &table);
    }
    if (table.time_s.empty()) Fail("has no stamps");
    return table;
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw core::Error(core::ErrorKind::kFormat, fmt::format("{}, line {}: {}", who_, line_, what));
  }

  void ReadHeader(const std::string& line) {
    const std::vector<std::string_view> names = Fields(line);
    const auto column = [&](std::string_view name) {
      const auto found = std::ranges::find(names, name);
      if (found == names.end()) Fail(fmt::format("has no column '{}'; it needs frame and time_s", name));
      return static_cast<std::size_t>(found - names.begin());
    };
    frame_column_ = column("frame");
    time_column_ = column("time_s");
    if (std::ranges::find(names, "picture") != names.end()) picture_column_ = column("picture");
  }

  void ReadLine(const std::string& line, FrameTable* table) {
    FrameStamps* stamps = &table->time_s;
    const std::vector<std::string_view> fields = Fields(line);
    if (fields.size() <= std::max({frame_column_, time_column_, picture_column_.value_or(0)}))
      Fail("has too few columns");
    const auto frame = Parsed<FrameIndex>(fields[frame_column_]);
    const auto time_s = Parsed<double>(fields[time_column_]);
    if (!frame || *frame < 0 || *frame >= kMostFrames)
      Fail(fmt::format("'{}' is no frame's number", fields[frame_column_]));
    if (!time_s || !std::isfinite(*time_s)) Fail(fmt::format("'{}' is no time", fields[time_column_]));
    const auto at = static_cast<std::size_t>(*frame);
    if (at < stamps->size()) Fail(fmt::format("frame {} comes after frame {}", at, stamps->size() - 1));
    if (!stamps->empty() && *time_s <= *stamps->back()) {
      Fail(fmt::format("the stamp of frame {} goes back, from {} s to {} s; stamps must grow", at,
                       *stamps->back(), *time_s));
    }
    stamps->resize(at + 1);
    stamps->back() = *time_s;
    if (!picture_column_) return;
    const auto picture = Parsed<std::uint64_t>(fields[*picture_column_]);
    if (!picture) Fail(fmt::format("'{}' is no picture's number", fields[*picture_column_]));
    table->pictures.resize(at + 1);
    table->pictures.back() = *picture;
  }

  std::string who_;
  std::istringstream text_;
  int line_ = 1;
  std::size_t frame_column_ = 0;
  std::size_t time_column_ = 0;
  std::optional<std::size_t> picture_column_;
};

std::vector<StampedFrame> Present(const FrameStamps& stamps) {
  std::vector<StampedFrame> present;
  for (std::size_t i = 0; i < stamps.size(); ++i)
    if (stamps[i]) present.push_back({static_cast<FrameIndex>(i), *stamps[i]});
  return present;
}

// For each of `times` the nearest stamp within `reach_s`. Two times that have the same nearest one don't
// share it: it goes to the nearer.
std::vector<std::optional<StampedFrame>> Nearest(const std::vector<StampedFrame>& stamps,
                                                 const std::vector<StampedFrame>& times, double reach_s) {
  std::vector<std::optional<StampedFrame>> nearest(times.size());
  std::optional<std::size_t> last;  // the time that took the last stamp
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double time_s = times[i].time_s;
    auto after = std::ranges::lower_bound(stamps, time_s, {}, &StampedFrame::time_s);
    if (after == stamps.end() ||
        (after != stamps.begin() && time_s - std::prev(after)->time_s <= after->time_s - time_s))
      --after;
    if (std::abs(after->time_s - time_s) > reach_s) continue;
    if (last && nearest[*last]->frame == after->frame) {
      if (std::abs(after->time_s - times[*last].time_s) <= std::abs(after->time_s - time_s)) continue;
      nearest[*last].reset();
    }
    nearest[i] = *after;
    last = i;
  }
  return nearest;
}

using Stamps = std::vector<StampedFrame>;

std::vector<Stamps> AllPresent(std::span<const FrameStamps> cameras) {
  std::vector<Stamps> present;
  for (const FrameStamps& stamps : cameras) present.push_back(Present(stamps));
  return present;
}

// How far the others are from this camera's frames: the sum of the medians, looked at in some places.
double SpreadAround(const Stamps& leader, const std::vector<Stamps>& others) {
  constexpr std::size_t kMostPlaces = 200;
  const std::size_t step = leader.size() / kMostPlaces + 1;
  double spread_s = 0.0;
  for (const Stamps& other : others) {
    std::vector<double> distances_s;
    for (std::size_t i = 0; i < leader.size(); i += step) {
      const double time_s = leader[i].time_s;
      const auto after = std::ranges::lower_bound(other, time_s, {}, &StampedFrame::time_s);
      double nearest_s =
          after == other.end() ? std::numeric_limits<double>::infinity() : after->time_s - time_s;
      if (after != other.begin()) nearest_s = std::min(nearest_s, time_s - std::prev(after)->time_s);
      distances_s.push_back(nearest_s);
    }
    const auto middle = distances_s.begin() + static_cast<std::ptrdiff_t>(distances_s.size() / 2);
    std::nth_element(distances_s.begin(), middle, distances_s.end());
    spread_s += *middle;
  }
  return spread_s;
}

// Which camera's frames make the sets.
std::size_t LeaderOf(const std::vector<Stamps>& cameras, const std::vector<double>& periods_s) {
  constexpr double kSameRate = 0.95;
  const double longest_s = *std::ranges::max_element(periods_s);
  std::size_t leader = 0;
  double least_s = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (periods_s[i] < kSameRate * longest_s) continue;
    const double spread_s = SpreadAround(cameras[i], cameras);
    if (spread_s >= least_s) continue;
    leader = i;
    least_s = spread_s;
  }
  return leader;
}

// The leader's stamps, and between them the times at which those that are missing were due.
Stamps DueTimes(const Stamps& leader, double period_s) {
  Stamps times;
  for (const StampedFrame& frame : leader) {
    if (!times.empty() && period_s > 0.0) {
      const double from_s = times.back().time_s, gap_s = frame.time_s - from_s;
      const double periods = std::min(std::round(gap_s / period_s), static_cast<double>(kMostFrames));
      for (double k = 1.0; k < periods; k += 1.0) times.push_back({-1, from_s + gap_s * k / periods});
    }
    times.push_back(frame);
  }
  return times;
}

}  // namespace

FrameStamps ReadFrameStamps(const std::filesystem::path& path, const std::string& who) {
  return ReadFrameTable(path, who).time_s;
}

FrameTable ReadFrameTable(const std::filesystem::path& path, const std::string& who) {
  return StampTable(path, who).Read();
}

std::optional<double> MedianPeriod(const FrameStamps& stamps) {
  const std::vector<StampedFrame> present = Present(stamps);
  if (present.size() < 2) return std::nullopt;
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < present.size(); ++i)
    periods_s.push_back(present[i].time_s - present[i - 1].time_s);
  const auto middle = periods_s.begin() + static_cast<std::ptrdiff_t>(periods_s.size() / 2);
  std::nth_element(periods_s.begin(), middle, periods_s.end());
  return *middle;
}

std::vector<StampedSet> SetsByNearestStamp(std::span<const FrameStamps> cameras) {
  const std::vector<Stamps> present = AllPresent(cameras);
  const auto fewest = std::ranges::min_element(present, {}, &Stamps::size);
  if (fewest == present.end() || fewest->empty()) return {};
  std::vector<StampedSet> sets(fewest->size());
  for (StampedSet& set : sets) set.frames.resize(cameras.size());
  for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
    const double reach_s = 0.5 * MedianPeriod(cameras[camera]).value_or(0.0);
    const bool decides = &present[camera] == &*fewest;
    const std::vector<std::optional<StampedFrame>> nearest =
        Nearest(present[camera], *fewest, decides ? 0.0 : reach_s);
    for (std::size_t i = 0; i < sets.size(); ++i) sets[i].frames[camera] = nearest[i];
  }
  return sets;
}

std::vector<StampedSet> SetsOfAllTimes(std::span<const FrameStamps> cameras) {
  const std::vector<Stamps> present = AllPresent(cameras);
  if (present.empty() || std::ranges::any_of(present, &Stamps::empty)) return {};
  std::vector<double> periods_s;
  for (const FrameStamps& stamps : cameras) periods_s.push_back(MedianPeriod(stamps).value_or(0.0));
  const std::size_t leader = LeaderOf(present, periods_s);
  const double reach_s = 0.5 * periods_s[leader];
  double from_s = -std::numeric_limits<double>::infinity(), to_s = -from_s;
  for (const Stamps& stamps : present) {
    from_s = std::max(from_s, stamps.front().time_s - reach_s);
    to_s = std::min(to_s, stamps.back().time_s + reach_s);
  }
  Stamps times = DueTimes(present[leader], periods_s[leader]);
  std::erase_if(times, [&](const StampedFrame& time) { return time.time_s < from_s || time.time_s > to_s; });
  std::vector<StampedSet> sets(times.size());
  for (StampedSet& set : sets) set.frames.resize(cameras.size());
  for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
    const auto nearest = Nearest(present[camera], times, 0.5 * periods_s[camera]);
    for (std::size_t i = 0; i < sets.size(); ++i) sets[i].frames[camera] = nearest[i];
  }
  std::erase_if(sets, [](const StampedSet& set) {
    return std::ranges::none_of(set.frames, [](const auto& frame) { return frame.has_value(); });
  });
  return sets;
}

}  // namespace elbowroom::recon
