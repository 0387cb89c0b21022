#include "tests/support/documents/read_pdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <regex>
#include <sstream>

#include "tests/support/run_program.h"

namespace elbowroom::tests {
namespace {

constexpr const char* kPdfToText = "/usr/bin/pdftotext";
constexpr const char* kQpdf = "/usr/bin/qpdf";
// Of A4, in points: what stands in its margins is clipped by many printers. A slanted letter may reach a
// point out of its line.
constexpr double kWidth = 595.3, kHeight = 841.9, kMarginX = 39.0, kMarginY = 24.0;

std::string RunForText(const std::filesystem::path& pdf, const char* how) {
  const test_support::ProgramRun run =
      test_support::RunProgram(kPdfToText, {how, "-enc", "UTF-8", pdf.string(), "-"});
  EXPECT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  return run.out;
}

}  // namespace

bool HasPdfReaders() { return std::filesystem::exists(kPdfToText) && std::filesystem::exists(kQpdf); }

std::string TextOf(const std::filesystem::path& pdf) { return RunForText(pdf, "-raw"); }

std::vector<std::string> TextsOfPages(const std::filesystem::path& pdf) {
  std::istringstream text(TextOf(pdf));
  std::vector<std::string> pages;
  for (std::string page; std::getline(text, page, '\f');) pages.push_back(page);
  return pages;
}

std::string Squeezed(const std::string& text) {
  std::string squeezed;
  std::ranges::copy_if(text, std::back_inserter(squeezed),
                       [](char c) { return std::isspace(static_cast<unsigned char>(c)) == 0 && c != '\f'; });
  return squeezed;
}

std::int64_t CountOf(const std::string& text, const std::string& what) {
  std::int64_t count = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++count;
  return count;
}

void ExpectGoodPdf(const std::filesystem::path& pdf) {
  const test_support::ProgramRun check = test_support::RunProgram(kQpdf, {"--check", pdf.string()});
  EXPECT_EQ(check.exit_status, 0) << check.out << check.err;
  const std::string boxes = RunForText(pdf, "-bbox");
  const std::regex word(
      R"RE(<word xMin="([-0-9.]+)" yMin="([-0-9.]+)" xMax="([-0-9.]+)" yMax="([-0-9.]+)">)RE");
  std::size_t words = 0;
  for (std::sregex_iterator at(boxes.begin(), boxes.end(), word), end; at != end; ++at, ++words) {
    const auto number = [&](int i) { return std::stod((*at)[static_cast<std::size_t>(i)]); };
    EXPECT_GE(number(1), kMarginX) << at->str();
    EXPECT_GE(number(2), kMarginY) << at->str();
    EXPECT_LE(number(3), kWidth - kMarginX) << at->str();
    EXPECT_LE(number(4), kHeight - kMarginY) << at->str();
  }
  EXPECT_GT(words, 0U);
}

}  // namespace elbowroom::tests
