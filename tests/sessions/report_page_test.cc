// report.html in a browser: no request, no word on the console, a 3-D view that draws, filters and selection
// that work, and texts of others that are texts.
#include <gtest/gtest.h>

#include <filesystem>

#include "sessions/report/report.h"
#include "sessions/session_writer.h"
#include "tests/sessions/sample_session.h"
#include "tests/sessions/sample_trial.h"
#include "tests/support/documents/page_in_browser.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using test_support::TemporaryFolder;

// Names can't have the marks of right-to-left text, notes can.
const std::string kHostileName =
    "<script>alert('x')</script>\"'&<img src=x onerror=alert(1)>=cmd|\u05D0 @told";
const std::string kHostile =
    "<script>alert('x')</script>\"'&<img src=x onerror=alert(1)>=cmd|\u202E\u05D0 @told" +
    std::string(10000, 'x');

// Parts, one hull that is a tetrahedron, and two contact points, in the session's frame.
sessions::ReportPictures PicturesOf(const core::SessionHeader& header, core::FrameIndex frame) {
  sessions::ReportModel::Moment moment;
  moment.frame = frame;
  moment.world_from_parts.resize(header.layout.parts.size());
  moment.hull.vertices_mm = {{0, 0, 0}, {200, 0, 0}, {0, 200, 0}, {0, 0, 200}};
  moment.hull.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  moment.contacts_in_world_mm = {{10, 10, 10}, {20, 10, 10}};
  sessions::ReportPictures pictures;
  pictures.model.moments = {moment};
  pictures.model.keep_out = moment.hull;
  return pictures;
}

TEST(ReportPage, WorksInABrowser) {
  if (!HasBrowser()) GTEST_SKIP() << "NOT TESTED: no /usr/bin/chromium";
  const TemporaryFolder folder;
  WriteTrial(folder / "s.db", UsualTrial());
  const sessions::SessionReader session(folder / "s.db");
  sessions::WriteReport(
      session, [&] { return PicturesOf(session.header(), session.episodes().front().peak_frame); },
      folder / "out");
  ExpectPageWorks(folder / "out" / "report.html", folder / "shots");
}

TEST(ReportPage, RunsNoTextOfOthers) {
  if (!HasBrowser()) GTEST_SKIP() << "NOT TESTED: no /usr/bin/chromium";
  const TemporaryFolder folder;
  core::SessionHeader header = SampleHeader();
  header.trial.participant = header.trial.task = kHostile;
  header.rig.name = kHostileName;
  header.layout.parts[1].name = header.layout.spacings[0].moving = header.layout.groups[0].parts[1] =
      kHostileName;
  header.layout.groups[1].name = kHostileName + "2";
  header.layout.pair_rules[0].a = header.layout.pair_rules[2].a = kHostileName;
  header.layout.spacings[0].name = kHostileName;
  header.settings[kHostileName] = header.versions[kHostileName] = kHostileName;
  {
    sessions::SessionWriter writer(folder / "s.db", header);
    for (core::FrameIndex i = 0; i < 20; ++i) writer.Append(SampleFrame(header, i, 1));
    writer.Append(core::SessionEvent{1, 0.1, core::Note{kHostile}});
    writer.Append(core::SessionEvent{1, 0.1, core::ToolMarked{kHostileName, true}});
    writer.Finish({SampleEpisodes(0, 19), {}, {}});
  }
  sessions::WriteReport(
      sessions::SessionReader(folder / "s.db"), [&] { return PicturesOf(header, 3); }, folder / "out");
  ExpectPageWorks(folder / "out" / "report.html", folder / "shots");
}

}  // namespace
}  // namespace elbowroom::tests
