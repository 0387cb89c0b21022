// docs/accuracy.md, "chain", "chain_words" and "chain_rigs"; docs/pictures/verdict_words.
#include <fmt/format.h>

#include <mutex>
#include <utility>

#include "tests/accuracy/chain/chain_study.h"
#include "tests/accuracy/chain/verdict_picture.h"
#include "tests/accuracy/measurements.h"
#include "tests/accuracy/quantile.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

using core::Verdict;
using reporting::Table;
using reporting::ThreeDigits;

constexpr DistanceRange kRanges[] = {{kTouching.from_mm, -5},
                                     {-5, -2},
                                     {-2, -1},
                                     {-1, 0},
                                     {0, 1},
                                     {1, 2},
                                     {2, 5},
                                     {5, 10},
                                     {10, 20},
                                     {20, 50},
                                     {50, 100}};

std::string NameOf(const DistanceRange& range) {
  if (range.from_mm == kTouching.from_mm) return fmt::format("overlap > {}", -range.to_mm);
  if (range.to_mm <= 0) return fmt::format("overlap {} to {}", -range.to_mm, -range.from_mm);
  return fmt::format("{} to {}", range.from_mm, range.to_mm);
}

std::string Percent(std::int64_t part, std::int64_t all) {
  if (all == 0) return "-";
  const double percent = 100.0 * static_cast<double>(part) / static_cast<double>(all);
  return part == 0 ? "0" : fmt::format("{:.{}f}", percent, percent < 1.0 || percent > 99.0 ? 2 : 1);
}

// A row a range of distances: the share of each word.
std::string SharesTable(const std::vector<ChainFigures>& rigs) {
  Table table{{"cameras", "true distance, mm", "parts"}, {}};
  for (const std::size_t rule : {kTouchRule, kClosestRule, kUsualRule})
    for (const char* word : {"clear", "undecided", "near", "contact"}) {
      const bool has_word = rule == kUsualRule || (rule == kClosestRule && word != std::string("near")) ||
                            word == std::string("clear") || word == std::string("contact");
      if (has_word) table.header.push_back(fmt::format("{:g}: {}", kRequiredMm[rule], word));
    }
  for (const ChainFigures& rig : rigs) {
    for (const DistanceRange& range : kRanges) {
      const std::int64_t all = rig.rules[kTouchRule].tally.Count(range);
      std::vector<std::string> row{fmt::format("{}", rig.cameras), NameOf(range), fmt::format("{}", all)};
      const auto add = [&](std::size_t rule, Verdict verdict) {
        row.push_back(Percent(rig.rules[rule].tally.Count(verdict, range), all));
      };
      add(kTouchRule, Verdict::kClear), add(kTouchRule, Verdict::kContact);
      add(kClosestRule, Verdict::kClear), add(kClosestRule, Verdict::kUndecided);
      add(kClosestRule, Verdict::kContact);
      add(kUsualRule, Verdict::kClear), add(kUsualRule, Verdict::kUndecided);
      add(kUsualRule, Verdict::kNear), add(kUsualRule, Verdict::kContact);
      table.rows.push_back(std::move(row));
    }
  }
  return reporting::ToMarkdown(table);
}

std::string WordsTable(const std::vector<ChainFigures>& rigs) {
  Table table{{"cameras", "required, mm", "parts", "truly touching", "`clear`", "of it touching",
               "% of `clear`", "% of touching", "of it nearer than required", "% of `clear`",
               "by, mm, at most", "`contact`", "of it the hull's alone", "% of `contact`", "`undecided`, %"},
              {}};
  for (const ChainFigures& rig : rigs) {
    for (std::size_t rule = 0; rule < kRequiredMm.size(); ++rule) {
      const RuleFigures& figures = rig.rules[rule];
      const VerdictTally& tally = figures.tally;
      const std::int64_t all = tally.Count(kAnywhere), touching = tally.Count(kTouching);
      const std::int64_t clear = tally.Count(Verdict::kClear, kAnywhere);
      const std::int64_t wrong = tally.Count(Verdict::kClear, kTouching);
      const std::int64_t contact = tally.Count(Verdict::kContact, kAnywhere);
      const std::int64_t alone = tally.Count(Verdict::kContact, kApart);
      table.rows.push_back({fmt::format("{}", rig.cameras), fmt::format("{:g}", kRequiredMm[rule]),
                            fmt::format("{}", all), fmt::format("{}", touching), fmt::format("{}", clear),
                            fmt::format("{}", wrong), Percent(wrong, clear), Percent(wrong, touching),
                            fmt::format("{}", figures.clear_but_nearer),
                            Percent(figures.clear_but_nearer, clear),
                            figures.clear_but_nearer > 0 ? ThreeDigits(figures.most_missing_mm) : "-",
                            fmt::format("{}", contact), fmt::format("{}", alone), Percent(alone, contact),
                            Percent(tally.Count(Verdict::kUndecided, kAnywhere), all)});
    }
  }
  return reporting::ToMarkdown(table);
}

