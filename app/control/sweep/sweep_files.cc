#include "app/control/sweep/sweep_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "app/control/sweep/spacing_sweep_picture.h"
#include "recon/images/png_file.h"
#include "sessions/report/whole_files.h"
#include "sessions/tables/csv_text.h"

namespace elbowroom::control {
namespace {

// `begin`: what each line begins with.
void AppendLines(const SpacingSweep& sweep, const review::SpacingCurve& curve, const std::string& begin,
                 std::string* csv) {
  const auto length = [](double length_mm) {
    return std::isfinite(length_mm) ? fmt::format("{}", length_mm) : std::string();
  };
  for (const review::StudyStep& step : curve.steps) {
    for (core::PartIndex i = 0; i < step.parts.size(); ++i) {
      const review::PartAtSpacing& part = step.parts[i];
      const bool moves = std::ranges::find(sweep.moved, i) != sweep.moved.end();
      *csv += fmt::format("{}{},{},{},{},{},{},{},{},{},{},{}\n", begin, step.spacing_mm,
                          sessions::Quoted(sweep.parts[i]), moves ? 1 : 0, part.frames_in_contact,
                          part.frames_near, part.frames_undecided, part.frames_clear, part.deepest_mm,
                          length(part.lower_mm), length(part.upper_mm),
                          part.closest_frame ? std::to_string(*part.closest_frame) : "");
    }
  }
}

std::string SweepCsv(const SpacingSweep& sweep) {
  const bool is_one = sweep.sessions.size() == 1;
  std::string csv = is_one ? "" : "session,";
  csv +=
      "spacing_mm,part,moves,frames_in_contact,frames_near,frames_undecided,frames_clear,deepest_mm,lower_mm,"
      "upper_mm,closest_frame\n";
  for (const SweptSession& session : sweep.sessions)
    AppendLines(sweep, session.curves.all, is_one ? "" : sessions::Quoted(session.path.string()) + ",", &csv);
  return csv;
}

}  // namespace

std::optional<double> SmallestWithClearanceMm(const SpacingSweep& sweep, const review::SpacingCurve& curve) {
  const bool all_require = std::ranges::all_of(
      sweep.sessions, [](const SweptSession& session) { return session.required_clearance_mm > 0.0; });
  return all_require ? review::SmallestClearMm(curve, sweep.moved) : std::nullopt;
}

std::optional<double> SmallestWithClearanceMm(const SpacingSweep& sweep, const SweptSession& session,
                                              const review::SpacingCurve& curve) {
  return session.required_clearance_mm > 0.0 ? review::SmallestClearMm(curve, sweep.moved) : std::nullopt;
}

std::vector<std::filesystem::path> WriteSpacingSweep(const SpacingRange& range, const SpacingSweep& sweep,
                                                     const std::filesystem::path& folder) {
  const LineDrawing picture = SpacingSweepPicture(sweep, range.spacing);
  const std::vector<std::uint8_t> png = recon::EncodePng(ImageOf(picture));
  sessions::WriteWholeFiles(folder, {{"sweep.csv", SweepCsv(sweep)},
                                     {"sweep.svg", SvgOf(picture)},
                                     {"sweep.png", std::string(png.begin(), png.end())}});
  return {folder / "sweep.csv", folder / "sweep.svg", folder / "sweep.png"};
}

}  // namespace elbowroom::control
