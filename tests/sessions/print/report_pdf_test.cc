// report.pdf: the same report as report.html.
#include <gtest/gtest.h>

#include <regex>

#include "sessions/report/report.h"
#include "sessions/session_writer.h"
#include "tests/sessions/sample_picture.h"
#include "tests/sessions/sample_session.h"
#include "tests/sessions/sample_trial.h"
#include "tests/support/documents/read_pdf.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using sessions::SessionReader;
using test_support::ReadText;
using test_support::TemporaryFolder;

class ReportPdf : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasPdfReaders()) GTEST_SKIP() << "NOT TESTED: no /usr/bin/pdftotext or /usr/bin/qpdf";
  }

  fs::path Reported(const fs::path& session, const sessions::ReportPictures& pictures = {}) {
    sessions::WriteReport(
        SessionReader(session), [&] { return pictures; }, folder_ / "out");
    ExpectGoodPdf(folder_ / "out" / "report.pdf");
    return folder_ / "out" / "report.pdf";
  }

  TemporaryFolder folder_;
};

std::string WithoutTags(const std::string& html) {
  std::string text = std::regex_replace(html, std::regex("<[^>]*>"), " ");
  for (const auto& [entity, letter] : {std::pair("&lt;", "<"),
                                       {"&gt;", ">"},
                                       {"&quot;", "\""},
                                       {"&#39;", "'"},
                                       {"&nbsp;", " "},
                                       {"&middot;", "\u00b7"},
                                       {"&amp;", "&"}})
    text = std::regex_replace(text, std::regex(entity), letter);
  return Squeezed(text);
}

// The texts of table cells, tiles, headings and paragraphs of a page.
std::vector<std::string> TextsOfPage(const std::string& html) {
  std::vector<std::string> texts;
  for (const char* tag : {"td", "th", "dt", "dd", "h1", "h2", "h3", "p", "li"}) {
    const std::regex element("<" + std::string(tag) + R"((?: [^>]*)?>([\s\S]*?)</)" + tag + ">");
    for (std::sregex_iterator at(html.begin(), html.end(), element), end; at != end; ++at)
      if (std::string text = WithoutTags((*at)[1]); !text.empty()) texts.push_back(std::move(text));
  }
  return texts;
}

void ExpectSaysWhatThePageSays(const fs::path& pdf) {
  const std::string html = ReadText(pdf.parent_path() / "report.html");
  const std::string body = html.substr(html.find("<main>"), html.find("</main>") - html.find("<main>"));
  const std::string paper = Squeezed(TextOf(pdf));
  const std::vector<std::string> texts = TextsOfPage(body);
  EXPECT_GT(texts.size(), 60U);
  for (const std::string& text : texts) EXPECT_NE(paper.find(text), std::string::npos) << text;
}

TEST_F(ReportPdf, SaysAllThatThePageSays) {
  WriteTrial(folder_ / "s.db", UsualTrial());
  const fs::path pdf = Reported(folder_ / "s.db", {kSamplePng, "Deep & <deeper>", kSamplePng});
  ExpectSaysWhatThePageSays(pdf);
  const std::string text = TextOf(pdf);
  EXPECT_NE(Squeezed(text).find("7touchesin62.0s,allwith'PMTtopayloadA'at140mm"), std::string::npos) << text;
  EXPECT_NE(text.find("payload A"), std::string::npos);
  EXPECT_NE(text.find("page 1 of"), std::string::npos);
  EXPECT_NE(text.find("time, s"), std::string::npos) << "a chart's words are text";
}

TEST_F(ReportPdf, SaysNearMissesClearancesAndHeatToo) {
  WriteSampleSession(folder_ / "s.db", 6);
  sessions::ReportPictures pictures{{}, "", std::nullopt, {{0, kSamplePng}}};
  pictures.touches = {{0, kSamplePng}};
  ExpectSaysWhatThePageSays(Reported(folder_ / "s.db", pictures));
}

TEST_F(ReportPdf, ShowsTextsOfOthersAsText) {
  const std::string hostile = "<script>alert('x')</script>\"&=cmd|\u05D0";
  const std::string note = hostile + "\u202E\u05D1" + std::string(10'000, 'x');
  core::SessionHeader header = SampleHeader();
  header.trial.participant = header.trial.task = note;
  header.layout.parts[1].name = header.layout.spacings[0].moving = header.layout.groups[0].parts[1] = hostile;
  header.layout.groups[1].name = hostile + "2";
  header.layout.pair_rules[0].a = header.layout.pair_rules[2].a = hostile;
  header.settings[hostile] = header.versions[hostile] = hostile;
  {
    sessions::SessionWriter writer(folder_ / "s.db", header);
    for (core::FrameIndex i = 0; i < 20; ++i) writer.Append(SampleFrame(header, i, 1));
    writer.Append(core::SessionEvent{1, 0.1, core::Note{note}});
    writer.Finish({SampleEpisodes(0, 19), {}, {}});
  }
  const std::string text = Squeezed(TextOf(Reported(folder_ / "s.db")));
  EXPECT_GE(CountOf(text, "<script>alert('x')</script>\"&=cmd|"), 10);
  EXPECT_GE(CountOf(text, "x"), 3 * 10'000) << "task, participant and note are whole";
}

TEST_F(ReportPdf, IsTheSameEachTime) {
  WriteTrial(folder_ / "s.db", UsualTrial());
  const std::string first = ReadText(Reported(folder_ / "s.db"));
  EXPECT_EQ(ReadText(Reported(folder_ / "s.db")), first);
}

TEST_F(ReportPdf, IsThereForASessionWithoutFrames) {
  core::SessionHeader header = SampleHeader();
  header.layout = {};
  sessions::SessionWriter(folder_ / "s.db", header).Finish({});
  EXPECT_NE(TextOf(Reported(folder_ / "s.db")).find("No frame was recorded"), std::string::npos);
}

}  // namespace
}  // namespace elbowroom::tests
