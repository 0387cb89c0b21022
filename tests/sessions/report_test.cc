#include "sessions/report/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "sessions/charts/chart_option.h"
#include "sessions/charts/chart_painter.h"
#include "sessions/report/markup.h"
#include "sessions/report/report_data.h"
#include "sessions/report/report_model.h"
#include "sessions/report/timeline_chart.h"
#include "sessions/session_writer.h"
#include "tests/sessions/expect_error.h"
#include "tests/sessions/sample_picture.h"
#include "tests/sessions/sample_session.h"
#include "tests/sessions/sample_trial.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using sessions::ReportPictures;
using sessions::SessionReader;
using test_support::TemporaryFolder;

const std::vector<unsigned char>& kPng = kSamplePng;

std::string ReportText(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::int64_t Count(const std::string& text, const std::string& what) {
  std::int64_t count = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++count;
  return count;
}

// The page without the program that it runs; that it loads nothing, the browser says
// (web/test/report_page.mjs).
std::string WithoutProgram(const std::string& html) {
  const std::size_t begin = html.rfind("<script>"), end = html.rfind("</script>");
  EXPECT_NE(begin, std::string::npos);
  EXPECT_EQ(Count(html, "<script"), 2) << "the data and the program";
  EXPECT_EQ(Count(html, "</script"), 2);
  return html.substr(0, begin) + html.substr(end + 9);
}

// Fails where a tag isn't closed in its place.
void ExpectTagsNest(const std::string& html) {
  const std::regex tag(R"(<(/?)([a-zA-Z][a-zA-Z0-9]*)((?:[^>'"]|'[^']*'|"[^"]*")*)>)");
  const std::string body = html.substr(0, html.find("<style>")) + html.substr(html.find("</style>") + 8);
  std::vector<std::string> open;
  for (std::sregex_iterator it(body.begin(), body.end(), tag), end; it != end; ++it) {
    const std::string name = (*it)[2], attributes = (*it)[3];
    if (name == "meta" || name == "img" || name == "br" || attributes.ends_with("/")) continue;
    if ((*it)[1].length() == 0) {
      open.push_back(name);
    } else {
      ASSERT_FALSE(open.empty()) << "stray </" << name << ">";
      ASSERT_EQ(open.back(), name) << "closed out of turn";
      open.pop_back();
    }
  }
  EXPECT_TRUE(open.empty());
}

void ExpectSelfContained(const std::string& html) {
  for (const char* loads : {"<link", "https:", "@import", "url(h", "src='//", "javascript:"}) {
    EXPECT_EQ(html.find(loads), std::string::npos) << loads;
  }
  EXPECT_EQ(Count(html, "src='"), Count(html, "src='data:image/png;base64,"));
}

void ExpectNoBrokenNumbers(const std::string& html) {
  EXPECT_FALSE(std::regex_search(html, std::regex(R"([ ='](-?nan|-?inf)\b)"))) << "a number that isn't one";
  EXPECT_FALSE(std::regex_search(html, std::regex(R"(width='-)"))) << "a rectangle of negative width";
}

std::string ReportOf(const fs::path& session, const fs::path& out_dir, const ReportPictures& pictures = {}) {
  sessions::WriteReport(
      SessionReader(session), [&] { return pictures; }, out_dir);
  std::string html = WithoutProgram(ReportText(out_dir / "report.html"));
  ExpectTagsNest(html);
  ExpectSelfContained(html);
  ExpectNoBrokenNumbers(html);
  return html;
}

TEST(Report, TellsTheUsualTrialAndNeedsNothingButItself) {
  const TemporaryFolder folder;
  WriteTrial(folder / "s.db", UsualTrial());
  const std::string html = ReportOf(folder / "s.db", folder / "new" / "out", {kPng, "Deep & <deeper>", kPng});
  EXPECT_NE(html.find("7 touches in 62.0 s, all with &#39;PMT to payload A&#39; at 140&nbsp;mm"),
            std::string::npos);
  EXPECT_EQ(Count(html, "<tr data-touch='") + Count(html, "<tr class='worst' data-touch='"), 7);
  EXPECT_EQ(Count(html, "<tr class='group'>"), 2) << "a group for each touched part";
  EXPECT_EQ(Count(html, "src='" + sessions::PngAsDataUrl(kPng) + "'"), 2);
  EXPECT_NE(html.find("Deep &amp; &lt;deeper&gt;"), std::string::npos);
  EXPECT_EQ(Count(html, "<tr class='worst' data-touch="), 1);
  EXPECT_NE(html.find("contact errs on the safe side"), std::string::npos);
}

