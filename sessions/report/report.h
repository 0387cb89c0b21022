// The report of a trial: one page that explains itself, and a table for other programs.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/contact.h"
#include "sessions/bcf/bcf_topic.h"
#include "sessions/report/pair_approaches.h"
#include "sessions/report/report_model.h"
#include "sessions/session_reader.h"

namespace elbowroom::sessions {

// Rendered by the caller: this room knows no graphics.
struct ReportPictures {
  std::vector<unsigned char> worst_moment_png;  // empty: the report has no such picture
  std::string caption;                          // of the worst moment
  std::optional<std::vector<unsigned char>> overview_png;
  struct Heat {
    core::PartIndex part = 0;
    std::vector<unsigned char> png;
  };
  std::vector<Heat> heat = {};  // where each touched part was touched
  struct Touch {
    std::size_t place = 0;  // in TouchesOf(session).touches
    std::vector<unsigned char> png;
    TopicCamera camera = {};           // that sees what the picture shows
    std::optional<TopicCut> cut = {};  // where a part hides the place from it
  };
  std::vector<Touch> touches = {};  // snapshots, of some of them
  ReportModel model = {};           // what the 3-D view shows
  PairApproaches pairs = {};        // virtual parts against each other
};

// The touch to draw: the deepest, ties go to the larger area, then to the earlier. Nothing if nothing
// touched.
[[nodiscard]] std::optional<core::ContactEpisode> WorstEpisode(
    std::span<const core::ContactEpisode> episodes);

// Draws the pictures. Called once, in the caller's thread. May read the session.
using PictureSource = std::function<ReportPictures()>;

// Writes `out_dir`/report.html (nothing loaded from elsewhere; fit for print; it says the same without its
// script), report.pdf (the same document on A4, without the 3-D view), contacts.csv (a row for each part in
// contact in each frame), clearance.csv (a row for each part whose clearance was asked), touches.bcfzip (the
// touches for CAD teams) and, where the cameras have stamps, stamps.csv (a row for each camera in each
// frame); all or none. Makes the folder; replaces an older report. Charts are drawn in other threads while
// `draw` runs; an empty `draw`: no pictures. Throws: Error{kFile} naming what can't be written; what
// SessionReader and `draw` throw; PreconditionError for bytes that are no PNG.
void WriteReport(const SessionReader& session, const PictureSource& draw,
                 const std::filesystem::path& out_dir);

// The report's touches.bcfzip alone, as `file`: whole or not at all. Throws: Error{kFile}; what SessionReader
// throws.
void WriteTopics(const SessionReader& session, const ReportPictures& pictures,
                 const std::filesystem::path& file);

}  // namespace elbowroom::sessions
