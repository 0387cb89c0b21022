#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/reporting/gnuplot.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/reporting/pareto_picture.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::reporting {
namespace {

constexpr const char* kDocument =
    "# Speed\n\nProse before.\n<!-- bench:views begin -->\nold table\n<!-- bench:views end -->\nProse "
    "after.\n"
    "<!-- bench:hulls begin -->\n<!-- bench:hulls end -->\n";

// The message of the core::Error that `act` throws.
template <typename Act>
std::string ErrorOf(const Act& act) {
  try {
    act();
  } catch (const core::Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(WithSection, ReplacesTheTableAndKeepsTheProse) {
  EXPECT_EQ(WithSection(kDocument, "views", "| new |\n", "doc"),
            "# Speed\n\nProse before.\n<!-- bench:views begin -->\n\n| new |\n\n<!-- bench:views end "
            "-->\nProse after.\n"
            "<!-- bench:hulls begin -->\n<!-- bench:hulls end -->\n");
}

TEST(WithSection, WrittenTwiceIsWrittenOnce) {
  const std::string once = WithSection(kDocument, "hulls", "| a |", "doc");
  EXPECT_EQ(WithSection(once, "hulls", "| a |", "doc"), once);
}

TEST(WithSection, SaysWhichMarkerIsMissingOrDouble) {
  const std::string missing = ErrorOf([] { (void)WithSection(kDocument, "masks", "", "docs/speed.md"); });
  EXPECT_EQ(
      missing,
      "docs/speed.md: the line '<!-- bench:masks begin -->' must stand there exactly once; put it where "
      "the table belongs");
  const std::string twice = std::string(kDocument) + "<!-- bench:views end -->\n";
  EXPECT_NE(ErrorOf([&] { (void)WithSection(twice, "views", "", "doc"); }), "no error");
  EXPECT_NE(ErrorOf([] {
              (void)WithSection("<!-- bench:a end -->\n<!-- bench:a begin -->\n", "a", "", "doc");
            }).find("swap them"),
            std::string::npos);
}

TEST(WriteSection, LeavesTheFileAloneWhereItFails) {
  const test_support::TemporaryFolder folder;
  test_support::WriteText(folder / "doc.md", kDocument);
  EXPECT_THROW(WriteSection(folder / "doc.md", "masks", "x"), core::Error);
  EXPECT_EQ(test_support::ReadText(folder / "doc.md"), kDocument);
  WriteSection(folder / "doc.md", "views", "x");
  EXPECT_NE(test_support::ReadText(folder / "doc.md").find("\n\nx\n\n"), std::string::npos);
  EXPECT_THROW(WriteSection(folder / "nowhere.md", "views", "x"), core::Error);
}

TEST(ToMarkdown, AlignsFiguresToTheRight) {
  EXPECT_EQ(ToMarkdown({{"what", "ms"}, {{"a|b", "1"}}}), "| what | ms |\n| --- | ---: |\n| a\\|b | 1 |\n");
  EXPECT_THROW((void)ToMarkdown({{"what", "ms"}, {{"a"}}}), core::PreconditionError);
}

TEST(TableOf, ReadsWhatToMarkdownWrites) {
  const Table table{{"what", "ms"}, {{"a|b", "1"}, {"", "2.5 us"}}};
  const Table read =
      TableOf("Prose.\n\n" + ToMarkdown(table) + "\n*a machine*\n" + ToMarkdown({{"x"}, {{"y"}}}));
  EXPECT_EQ(read.header, table.header);
  EXPECT_EQ(read.rows, table.rows);
  EXPECT_THROW((void)TableOf("Prose.\n"), core::Error);
  EXPECT_THROW((void)TableOf("| a | b |\n| --- | ---: |\n| 1 |\n"), core::Error);
}

TEST(SectionOf, IsWhatWithSectionWrote) {
  const std::string written = WithSection(kDocument, "hulls", "| a |", "doc");
  EXPECT_EQ(SectionOf(written, "hulls", "doc"), "\n\n| a |\n\n");
  EXPECT_THROW((void)SectionOf(written, "masks", "doc"), core::Error);
}

TEST(ThreeDigits, AreThreeDigits) {
  EXPECT_EQ(ThreeDigits(0.0), "0");
  EXPECT_EQ(ThreeDigits(0.0012345), "0.00123");
  EXPECT_EQ(ThreeDigits(-0.4816), "-0.482");
  EXPECT_EQ(ThreeDigits(12.68), "12.7");
  EXPECT_EQ(ThreeDigits(123.4), "123");
  EXPECT_EQ(ThreeDigits(123456.0), "123000");
}

TEST(ThisMachine, IsNamed) {
  const Machine machine = ThisMachine(test_support::SourceFolder());
  EXPECT_GE(machine.cores, 1);
  EXPECT_NE(machine.processor, "");
  EXPECT_NE(machine.gl_driver.find("OpenGL"), std::string::npos);
  EXPECT_EQ(machine.date.size(), 10U);
  const std::string line = ToLine(machine);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_NE(line.find(machine.compiler), std::string::npos);
}

TEST(RunGnuplot, SaysInOneLineWhatToInstall) {
  EXPECT_EQ(
      ErrorOf([] { RunGnuplot("none.gnuplot", "gnuplot-that-is-not-there"); }),
      "'gnuplot-that-is-not-there' isn't installed, so there is no picture; install the package gnuplot-nox");
}

TEST(DrawPareto, DrawsBothPicturesAndNamesNoFolder) {
  const test_support::TemporaryFolder folder;
  DrawPareto({"ms",
              "mm",
              {{"first panel", {{"a", "one", 1.0, 0.5}, {"a", "two", 2.0, 0.0}, {"b", "one", 9.0, 9.0}}},
               {"second panel", {{"b", "three", 9.0, 9.0}, {"b", "four", 10.0, 1.0}}}}},
             folder / "views");
  EXPECT_TRUE(test_support::ReadText(folder / "views.png").starts_with("\x89PNG"));
  const std::string svg = test_support::ReadText(folder / "views.svg");
  for (const char* word : {"two", "three", "first panel", "second panel", "dominated"})
    EXPECT_NE(svg.find(word), std::string::npos) << word;
  EXPECT_NE(svg.find("rgb(184, 184, 184)"), std::string::npos) << "the dominated point is grey";
  EXPECT_EQ(test_support::ReadText(folder / "views.gnuplot").find(folder.path().string()), std::string::npos);
  EXPECT_THROW(DrawPareto({"x", "y", {}}, folder / "none"), core::PreconditionError);
  EXPECT_THROW(DrawPareto({"x", "y", {{"t", {}}}}, folder / "none"), core::PreconditionError);
}

TEST(DominatedOf, IsWhatAnotherBeatsInBoth) {
  const std::vector<ParetoPoint> points = {{"a", "1", 1.0, 1.0},
                                           {"a", "2", 2.0, 0.5},
                                           {"b", "1", 2.0, 1.0},
                                           {"b", "2", 2.0, 0.5},
                                           {"c", "1", 0.5, 9.0}};
  EXPECT_EQ(DominatedOf(points), (std::vector<bool>{false, false, true, false, false}));
}

}  // namespace
}  // namespace elbowroom::reporting