TEST(Report, TellsTheCamerasSkewAndWhichFramesLackWhichCamera) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  {
    sessions::SessionWriter writer(folder / "s.db", header);
    for (core::FrameIndex i = 0; i < 40; ++i) {
      core::FrameRecord record = SampleFrame(header, i, 1);
      const auto count = static_cast<std::uint64_t>(i);
      record.stamps = {core::CameraStamp{count, record.time_s - 2e-3},
                       core::CameraStamp{count, record.time_s + (i == 30 ? 30e-3 : 4e-3)}};
      if (i == 3 || (i >= 17 && i < 20)) record.stamps[1].reset();
      if (i >= 22 && i % 2 == 0) record.stamps[0].reset();
      writer.Append(record);
    }
    writer.Finish({});
  }
  const std::string html = ReportOf(folder / "s.db", folder / "out");
  EXPECT_NE(html.find("within 6.0 ms of each other (median; 6.0 ms in 95 % of the frames, 6.0 ms at most). "
                      "13 of 40 frames lack a camera"),
            std::string::npos);
  EXPECT_NE(
      html.find("<td>left</td><td class='n'>2.0 ms</td><td class='n'>2.0 ms</td>"
                "<td class='n'>2.0 ms</td><td>22, 24, 26, 28, 30, 32, 34, 36 and 1 more stretches</td>"),
      std::string::npos);
  EXPECT_NE(html.find("<td>above</td><td class='n'>4.0 ms</td><td class='n'>4.0 ms</td>"
                      "<td class='n'>30.0 ms</td><td>3, 17\u201319</td>"),
            std::string::npos);
  const std::string csv = ReportText(folder / "out" / "stamps.csv");
  EXPECT_EQ(Count(csv, "\n"), 1 + 2 * 40);
  EXPECT_NE(csv.find("\n3,0.1,above,,,\n"), std::string::npos);
  EXPECT_EQ(Count(csv, ",,,\n"), 13);
}

TEST(Report, SaysNothingOfSkewWhereNoCameraHasStamps) {
  const TemporaryFolder folder;
  WriteTrial(folder / "s.db", UsualTrial());
  fs::create_directories(folder / "out");
  test_support::WriteText(folder / "out" / "stamps.csv", "of an earlier report");
  const std::string html = ReportOf(folder / "s.db", folder / "out");
  EXPECT_EQ(html.find("Missing in frames"), std::string::npos);
  EXPECT_EQ(html.find("stamps.csv"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "out" / "stamps.csv"));
}

TEST(Report, ListsNearMissesClearancesAndHeat) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 6);
  const std::string html = ReportOf(folder / "s.db", folder / "out", {{}, "", std::nullopt, {{0, kPng}}});
  EXPECT_NE(html.find("<h2>Every touch and near miss</h2>"), std::string::npos);
  EXPECT_NE(html.find("6.7 mm to 7.3 mm"), std::string::npos);
  EXPECT_NE(html.find("<h2>Where parts were touched</h2>"), std::string::npos);
  EXPECT_NE(html.find("PMT box: how long and how deep"), std::string::npos);
  EXPECT_NE(html.find("<bdi>O&#39;Hara&#39;s &quot;driver&quot;</bdi>, <bdi>tongs</bdi>"), std::string::npos);
  EXPECT_EQ(Count(html, "payload A hangs as cloth: judged in its shape at rest"), 1);
  EXPECT_EQ(Count(html, "payload B moves out of the way: judged where each frame found it"), 1);
  const std::string csv = ReportText(folder / "out" / "clearance.csv");
  EXPECT_EQ(Count(csv, "\n"), 1 + 12) << "two of the parts in each of six frames";
  EXPECT_EQ(Count(csv, ",contact,may be the hull's alone,20.1,"), 6);
  EXPECT_EQ(Count(csv, ",near,may be farther,"), 2);
  EXPECT_EQ(Count(csv, ",undecided,bounds don't tell,"), 2);
  EXPECT_EQ(Count(csv, ",clear,sure,"), 2);
  std::istringstream lines(csv);
  std::string head, line;
  std::getline(lines, head);
  while (std::getline(lines, line)) EXPECT_EQ(Count(line, ","), Count(head, ",")) << line;
  EXPECT_THROW(ReportOf(folder / "s.db", folder / "no", {{}, "", std::nullopt, {{0, {1, 2}}}}),
               core::PreconditionError);
}

