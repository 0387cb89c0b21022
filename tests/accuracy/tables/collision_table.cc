// docs/paper_collision.md, all its tables.
#include <fmt/format.h>

#include <vector>

#include "tests/accuracy/collision_comparison.h"
#include "tests/accuracy/measurements.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

using reporting::ThreeDigits;

constexpr int kTrials = 600, kSolids = 24, kRays = 160;
constexpr std::uint64_t kSeed = 7601;
constexpr TimingEffort kEffort{.repetitions = 101};  // of some milliseconds each

// What is measured of one part.
struct PartCosts {
  CollisionPart part;
  std::vector<CollisionCost> three, paper;  // rigs
  std::vector<SmallContacts> sizes;
};

std::string Both(const ErrorShare& share) {
  return ThreeDigits(share.median) + " / " + ThreeDigits(share.p95);
}

std::string RangeOf(double from_mm, double to_mm) {
  return to_mm > 1e6 ? fmt::format("{} mm and more", from_mm) : fmt::format("{} to {} mm", from_mm, to_mm);
}

// "missed of contacts", those smaller than a sample's longer side.
std::string MissedBelowStep(const PartCosts& costs, std::size_t method) {
  constexpr double kRoundingMm = 0.01;
  int contacts = 0, missed = 0;
  for (const SmallContacts& size : costs.sizes) {
    if (size.to_mm > costs.three.front().coarsest_step_mm + kRoundingMm) continue;
    contacts += size.contacts;
    missed += size.missed[method];
  }
  return fmt::format("{} of {}", missed, contacts);
}

reporting::Table MethodTable(const std::vector<PartCosts>& parts) {
  reporting::Table table{{"part, sampling", "method", "frame, ms", "contacts alone, ms", "response alone, ms",
                          "paper's rig: frame, ms", "contacts alone, ms", "missed below a sample's size"},
                         {}};
  for (const PartCosts& costs : parts) {
    for (std::size_t i = 0; i < costs.three.size(); ++i) {
      const bool is_exact = kCollisionMethods[i] == CollisionMethod::kExact ||
                            kCollisionMethods[i] == CollisionMethod::kExactAtTwoMm;
      const CollisionCost &three = costs.three[i], &paper = costs.paper[i];
      table.rows.push_back({NameOf(costs.part), NameOf(kCollisionMethods[i]),
                            ThreeDigits(three.frame.median_ms), ThreeDigits(three.contacts.median_ms),
                            is_exact ? "with them" : ThreeDigits(three.response.median_ms),
                            ThreeDigits(paper.frame.median_ms), ThreeDigits(paper.contacts.median_ms),
                            MissedBelowStep(costs, i)});
    }
  }
  return table;
}

reporting::Table WorkTable(const CollisionCost& measured) {
  const recon::ViewportWork& work = measured.work;
  return {{"work of a frame", "by the paper's formula", "its curtain, 6 a second", "here"},
          {{"triangles transformed", "n m = 2160", "13,000 / s = 2167", std::to_string(work.triangles)},
           {"pixels filled", "n m u v / 2 = 108000", "648,000 / s = 108000", std::to_string(work.pixels)},
           {"pixels read back", "x y = 160000", "160000", std::to_string(work.read_back_pixels)},
           {"frames a second", "-", "6", fmt::format("{:.0f}", 1000.0 / measured.frame.median_ms)}}};
}

reporting::Table MissedTable(const std::vector<PartCosts>& parts) {
  reporting::Table table{{"part, sampling", "contact, across", "contacts"}, {}};
  for (const CollisionMethod method : kCollisionMethods) table.header.push_back("missed: " + NameOf(method));
  for (const PartCosts& costs : parts) {
    for (const SmallContacts& size : costs.sizes) {
      std::vector<std::string> row = {NameOf(costs.part), RangeOf(size.from_mm, size.to_mm),
                                      std::to_string(size.contacts)};
      for (const int missed : size.missed) row.push_back(std::to_string(missed));
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

reporting::Table ResponseTable(const std::vector<ResponseErrors>& all) {
  reporting::Table table{
      {"depth along V_rec", "responses", "two triangles: CP_hull to the masks' hull, mm",
       "to the analytic hull, mm", "N_hull, degrees", "without N_hull",
       "exact: CP_hull to the masks' hull, mm", "to the analytic hull, mm", "N_hull, degrees"},
      {}};
  for (const ResponseErrors& errors : all) {
    table.rows.push_back(
        {RangeOf(errors.from_mm, errors.to_mm), std::to_string(errors.responses),
         Both(errors.two_triangles.cp_hull_to_masks_mm), Both(errors.two_triangles.cp_hull_to_analytic_mm),
         Both(errors.two_triangles.n_hull_deg), std::to_string(errors.two_triangles.without_normal),
         Both(errors.exact.cp_hull_to_masks_mm), Both(errors.exact.cp_hull_to_analytic_mm),
         Both(errors.exact.n_hull_deg)});
  }
  return table;
}

}  // namespace

void MeasureCollisions(const std::filesystem::path& docs) {
  std::vector<PartCosts> parts;
  for (const CollisionPart part : kCollisionParts) {
    fmt::print(stderr, "collision: {}\n", NameOf(part));
    parts.push_back({part, TimeCollisions(recon::ViewSceneRig::kThree, part, kEffort),
                     TimeCollisions(recon::ViewSceneRig::kPaper, part, kEffort),
                     CountMissed(recon::ViewSceneRig::kThree, part, kTrials, kSeed)});
  }
  fmt::print(stderr, "collision: responses\n");
  const std::vector<ResponseErrors> errors =
      MeasureResponses(recon::ViewSceneRig::kThree, kSolids, kRays, kSeed);
  const std::filesystem::path file = docs / "paper_collision.md";
  const std::string machine = fmt::format("\n{}", reporting::ToLine(reporting::ThisMachine(docs / "..")));
  reporting::WriteSection(file, "collision", reporting::ToMarkdown(MethodTable(parts)) + machine);
  reporting::WriteSection(file, "collision_work",
                          reporting::ToMarkdown(WorkTable(parts.front().paper.front())) + machine);
  reporting::WriteSection(file, "collision_missed", reporting::ToMarkdown(MissedTable(parts)) + machine);
  reporting::WriteSection(file, "collision_response", reporting::ToMarkdown(ResponseTable(errors)) + machine);
}

}  // namespace elbowroom::accuracy
