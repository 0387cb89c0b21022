// The report of a recorded session, with pictures drawn from what was recorded.
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <vector>

#include "app/control/frame_result.h"
#include "core/progress.h"

namespace elbowroom::control {

struct ReportFiles {
  std::vector<std::filesystem::path> written;
};

struct ReportOptions {
  // Of the cells of the keep-out volume in the 3-D view (FindKeepOut), mm; nothing: the view has none. It
  // takes a second and more.
  std::optional<double> keep_out_edge_mm;
};

// report.html, report.pdf, contacts.csv, clearance.csv and touches.bcfzip in `folder` (made if it isn't
// there), with a picture of the deepest contact and one of the whole scene. Throws: core::Error{kFile,
// kDatabase, kGraphics, kCancelled}; what FindKeepOut throws.
ReportFiles WriteSessionReport(const std::filesystem::path& session, const std::filesystem::path& folder,
                               const core::Progress& progress, std::stop_token stop,
                               const ReportOptions& options = {});

// The folder SESSION-report beside the session: where the console writes.
[[nodiscard]] std::filesystem::path ReportFolderFor(const std::filesystem::path& session);

// The report's touches.bcfzip alone, whole or not at all: touches and near misses as topics with snapshots
// and reviews, for CAD teams. Throws: as WriteSessionReport.
void WriteSessionTopics(const std::filesystem::path& session, const std::filesystem::path& bcf_file,
                        const core::Progress& progress, const std::stop_token& stop);

// The operator's view of one recorded frame as a PNG, whole or not at all; for the demo's view.png.
void WriteFramePicture(const FrameResult& result, const std::filesystem::path& png, int width_px,
                       int height_px);

}  // namespace elbowroom::control
