#include "app/control/sweep/spacing_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string_view>
#include <utility>

#include "app/control/sweep/spacing_sweep_picture.h"
#include "app/control/trial_rules.h"
#include "core/error.h"
#include "core/spelling.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/error_budget/motion_history.h"
#include "recon/hull/visual_hull.h"
#include "recon/images/png_file.h"
#include "sessions/report/csv_text.h"
#include "sessions/report/whole_files.h"

namespace elbowroom::control {
namespace {

core::SpacingIndex FindSpacing(const core::Layout& layout, const std::string& name) {
  if (const auto index = layout.FindSpacing(name)) return *index;
  std::vector<std::string_view> known;
  for (const core::Spacing& spacing : layout.spacings) known.emplace_back(spacing.name);
  const auto nearest = core::NearestWord(name, known);
  throw core::Error(
      core::ErrorKind::kRange,
      fmt::format("--spacing: no spacing of the session is named '{}'; {}", name,
                  nearest ? fmt::format("did you mean '{}'?", *nearest) : "use the name of a [[spacing]]"));
}

std::string SweepCsv(const core::Layout& layout, const review::SpacingStudy& study) {
  std::string csv =
      "spacing_mm,part,moves,frames_in_contact,frames_near,frames_undecided,frames_clear,deepest_mm,lower_mm,"
      "upper_mm,closest_frame\n";
  const auto length = [](double length_mm) {
    return std::isfinite(length_mm) ? fmt::format("{}", length_mm) : std::string();
  };
  for (const review::StudyStep& step : study.steps) {
    for (core::PartIndex i = 0; i < step.parts.size(); ++i) {
      const review::PartAtSpacing& part = step.parts[i];
      const bool moves = std::ranges::find(study.moved, i) != study.moved.end();
      csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", step.spacing_mm,
                         sessions::Quoted(layout.parts[i].name), moves ? 1 : 0, part.frames_in_contact,
                         part.frames_near, part.frames_undecided, part.frames_clear, part.deepest_mm,
                         length(part.lower_mm), length(part.upper_mm),
                         part.closest_frame ? std::to_string(*part.closest_frame) : "");
    }
  }
  return csv;
}

// Those with a picture of each camera. Without one the hull is too large, so that a touch of it shows
// nothing.
std::vector<sessions::FrameSummary> CompleteFrames(const sessions::SessionReader& session) {
  std::vector<sessions::FrameSummary> frames = session.frames();
  std::set<core::FrameIndex> incomplete;
  for (const sessions::StampRow& frame : session.stamp_rows())
    if (std::ranges::any_of(frame.stamps, [](const auto& stamp) { return !stamp; }))
      incomplete.insert(frame.frame);
  std::erase_if(frames,
                [&](const sessions::FrameSummary& frame) { return incomplete.contains(frame.frame); });
  return frames;
}

// Recorded frames with their hulls, and how fast these moved.
class StudyFrameLoader {
 public:
  StudyFrameLoader(const sessions::SessionReader& session, const std::vector<sessions::FrameSummary>& frames)
      : session_(session), frames_(frames), rig_(std::make_shared<const core::Rig>(session.header().rig)) {
    // Reading a frame checks that its silhouettes have the sizes of the cameras' pictures, before planes of
    // these sizes are made.
    (void)session.ReadFrame(frames.front().frame);
    // Skew counts where a clearance is required.
    has_stamps_ = session.header().trial.required_clearance_mm > 0.0 && !session.stamp_rows().empty();
    planes_ = recon::MakeUndistortedPlanes(*rig_);
  }

  // Frames with stamps need the two before them; where the last one loaded was the one before, that is known.
  [[nodiscard]] review::StudyFrame Load(std::size_t i) {
    if (i != next_) {
      motions_ = {};
      last_ = nullptr;
      if (has_stamps_)
        for (std::size_t before = i - std::min<std::size_t>(i, 2); before < i; ++before) (void)Follow(before);
    }
    next_ = i + 1;
    return Follow(i);
  }

 private:
  review::StudyFrame Follow(std::size_t i) {
    const core::FrameRecord record = session_.ReadFrame(frames_[i].frame);
    const auto hull = recon::NextHull(last_, rig_, planes_, *record.masks).hull;
    review::StudyFrame frame{record.frame, hull, record.spacing_mm};
    if (!has_stamps_) return frame;
    last_ = hull;
    frame.skew_errors = motions_.Next(*hull, record.stamps, record.time_s);
    return frame;
  }

  const sessions::SessionReader& session_;
  const std::vector<sessions::FrameSummary>& frames_;
  std::shared_ptr<const core::Rig> rig_;
  recon::UndistortedPlanes planes_;
  recon::MotionHistory motions_;
  std::shared_ptr<const recon::VisualHull> last_;  // of a session with stamps: its silhouettes that stay
  std::size_t next_ = 0;
  bool has_stamps_ = false;
};

}  // namespace

review::SpacingStudy SweepSpacing(const sessions::SessionReader& session, const SpacingRange& range,
                                  const core::Progress& progress, std::stop_token stop) {
  const core::SessionHeader& header = session.header();
  review::SpacingStudyOptions options;
  options.spacing = FindSpacing(header.layout, range.spacing);
  options.from_mm = range.from_mm;
  options.to_mm = range.to_mm;
  options.step_mm = range.step_mm;
  options.review = ReviewOptionsOf(header.trial, header.rig, header.rig_quality);
  const std::vector<sessions::FrameSummary> frames = CompleteFrames(session);
  if (frames.empty()) {
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("session '{}' has no frames with all cameras; record a trial first",
                                  session.path().string()));
  }
  StudyFrameLoader loader(session, frames);
  const auto load = [&](std::size_t i) { return loader.Load(i); };
  return review::StudySpacing(header.layout, {frames.size(), load}, options, progress, stop);
}

std::vector<std::filesystem::path> WriteSpacingSweep(const core::SessionHeader& header,
                                                     const SpacingRange& range,
                                                     const review::SpacingStudy& study,
                                                     const std::filesystem::path& folder) {
  const LineDrawing picture = SpacingSweepPicture(header, range.spacing, study);
  const std::vector<std::uint8_t> png = recon::EncodePng(ImageOf(picture));
  sessions::WriteWholeFiles(folder, {{"sweep.csv", SweepCsv(header.layout, study)},
                                     {"sweep.svg", SvgOf(picture)},
                                     {"sweep.png", std::string(png.begin(), png.end())}});
  return {folder / "sweep.csv", folder / "sweep.svg", folder / "sweep.png"};
}

}  // namespace elbowroom::control
