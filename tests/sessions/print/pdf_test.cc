// Documents on paper: what breaks where, and what a reader finds.
#include "sessions/print/pdf.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "core/error.h"
#include "tests/sessions/sample_picture.h"
#include "tests/support/documents/read_pdf.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {
namespace {

using namespace sessions;  // NOLINT(google-build-using-namespace): the document's values
using test_support::TemporaryFolder;

Document DocumentOf(std::vector<Block> blocks) {
  Document document;
  document.kicker = "Elbowroom trial report";
  document.title = "A title";
  document.made_at_utc = "2026-01-02T03:04:05Z";
  document.sections = {{.blocks = std::move(blocks)}};
  return document;
}

class Pdf : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasPdfReaders()) GTEST_SKIP() << "NOT TESTED: no /usr/bin/pdftotext or /usr/bin/qpdf";
  }

  std::filesystem::path Written(const Document& document) {
    test_support::WriteText(folder_ / "d.pdf", PdfOf(document));
    ExpectGoodPdf(folder_ / "d.pdf");
    return folder_ / "d.pdf";
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Pdf, NoRowIsBrokenBetweenPagesAndEachPageHasTheHead) {
  DocumentTable table{{{"Name"}, {"Figure", true}}};
  constexpr int kRows = 150;
  for (int i = 0; i < kRows; ++i) {
    RichText lines;
    for (int line = 0; line < 1 + i % 7; ++line)
      lines += {.text = fmt::format("row{}line{}", i, line), .begins_line = line > 0};
    lines += {.text = fmt::format("row{}end", i), .begins_line = true};
    table.rows.push_back({{std::move(lines), fmt::format("{}.5 mm", i)}});
  }
  const std::vector<std::string> pages =
      TextsOfPages(Written(DocumentOf({Heading{"Rows"}, std::move(table)})));
  ASSERT_GT(pages.size(), 4U);
  int rows = 0;
  for (std::size_t page = 0; page < pages.size(); ++page) {
    EXPECT_EQ(CountOf(pages[page], "Name\nFigure\n") + CountOf(pages[page], "Name Figure\n"), 1)
        << pages[page];
    EXPECT_EQ(CountOf(pages[page], fmt::format("page {} of {}", page + 1, pages.size())), 1);
    EXPECT_EQ(CountOf(pages[page], "line0"), CountOf(pages[page], "end")) << "page " << page + 1;
    rows += static_cast<int>(CountOf(pages[page], "end"));
  }
  EXPECT_EQ(rows, kRows);
}

TEST_F(Pdf, ARowHigherThanAPageGoesOnOnTheNext) {
  constexpr int kLetters = 60'000;
  DocumentTable table{{{"Name"}, {"Figure", true}, {"Remark"}}};
  table.rows.push_back({{std::string(kLetters, 'x'), "17 mm", "short"}});
  const std::filesystem::path pdf = Written(DocumentOf({std::move(table)}));
  EXPECT_GT(TextsOfPages(pdf).size(), 2U);
  EXPECT_EQ(CountOf(TextOf(pdf), "x"), kLetters) << "all letters are there";
  EXPECT_EQ(CountOf(TextOf(pdf), "17 mm"), 1);
}

TEST_F(Pdf, LongTextsEverywhereLoseNothing) {
  constexpr int kLetters = 10'000;
  const std::string text(kLetters, 'x');
  Document document =
      DocumentOf({Verdict{Verdict::Outcome::kTouched, {text, text}},
                  Tiles{{{text, text, text}, {"a", "b", text}}}, Heading{text}, Heading{text, true},
                  Paragraph{text}, Bullets{{text}}, Picture{kSamplePng, text, text}});
  document.facts = {text};
  document.title = text;
  document.footer = text;
  // The title also runs, cut, above every page but the first.
  EXPECT_GE(CountOf(TextOf(Written(document)), "x"), 13 * kLetters);
}

TEST_F(Pdf, TextsAreTextWhateverTheySay) {
  const std::string hostile = "<script>alert('x')</script>\"&amp;=cmd|' /C calc'!A0";
  const std::string mixed = "left \u202E\u05E9\u05DC\u05D5\u05DD right";
  Document document = DocumentOf({Heading{hostile}, Paragraph{hostile}, Paragraph{mixed},
                                  Paragraph{std::string("bad \xFF\xC3 bytes \x01\x00 end", 20)},
                                  DocumentTable{{{"Name"}}, {{{hostile}}}}});
  document.title = hostile;
  const std::string text = TextOf(Written(document));
  EXPECT_EQ(CountOf(Squeezed(text), Squeezed(hostile)), 4) << text;
  EXPECT_NE(text.find("left"), std::string::npos);
  EXPECT_NE(text.find("\u05E9"), std::string::npos) << "Hebrew letters: " << text;
  EXPECT_NE(text.find("bytes"), std::string::npos);
}

TEST_F(Pdf, HasAnOutlineOfItsSections) {
  const std::filesystem::path pdf =
      Written(DocumentOf({Heading{"First"}, Heading{"Below", true}, Heading{"Second"}, Paragraph{"text"}}));
  const std::string bytes = test_support::ReadText(pdf);
  for (const char* title : {"(A title)", "(First)", "(Below)", "(Second)"})
    EXPECT_NE(bytes.find("/Title " + std::string(title)), std::string::npos) << title;
}

TEST_F(Pdf, WhatIsForScreensIsLeftOut) {
  Document document = DocumentOf({Paragraph{"on paper"}});
  document.sections.push_back({.blocks = {Heading{"turn it"}, ModelView{}}, .is_for_screens = true});
  const std::string text = TextOf(Written(document));
  EXPECT_NE(text.find("on paper"), std::string::npos);
  EXPECT_EQ(text.find("turn it"), std::string::npos);
}

TEST_F(Pdf, AnEmptyDocumentIsAPage) { EXPECT_EQ(TextsOfPages(Written(DocumentOf({}))).size(), 1U); }

TEST(PdfBytes, AreTheSameForTheSameDocument) {
  DocumentTable table{{{"Name"}, {"Picture"}}};
  DocumentCell picture;
  picture.png = kSamplePng;
  table.rows.push_back({{"a", picture}});
  const Document document = DocumentOf({Paragraph{"text"}, std::move(table)});
  const std::string bytes = PdfOf(document);
  EXPECT_TRUE(bytes.starts_with("%PDF-1."));
  EXPECT_EQ(bytes, PdfOf(document));
  EXPECT_NE(bytes.find("/CreationDate (20260102030405"), std::string::npos) << "the session's time";
}

TEST(PdfBytesDeathTest, AMachineWithoutFontsIsTold) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // fontconfig reads its configuration once a process
  const TemporaryFolder folder;
  test_support::WriteText(folder / "fonts.conf", "<fontconfig><dir>/nonexistent</dir></fontconfig>");
  const auto print = [&] {
    ::setenv("FONTCONFIG_FILE", (folder / "fonts.conf").c_str(), 1);
    try {
      (void)PdfOf(DocumentOf({}));
    } catch (const core::Error& error) {
      std::fputs(error.what(), stderr);
      std::_Exit(3);
    }
  };
  EXPECT_EXIT(print(), testing::ExitedWithCode(3), "needs a font, and none is installed");
}

TEST(PdfBytes, APictureMustBeAPng) {
  const std::vector<unsigned char> bytes = {0x89, 'P', 'N', 'G', 1, 2, 3};
  EXPECT_THROW((void)PdfOf(DocumentOf({Picture{bytes, "c", "a"}})), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::tests