std::string RigsTable(const std::vector<ChainFigures>& rigs) {
  Table table{
      {"cameras", "frames", "views kept out, px", "cameras' places off by, mm", "fastest solid: median, mm/s",
       "95 %", "farthest camera in time: median, ms", "95 %", "hull nearer than the object by: median, mm",
       "95 %", "U: median, mm", "95 %", "calibration, 1 sigma, mm", "segmentation", "skew",
       "truth below lower - U, %", "by, mm, at most", "no hull at all, %"},
      {}};
  const auto quantile = [](const std::vector<double>& values, double share) {
    return ThreeDigits(Quantile(values, share));
  };
  for (const ChainFigures& rig : rigs) {
    const std::int64_t all = rig.rules[kUsualRule].tally.Count(kAnywhere);
    table.rows.push_back({fmt::format("{}", rig.cameras), fmt::format("{}", rig.frames),
                          quantile(rig.held_out_px, 0.5), quantile(rig.center_error_mm, 0.5),
                          quantile(rig.fastest_mm_per_s, 0.5), quantile(rig.fastest_mm_per_s, 0.95),
                          quantile(rig.most_skew_ms, 0.5), quantile(rig.most_skew_ms, 0.95),
                          quantile(rig.hull_excess_mm, 0.5), quantile(rig.hull_excess_mm, 0.95),
                          quantile(rig.allowed_mm, 0.5), quantile(rig.allowed_mm, 0.95),
                          quantile(rig.calibration_mm, 0.5), quantile(rig.segmentation_mm, 0.5),
                          quantile(rig.skew_mm, 0.5), Percent(rig.nearer_than_bounds, rig.with_bounds),
                          rig.nearer_than_bounds > 0 ? ThreeDigits(rig.most_below_bounds_mm) : "-",
                          Percent(rig.without_hull, all)});
  }
  return reporting::ToMarkdown(table);
}

void DrawPicture(const std::vector<ChainFigures>& rigs, const std::filesystem::path& docs) {
  std::vector<std::vector<VerdictPanel>> rows;
  for (const std::size_t rule : {kClosestRule, kUsualRule}) {
    rows.emplace_back();
    for (const ChainFigures& rig : rigs)
      rows.back().push_back({fmt::format("{} cameras, {:g} mm required", rig.cameras, kRequiredMm[rule]),
                             rig.rules[rule].tally});
  }
  DrawVerdicts(rows, docs / "pictures" / "verdict_words");
}

// After each rig: the run is long.
void WriteSections(const std::vector<ChainFigures>& rigs, const std::filesystem::path& docs) {
  DrawPicture(rigs, docs);
  reporting::WriteSection(docs / "accuracy.md", "chain_words", WordsTable(rigs));
  reporting::WriteSection(docs / "accuracy.md", "chain", SharesTable(rigs));
  reporting::WriteSection(docs / "accuracy.md", "chain_rigs",
                          RigsTable(rigs) + "\n" + reporting::ToLine(reporting::ThisMachine(docs / "..")));
}

}  // namespace

void MeasureChain(const std::filesystem::path& docs, int frames) {
  constexpr int kCalibrations = 8, kFramesOfTrial = 50;
  std::mutex lines;
  const core::Progress progress([&](std::int64_t done, std::int64_t total, const std::string& what) {
    const std::scoped_lock lock(lines);
    fmt::print(stderr, "chain: {} {} of {}\n", what, done, total);
  });
  std::vector<ChainFigures> rigs;
  for (const int cameras : {3, 4, 8}) {
    ChainStudyOptions options;
    options.rig.cameras = cameras;
    options.calibrations = kCalibrations;
    options.frames = kFramesOfTrial;
    options.trials = (frames + kCalibrations * kFramesOfTrial - 1) / (kCalibrations * kFramesOfTrial);
    rigs.push_back(StudyChain(options, progress));
    WriteSections(rigs, docs);
  }
}

}  // namespace elbowroom::accuracy
