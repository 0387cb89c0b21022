// docs/paper_collision.md, all its tables.
#include <fmt/format.h>

#include "tests/accuracy/collision_comparison.h"
#include "tests/accuracy/measurements.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

using reporting::ThreeDigits;

constexpr int kCurtains = 600, kSolids = 24, kRays = 160;
constexpr std::uint64_t kSeed = 7601;
constexpr TimingEffort kEffort{.repetitions = 101};  // of some milliseconds each
constexpr double kPaperStepMm = 2.0;

std::string Both(const ErrorShare& share) {
  return ThreeDigits(share.median) + " / " + ThreeDigits(share.p95);
}

std::string RangeOf(double from_mm, double to_mm) {
  return to_mm > 1e6 ? fmt::format("{} mm and more", from_mm) : fmt::format("{} to {} mm", from_mm, to_mm);
}

// "missed of contacts", those smaller than the paper's sampling.
std::string MissedBelowStep(const std::vector<SmallContacts>& sizes, std::size_t method) {
  int contacts = 0, missed = 0;
  for (const SmallContacts& size : sizes) {
    if (size.to_mm > kPaperStepMm) continue;
    contacts += size.contacts;
    missed += size.missed[method];
  }
  return fmt::format("{} of {}", missed, contacts);
}

reporting::Table MethodTable(const std::vector<CollisionCost>& three, const std::vector<CollisionCost>& paper,
                             const std::vector<SmallContacts>& sizes, const ResponseErrors& errors) {
  reporting::Table table{{"method", "frame, ms", "contacts alone, ms", "response alone, ms",
                          "paper's rig: frame, ms", "contacts alone, ms", "missed below 2 mm",
                          "CP_hull to the masks' hull, mm", "to the analytic hull, mm", "N_hull, degrees"},
                         {}};
  for (std::size_t i = 0; i < three.size(); ++i) {
    const bool is_exact = kCollisionMethods[i] == CollisionMethod::kExact ||
                          kCollisionMethods[i] == CollisionMethod::kExactAtTwoMm;
    const ResponseErrors::OfMethod& error = is_exact ? errors.exact : errors.two_triangles;
    table.rows.push_back({NameOf(kCollisionMethods[i]), ThreeDigits(three[i].frame.median_ms),
                          ThreeDigits(three[i].contacts.median_ms),
                          is_exact ? "with them" : ThreeDigits(three[i].response.median_ms),
                          ThreeDigits(paper[i].frame.median_ms), ThreeDigits(paper[i].contacts.median_ms),
                          MissedBelowStep(sizes, i), Both(error.cp_hull_to_masks_mm),
                          Both(error.cp_hull_to_analytic_mm), Both(error.n_hull_deg)});
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

reporting::Table MissedTable(const std::vector<SmallContacts>& sizes) {
  reporting::Table table{{"contact, across", "contacts"}, {}};
  for (const CollisionMethod method : kCollisionMethods) table.header.push_back("missed: " + NameOf(method));
  for (const SmallContacts& size : sizes) {
    std::vector<std::string> row = {RangeOf(size.from_mm, size.to_mm), std::to_string(size.contacts)};
    for (const int missed : size.missed) row.push_back(std::to_string(missed));
    table.rows.push_back(std::move(row));
  }
  return table;
}

reporting::Table ResponseTable(const std::vector<ResponseErrors>& all) {
  reporting::Table table{{"depth along V_rec", "responses", "two triangles: CP_hull, mm", "N_hull, degrees",
                          "without N_hull", "exact: CP_hull, mm", "N_hull, degrees"},
                         {}};
  for (const ResponseErrors& errors : all) {
    table.rows.push_back({RangeOf(errors.from_mm, errors.to_mm), std::to_string(errors.responses),
                          Both(errors.two_triangles.cp_hull_to_masks_mm),
                          Both(errors.two_triangles.n_hull_deg),
                          std::to_string(errors.two_triangles.without_normal),
                          Both(errors.exact.cp_hull_to_masks_mm), Both(errors.exact.n_hull_deg)});
  }
  return table;
}

}  // namespace

void MeasureCollisions(const std::filesystem::path& docs) {
  fmt::print(stderr, "collision: times\n");
  const std::vector<CollisionCost> three = TimeCollisions(recon::ViewSceneRig::kThree, kEffort);
  const std::vector<CollisionCost> paper = TimeCollisions(recon::ViewSceneRig::kPaper, kEffort);
  fmt::print(stderr, "collision: small contacts\n");
  const std::vector<SmallContacts> sizes = CountMissed(recon::ViewSceneRig::kThree, kCurtains, kSeed);
  fmt::print(stderr, "collision: responses\n");
  const std::vector<ResponseErrors> errors =
      MeasureResponses(recon::ViewSceneRig::kThree, kSolids, kRays, kSeed);
  const std::filesystem::path file = docs / "paper_collision.md";
  const std::string machine = "\n" + reporting::ToLine(reporting::ThisMachine(docs / ".."));
  reporting::WriteSection(file, "collision",
                          reporting::ToMarkdown(MethodTable(three, paper, sizes, errors.front())) + machine);
  reporting::WriteSection(file, "collision_work", reporting::ToMarkdown(WorkTable(three.front())) + machine);
  reporting::WriteSection(file, "collision_missed", reporting::ToMarkdown(MissedTable(sizes)) + machine);
  reporting::WriteSection(file, "collision_response", reporting::ToMarkdown(ResponseTable(errors)) + machine);
}

}  // namespace elbowroom::accuracy