TEST(Report, DrawsEachTouchWhereItsTimesAre) {
  const TemporaryFolder folder;
  TrialPlan plan = UsualTrial();
  plan.duration_s = 40.0;
  plan.touches = {{1, 10.0, 20.0, 6.0}};
  WriteTrial(folder / "s.db", plan);
  const sessions::Chart chart =
      sessions::TimelineChart(sessions::CollectReportData(SessionReader(folder / "s.db")));
  EXPECT_EQ(chart.x_from, 0.0);
  EXPECT_NEAR(chart.x_to, 40.0, 1e-9);
  const std::vector<sessions::ChartBar>& bars = chart.panels[0].bars;
  const auto frame = std::ranges::find_if(bars, &sessions::ChartBar::is_frame);
  ASSERT_NE(frame, bars.end());
  EXPECT_NEAR(frame->from, 10.0, 1e-9);
  EXPECT_NEAR(frame->to, 20.1, 1e-9) << "to the end of the last frame";
  EXPECT_EQ(frame->touch, 0U);
  EXPECT_EQ(chart.panels[0].lanes[frame->lane], "payload A");
  const auto contact = std::ranges::find_if_not(
      bars, [](const sessions::ChartBar& bar) { return bar.is_frame || bar.color.empty(); });
  ASSERT_NE(contact, bars.end());
  EXPECT_NEAR(contact->from, 10.0, 1e-6);
}

