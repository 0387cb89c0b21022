#include "app/control/report/session_report.h"

#include <fmt/format.h>

#include <optional>

#include "app/control/heat_picture.h"
#include "app/control/keep_out/keep_out_job.h"
#include "app/control/outcome_tracker.h"
#include "app/control/recorded_frame.h"
#include "app/control/report/pair_approaches.h"
#include "app/control/report/touch_moments.h"
#include "app/control/scene_composer.h"
#include "core/error.h"
#include "core/progress.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/images/png_file.h"
#include "sessions/report/report.h"

namespace elbowroom::control {
namespace {

constexpr int kPictureWidthPx = 1200;
constexpr int kPictureHeightPx = 800;

recon::Image Draw(recon::gl::SceneRenderer& renderer, SceneComposer& composer, const FrameResult& result,
                  const recon::OrbitCamera& camera) {
  return renderer.Render(
      composer.Compose(result, recon::ViewFrom(camera, kPictureWidthPx, kPictureHeightPx)));
}

// The deepest touch; where no contact was long or deep enough for one, the deepest contact recorded.
struct WorstMoment {
  core::FrameIndex frame = 0;
  core::PartIndex part = 0;
};
std::optional<WorstMoment> WorstMomentOf(const sessions::SessionReader& session) {
  const std::vector<core::ContactEpisode> episodes = session.episodes();
  if (const auto episode = sessions::WorstEpisode(episodes))
    return WorstMoment{episode->peak_frame, episode->part};
  std::optional<WorstMoment> worst;
  double deepest_mm = -1.0;
  session.VisitRows(
      [&](const sessions::ContactRow& row) {
        const double depth_mm = row.contact.deepest ? row.contact.deepest->depth_mm : 0.0;
        if (depth_mm <= deepest_mm) return;
        deepest_mm = depth_mm;
        worst = WorstMoment{row.frame, row.contact.part};
      },
      {});
  return worst;
}

std::string CaptionOf(const FrameResult& result, core::PartIndex part, const std::string& driver) {
  const core::PartContact& contact = result.record.contacts[part];
  return fmt::format(
      "Frame {} ({:.2f} s): the hull of the real objects reaches at least {:.1f} mm into '{}', over {:.0f} "
      "mm\u00b2. "
      "Red points: contact. Drawn with {}.",
      result.record.frame, result.record.time_s, contact.deepest ? contact.deepest->depth_mm : 0.0,
      result.layout->parts[part].name, contact.contact_area_mm2, driver);
}

void AddHeat(const sessions::SessionReader& session, recon::gl::SceneRenderer& renderer,
             sessions::ReportPictures* pictures) {
  for (const core::HeatMap& map : session.heat_maps()) {
    const core::SharedMesh& mesh = session.header().layout.parts[map.part].mesh;
    pictures->heat.push_back({map.part, recon::EncodePng(HeatPicture(renderer, mesh, map))});
  }
}

// Everything that is rendered or asked of the geometry again.
sessions::ReportPictures DrawPictures(const sessions::SessionReader& session,
                                      const std::vector<sessions::FrameSummary>& frames,
                                      const core::Progress& progress, const std::stop_token& stop,
                                      const ReportOptions& options) {
  sessions::ReportPictures pictures;
  if (!frames.empty()) {
    recon::gl::SceneRenderer renderer;
    SceneComposer composer;
    const std::optional<WorstMoment> worst = WorstMomentOf(session);
    const SharedFrameResult shown = RebuildFrame(session, worst ? worst->frame : frames.back().frame);
    progress.Report(1, 4, "picture of the whole scene");
    pictures.overview_png = recon::EncodePng(
        Draw(renderer, composer, *shown, OverviewCamera(*shown, kPictureWidthPx, kPictureHeightPx)));
    core::ThrowIfStopped(stop, "the report");
    if (worst) {
      progress.Report(2, 4, "picture of the worst moment");
      const recon::OrbitCamera camera = ContactCamera(*shown, worst->part, kPictureWidthPx, kPictureHeightPx);
      pictures.worst_moment_png = recon::EncodePng(Draw(renderer, composer, *shown, camera));
      pictures.caption = CaptionOf(*shown, worst->part, renderer.driver());
    }
    AddTouchMoments(session, *shown, renderer, composer, stop, &pictures);
    AddHeat(session, renderer, &pictures);
  }
  if (options.keep_out_edge_mm && !pictures.model.moments.empty())
    pictures.model.keep_out =
        FindKeepOut({{session.path()}, *options.keep_out_edge_mm, {}, {}}, progress, stop).swept.mesh;
  pictures.pairs = PairApproachesOf(session.header().layout, frames, stop);
  core::ThrowIfStopped(stop, "the report");
  progress.Report(3, 4, "writing the report");
  return pictures;
}

}  // namespace

ReportFiles WriteSessionReport(const std::filesystem::path& session_path, const std::filesystem::path& folder,
                               const core::Progress& progress, std::stop_token stop,
                               const ReportOptions& options) {
  const sessions::SessionReader session = OpenWithOutcome(session_path, progress, stop);
  const std::vector<sessions::FrameSummary> frames = session.frames();
  progress.Report(0, 4, "reading the session");
  sessions::WriteReport(
      session, [&] { return DrawPictures(session, frames, progress, stop, options); }, folder);
  return {{folder / "report.html", folder / "report.pdf", folder / "contacts.csv", folder / "clearance.csv",
           folder / "touches.bcfzip"}};
}

std::filesystem::path ReportFolderFor(const std::filesystem::path& session) {
  return session.parent_path() / (session.stem().string() + "-report");
}

void WriteSessionTopics(const std::filesystem::path& session_path, const std::filesystem::path& bcf_file,
                        const core::Progress& progress, const std::stop_token& stop) {
  const sessions::SessionReader session = OpenWithOutcome(session_path, progress, stop);
  const std::vector<sessions::FrameSummary> frames = session.frames();
  sessions::ReportPictures pictures;
  if (!frames.empty()) {
    progress.Report(0, 0, "pictures of the touches");
    recon::gl::SceneRenderer renderer;
    SceneComposer composer;
    const SharedFrameResult shown = RebuildFrame(session, frames.back().frame);
    AddTouchMoments(session, *shown, renderer, composer, stop, &pictures);
  }
  core::ThrowIfStopped(stop, "writing the touches");
  sessions::WriteTopics(session, pictures, bcf_file);
}

void WriteFramePicture(const FrameResult& result, const std::filesystem::path& png, int width_px,
                       int height_px) {
  recon::gl::SceneRenderer renderer;
  const recon::SceneView view =
      recon::ViewFrom(OverviewCamera(result, width_px, height_px), width_px, height_px);
  recon::WritePng(renderer.Render(SceneComposer().Compose(result, view)), png);
}

}  // namespace elbowroom::control
