// The report of a study: in a browser, on paper, and what it is put together from.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/control/study/study.h"
#include "app/control/study/study_charts.h"
#include "app/control/study/study_document.h"
#include "app/control/study/study_files.h"
#include "core/error.h"
#include "sessions/session_reader.h"
#include "tests/app/study/cohort.h"
#include "tests/support/documents/page_in_browser.h"
#include "tests/support/documents/read_pdf.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

namespace fs = std::filesystem;
using control::Study;
using tests::Reach;

class StudyReportTest : public testing::Test {
 protected:
  fs::path Record(const std::string& file, const Reach& reach) {
    const fs::path path = folder_ / file;
    fs::create_directories(path.parent_path());
    tests::RecordReach(path, reach);
    sessions_.push_back(path);
    return path;
  }
  [[nodiscard]] Study Make() const {
    return control::MakeStudy({sessions_, {"lid_gap", 20.0, 300.0, 20.0}, folder_ / "out"}, {}, {});
  }
  fs::path Write(const Study& study) {
    (void)control::WriteStudy(study, folder_ / "out", {}, {});
    // For those who want to look at it.
    if (const char* kept = std::getenv("ELBOWROOM_SCREENSHOTS"))
      for (const char* file : {"report.html", "report.pdf"})
        fs::copy_file(folder_ / "out" / file, fs::path(kept) / file, fs::copy_options::overwrite_existing);
    return folder_ / "out/report.html";
  }

  test_support::TemporaryFolder folder_;
  std::vector<fs::path> sessions_;
};

// Two conditions, tools, estimates, answers, a lid that is touched, and a name that isn't markup.
class StudyOfTwoConditions : public StudyReportTest {
 protected:
  void SetUp() override {
    const std::string hostile = "<script>alert('x')</script>\"'&";
    Record("1.db", {"P1", "bare", 1, 100.0, 130.0, 121.0, 0.0, 0.5, 3, 115.0});
    Record("2.db", {"P2", "tongs", 1, 90.0, 170.0, 118.0, 171.0, 0.7, 5, 160.0});
    Record("3.db", {hostile, "tongs", 1, 140.0, 180.0, 132.0, 164.0, 0.9, 6, 160.0});
    Record("4.db", {"P4", "bare", 1, 110.0, 160.0, 115.0, 0.0, 0.6, 4});
  }
};

TEST_F(StudyOfTwoConditions, IsAPageThatWorks) {
  if (!tests::HasBrowser()) GTEST_SKIP() << "NOT TESTED: no /usr/bin/chromium";
  const fs::path page = Write(Make());
  tests::ExpectPageWorks(page, folder_ / "shots");
  const std::string html = test_support::ReadText(page);
  EXPECT_EQ(html.find("<script>alert"), std::string::npos) << "a name is no markup";
  // Estimates, need, a chart for each measure that both conditions have, and the lid's map.
  EXPECT_NE(html.find("Where parts were touched"), std::string::npos);
  EXPECT_GE(tests::CountOf(html, "<figure class='chart"), 4);
}

TEST_F(StudyOfTwoConditions, HasThoseFiguresOnPaper) {
  if (!tests::HasPdfReaders()) GTEST_SKIP() << "NOT TESTED: no pdftotext or qpdf";
  const Study study = Make();
  Write(study);
  const fs::path pdf = folder_ / "out/report.pdf";
  tests::ExpectGoodPdf(pdf);
  const std::string text = tests::Squeezed(tests::TextOf(pdf));
  for (const control::StudyRow& row : study.rows) {
    EXPECT_NE(text.find(tests::Squeezed(row.participant)), std::string::npos) << row.participant;
    for (const auto& length_mm : {row.estimate_before_mm, row.needed_without_tools_mm, row.needed_mm,
                                  row.shortfall_mm(), row.estimate_after_mm}) {
      ASSERT_TRUE(length_mm) << row.participant;
      EXPECT_NE(text.find(fmt::format("{:.1f}", *length_mm)), std::string::npos) << *length_mm;
    }
  }
  EXPECT_NE(text.find(fmt::format("{:.1f}mm", study.shortfall_mm->mean)), std::string::npos);
  for (const control::Comparison& comparison : study.comparisons) {
    if (!comparison.means) continue;
    EXPECT_NE(text.find(fmt::format("{:.2f}", comparison.means->t)), std::string::npos) << comparison.measure;
  }
  for (const char* word : {"4of4estimatedlessthantheyneeded,mostofallP2", "Whatthesefigurescan'tsay",
                           "fewparticipants,4", "Holm"})
    EXPECT_NE(text.find(word), std::string::npos) << word;
}

TEST_F(StudyOfTwoConditions, IsTheSameAgain) {
  Write(Make());
  const std::string html = test_support::ReadText(folder_ / "out/report.html");
  const std::string pdf = test_support::ReadText(folder_ / "out/report.pdf");
  std::ranges::reverse(sessions_);
  Write(Make());
  EXPECT_EQ(test_support::ReadText(folder_ / "out/report.pdf"), pdf);
  EXPECT_EQ(test_support::ReadText(folder_ / "out/report.html"), html);
}