// What a chart's data says, the picture shows there: a bar from 1 to 3 of 0 to 4 covers its plot's middle.
TEST(Charts, ABarLiesWhereItsValuesAre) {
  sessions::Chart chart{.title = "t", .x_name = "time, s", .x_from = 0.0, .x_to = 4.0, .panels = {}};
  sessions::ChartPanel panel;
  panel.lanes = {"lane"};
  panel.bars = {{.from = 1.0, .to = 3.0, .lane = 0, .color = "#123456", .height = 0.5}};
  chart.panels = {panel};
  const std::string svg = sessions::ChartPainter().Svg(chart);
  std::smatch found;
  ASSERT_TRUE(std::regex_search(svg, found,
                                std::regex(R"RE(d="M([0-9.]+) [0-9.]+l([0-9.]+) 0[^"]*" fill="#123456")RE")))
      << svg;
  constexpr double kLeft = 168.0, kWidth = 1040.0 - 168.0 - 22.0;  // of the plot
  EXPECT_NEAR(std::stod(found[1]), kLeft + kWidth / 4.0, 1.0);
  EXPECT_NEAR(std::stod(found[2]), kWidth / 2.0, 1.0);
  EXPECT_NE(svg.find(">lane</text>"), std::string::npos) << "names are text";
}

TEST(Charts, NoTextOfOthersIsMarkup) {
  const std::string hostile =
      "</script><script>alert('x')</script>@told \xFF \u202E\U0001F600" + std::string(10000, 'x');
  sessions::Chart chart{.title = hostile, .x_name = hostile, .x_from = 0.0, .x_to = 4.0, .panels = {}};
  sessions::ChartPanel panel;
  panel.title = hostile;
  panel.lanes = {hostile, "@bar"};
  panel.bars = {{.from = 1.0,
                 .to = 3.0,
                 .lane = 0,
                 .color = "#123456",
                 .height = 0.5,
                 .is_frame = true,
                 .told = hostile}};
  chart.panels = {panel};
  const std::string svg = sessions::ChartPainter().Svg(chart);
  EXPECT_EQ(svg.find("<script"), std::string::npos);
  EXPECT_NE(svg.find("@bar"), std::string::npos) << "a lane may be called so";
  EXPECT_EQ(sessions::OptionJson(chart).find('<'), std::string::npos);
}

// The third corner is 4.5 mm from the low side: 2898.4 steps, so 0x0b52.
TEST(ReportModel, AMeshIsToldToHalfAStep) {
  core::TriangleMesh mesh;
  mesh.vertices_mm = {{-1.5, 2.0, 0.0}, {100.25, 2.0, 0.0}, {3.0, 40.0, 0.0}};
  mesh.triangles = {{0, 1, 2}};
  const std::string json = sessions::PackedMeshJson(mesh, 10);
  EXPECT_TRUE(json.starts_with(R"({"low":[-1.5,2.0,0.0],"step":[0.0015526)"))
      << "101.75 mm in 65535 steps: " << json;
  EXPECT_TRUE(json.ends_with(R"("triangles":"AAABAAIA","vertices":"AAAAAAAA//8AAAAAUgv//wAA","wide":false})"))
      << json;
}

TEST(ReportModel, ALargeMeshIsToldCoarser) {
  core::TriangleMesh mesh;
  constexpr int kSide = 300;
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x) mesh.vertices_mm.emplace_back(x, y, 0.0);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const int at = y * (kSide + 1) + x;
      mesh.triangles.push_back({at, at + 1, at + kSide + 2});
      mesh.triangles.push_back({at, at + kSide + 2, at + kSide + 1});
    }
  }
  // 20,000 triangles of 6 bytes and 10,000 corners of 6 bytes, in base64.
  EXPECT_LT(sessions::PackedMeshJson(mesh, 20'000).size(), 245'000U);
}

TEST(Report, EscapesEveryTextFromOutside) {
  const TemporaryFolder folder;
  const std::string hostile = "<script>alert('x')</script>\"&";
  core::SessionHeader header = SampleHeader();
  header.trial.participant = header.trial.task = header.rig.name = hostile;
  header.layout.parts[1].name = header.layout.spacings[0].moving = header.layout.groups[0].parts[1] = hostile;
  header.layout.groups[1].name = hostile + "2";
  header.layout.pair_rules[0].a = header.layout.pair_rules[2].a = hostile;
  header.layout.spacings[0].name = hostile;
  header.settings[hostile] = header.versions[hostile] = hostile;
  core::CameraCalibration renamed = header.rig.cameras[0].calibration();
  renamed.name = hostile;
  header.rig.cameras[0] = core::CameraModel(renamed);
  {
    sessions::SessionWriter writer(folder / "s.db", header);
    for (core::FrameIndex i = 0; i < 20; ++i) writer.Append(SampleFrame(header, i, 1));
    writer.Append(core::SessionEvent{1, 0.1, core::Note{hostile}});
    writer.Append(core::SessionEvent{1, 0.1, core::ToolMarked{hostile, true}});
    writer.Append(core::SessionEvent{4, 0.1, core::SpacingChanged{hostile, 140.0, 240.0}});
    writer.Finish({SampleEpisodes(0, 19), {}, {}});
  }
  const std::string html = ReportOf(folder / "s.db", folder.path(), {kPng, hostile, std::nullopt});
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_EQ(html.find("</script>\\\""), std::string::npos) << "in the data";
  EXPECT_GT(Count(html, "&lt;script&gt;"), 12);
}

TEST(Report, ASessionThatBrokeOffIsReportedAsSuch) {
  const TemporaryFolder folder;
  TrialPlan plan = UsualTrial();
  plan.is_finished = false;
  WriteTrial(folder / "s.db", plan);
  const std::string html = ReportOf(folder / "s.db", folder.path());
  EXPECT_NE(html.find("The recording broke off after 62.0 s with contact in 207 of 620 frames"),
            std::string::npos);
  EXPECT_EQ(Count(html, "data-touch='"), 0);
}

TEST(Report, AnEmptySessionHasAReportToo) {
  const TemporaryFolder folder;
  core::SessionHeader header = SampleHeader();
  header.layout = {};
  sessions::SessionWriter(folder / "s.db", header).Finish({});
  EXPECT_NE(ReportOf(folder / "s.db", folder.path()).find("No frame was recorded"), std::string::npos);
  EXPECT_EQ(Count(ReportText(folder / "contacts.csv"), "\n"), 1);
}

TEST(Report, OneFrameHasAReportToo) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 1);
  (void)ReportOf(folder / "s.db", folder.path());
}

TEST(Report, IsTheSameEachTime) {
  const TemporaryFolder folder;
  WriteTrial(folder / "s.db", UsualTrial());
  EXPECT_EQ(ReportOf(folder / "s.db", folder / "a"), ReportOf(folder / "s.db", folder / "b"));
  EXPECT_EQ(ReportText(folder / "a" / "contacts.csv"), ReportText(folder / "b" / "contacts.csv"));
}

TEST(Report, ContactsCsvHasARowForEachPartInContact) {
  const TemporaryFolder folder;
  WriteTrial(folder / "s.db", UsualTrial());
  (void)ReportOf(folder / "s.db", folder.path());
  std::istringstream csv(ReportText(folder / "contacts.csv"));
  std::string head, first;
  std::getline(csv, head);
  std::getline(csv, first);
  EXPECT_TRUE(head.starts_with("frame,time_s,part,contact_area_mm2,contact_points,depth_mm,deepest_x_mm"))
      << head;
  EXPECT_TRUE(head.ends_with(",spacing PMT to payload A mm")) << head;
  EXPECT_TRUE(first.starts_with("40,4,payload A,")) << first;
  EXPECT_TRUE(first.ends_with(",140")) << first;
  EXPECT_EQ(Count(first, ","), Count(head, ","));
  const std::size_t rows = SessionReader(folder / "s.db").contacts().size();
  EXPECT_EQ(Count(csv.str(), "\n"), static_cast<std::int64_t>(rows) + 1);
}

TEST(Report, ContactsCsvQuotesNames) {
  const TemporaryFolder folder;
  core::SessionHeader header = SampleHeader();
  header.layout.parts[0].name = header.layout.spacings[0].reference = "box, \"big\"";
  header.layout.spacings[1].reference = header.layout.pair_rules[0].b = header.layout.pair_rules[1].b =
      header.layout.groups[1].parts[0] = "box, \"big\"";
  {
    sessions::SessionWriter writer(folder / "s.db", header);
    writer.Append(SampleFrame(header, 0, 1));
    writer.Finish({});
  }
  (void)ReportOf(folder / "s.db", folder.path());
  EXPECT_NE(ReportText(folder / "contacts.csv").find(",\"box, \"\"big\"\"\","), std::string::npos);
}

TEST(Report, IsWrittenWholeOrNotAtAll) {
  const TemporaryFolder folder;
  WriteTrial(folder / "s.db", UsualTrial());
  const SessionReader session(folder / "s.db");
  std::ofstream(folder / "file") << "not a folder";
  ExpectError([&] { sessions::WriteReport(session, {}, folder / "file" / "out"); }, core::ErrorKind::kFile,
              "file");
  fs::create_directories(folder / "out" / "report.html");
  std::ofstream(folder / "out" / "contacts.csv") << "older";
  ExpectError([&] { sessions::WriteReport(session, {}, folder / "out"); }, core::ErrorKind::kFile,
              "report.html");
  EXPECT_EQ(ReportText(folder / "out" / "contacts.csv"), "older");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out"), fs::directory_iterator()), 2);
}

TEST(Report, TakesOnlyPngPictures) {
  const TemporaryFolder folder;
  WriteTrial(folder / "s.db", UsualTrial());
  const SessionReader session(folder / "s.db");
  const ReportPictures no_png{{1, 2, 3}, "", std::nullopt};
  EXPECT_THROW(sessions::WriteReport(
                   session, [&] { return no_png; }, folder.path()),
               core::PreconditionError);
  EXPECT_FALSE(fs::exists(folder / "report.html"));
}

TEST(Report, WorstEpisodeIsTheDeepestThenTheLargestThenTheFirst) {
  EXPECT_FALSE(sessions::WorstEpisode({}).has_value());
  std::vector<core::ContactEpisode> episodes(4);
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    episodes[i].id = static_cast<core::EpisodeId>(i) + 1;
    episodes[i].peak_frame = static_cast<core::FrameIndex>(10 * i);
    episodes[i].peak_depth_mm = i == 0 ? 5.0 : 7.0;
    episodes[i].peak_area_mm2 = i == 1 ? 20.0 : 30.0;
  }
  EXPECT_EQ(sessions::WorstEpisode(episodes)->id, 3);
}

TEST(Markup, Base64IsThatOfRfc4648) {
  const auto encoded = [](const std::string& text) {
    return sessions::PngAsDataUrl({reinterpret_cast<const unsigned char*>(text.data()), text.size()})
        .substr(22);
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace elbowroom::tests