TEST_F(StudyOfTwoConditions, StoppedItLeavesWhatWasThere) {
  const Study study = Make();
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)control::WriteStudy(study, folder_ / "out", {}, stop.get_token()), core::Error);
  EXPECT_FALSE(fs::exists(folder_ / "out/participants.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "out/report.html"));
}

class StudyWithoutEstimates : public StudyReportTest {
 protected:
  // How long the step takes differs surely, the space needed hardly.
  void SetUp() override {
    for (int person = 0; person < 8; ++person) {
      const bool is_gloved = person % 2 == 1;
      Record(fmt::format("{}.db", person),
             {fmt::format("P{}", person), is_gloved ? "gloved" : "bare", 1, 0.0, 0.0,
              100.0 + 5.0 * (person / 2), 0.0, (is_gloved ? 0.8 : 0.2) + 0.02 * person});
    }
  }
  [[nodiscard]] std::string VerdictOf(const Study& study) const {
    sessions::ChartPainters painters;
    const sessions::Document document = control::StudyDocument(study, {}, &painters);
    return std::get<sessions::Verdict>(document.sections.front().blocks.front()).paragraphs.front();
  }
};

TEST_F(StudyWithoutEstimates, ItsVerdictIsAboutTheConditions) {
  const std::string verdict = VerdictOf(Make());
  for (const char* word :
       {"Conditions differ, in 1 of ", "'bare' against 'gloved', step 'reach in', s: 0.26 against 0.88"})
    EXPECT_NE(verdict.find(word), std::string::npos) << word << " in: " << verdict;
  Study none = Make();
  none.comparisons.clear();
  EXPECT_NE(VerdictOf(none).find("no two conditions can be compared"), std::string::npos) << VerdictOf(none);
}

TEST_F(StudyWithoutEstimates, TheSurestDifferenceIsDrawnFirst) {
  const Study study = Make();
  const auto charts = control::ConditionCharts(study);
  ASSERT_GE(charts.size(), 2U);
  EXPECT_EQ(charts.front().x_name, "step 'reach in', s");
}

TEST(StudyCharts, AnAxisBeginsAndEndsAtRoundNumbers) {
  const auto axis = [](double low, double high) {
    Study study;
    study.rows.push_back({.participant = "P1", .estimate_before_mm = low, .needed_mm = high});
    const auto chart = control::EstimateChart(study);
    return fmt::format("{} {}", chart.x_from, chart.x_to);
  };
  EXPECT_EQ(axis(1.35, 3.5), "1.2 3.6") << "not 1.2000000000000002";
  EXPECT_EQ(axis(-0.00034, 0.00125), "-0.0004 0.0013");
  EXPECT_EQ(axis(150.0, 295.0), "140 300");
  EXPECT_EQ(axis(12'345.0, 98'765.0), "10000 100000");
}

TEST_F(StudyReportTest, OneSessionWithoutACodeIsAReport) {
  if (!tests::HasBrowser()) GTEST_SKIP() << "NOT TESTED: no /usr/bin/chromium";
  Record("alone.db", {"", "", 0, 0.0, 0.0, 80.0});
  const Study study = Make();
  EXPECT_TRUE(study.comparisons.empty());
  tests::ExpectPageWorks(Write(study), folder_ / "shots");
}

TEST_F(StudyReportTest, SessionsWithoutACodeAreApart) {
  Record("monday/trial.db", {"", "", 0, 100.0, 0.0, 80.0});
  Record("tuesday/trial.db", {"", "", 0, 100.0, 0.0, 90.0});
  Record("P1.db", {"", "", 0, 100.0, 0.0, 95.0});
  Record("other.db", {"P1", "", 0, 100.0, 0.0, 85.0});
  Record("named.db", {"", "", 0, 100.0, 0.0, 70.0});
  const Study study = Make();
  ASSERT_EQ(study.rows.size(), 5U);
  std::vector<std::string> names;
  for (const control::StudyRow& row : study.rows) {
    EXPECT_EQ(row.sessions, 1U) << row.participant;
    names.push_back(row.participant);
  }
  EXPECT_TRUE(std::ranges::count(names, "P1") == 1 && std::ranges::count(names, "named") == 1)
      << testing::PrintToString(names);
  EXPECT_EQ(std::ranges::count_if(names, [](const std::string& n) { return n.starts_with("trial ("); }), 2);
}

TEST_F(StudyReportTest, DwellIsTheSumOfTheSessions) {
  const fs::path a = Record("a.db", {"P1", "", 1, 100.0, 0.0, 121.0, 0.0, 0.5, 0, 110.0});
  const fs::path b = Record("b.db", {"P2", "", 1, 100.0, 0.0, 130.0, 0.0, 0.5, 0, 115.0});
  Record("clear.db", {"P3", "", 1, 100.0, 0.0, 100.0});
  const Study study = Make();
  const auto lid = std::ranges::find(study.dwell, "lid", &control::PartDwell::part);
  ASSERT_NE(lid, study.dwell.end());
  EXPECT_EQ(lid->sessions, 2U);
  const auto map_of = [](const fs::path& path) {
    const sessions::SessionReader session(path);
    for (core::HeatMap& map : session.heat_maps())
      if (session.header().layout.parts[map.part].name == "lid") return map;
    return core::HeatMap();
  };
  const core::HeatMap of_a = map_of(a), of_b = map_of(b);
  ASSERT_EQ(of_a.dwell_s.size(), lid->map.dwell_s.size());
  ASSERT_EQ(of_b.dwell_s.size(), lid->map.dwell_s.size());
  double touched_s = 0.0;
  for (std::size_t i = 0; i < of_a.dwell_s.size(); ++i) {
    EXPECT_FLOAT_EQ(lid->map.dwell_s[i], of_a.dwell_s[i] + of_b.dwell_s[i]);
    EXPECT_EQ(lid->map.peak_depth_mm[i], std::max(of_a.peak_depth_mm[i], of_b.peak_depth_mm[i]));
    touched_s += of_a.dwell_s[i];
  }
  EXPECT_GT(touched_s, 0.0);
}

}  // namespace
}  // namespace elbowroom
