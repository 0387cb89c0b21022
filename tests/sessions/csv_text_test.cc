// Texts of people in tables that spreadsheets open: none of them runs there.
#include "sessions/tables/csv_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "sessions/tables/clearance_csv.h"
#include "sessions/tables/contacts_csv.h"

namespace elbowroom::sessions {
namespace {

TEST(CsvText, OrdinaryTextsStayWhatTheyAre) {
  EXPECT_EQ(Quoted("payload A"), "payload A");
  EXPECT_EQ(Quoted("PMT-box 3+4 a@b = c"), "PMT-box 3+4 a@b = c");
  EXPECT_EQ(Quoted("a, b"), "\"a, b\"");
  EXPECT_EQ(Quoted("12\" rack"), "\"12\"\" rack\"");
  EXPECT_EQ(Quoted("a, -b"), "\"a, -b\"") << "the quotes hold the comma";
  EXPECT_EQ(Quoted(""), "");
}

TEST(CsvText, WhatASpreadsheetTakesForAFormulaGetsAnApostrophe) {
  EXPECT_EQ(Quoted("=cmd|' /C calc'!A0"), "\"'=cmd|' /C calc'!A0\"");
  EXPECT_EQ(Quoted("+1+1"), "\"'+1+1\"");
  EXPECT_EQ(Quoted("-2+3"), "\"'-2+3\"");
  EXPECT_EQ(Quoted("@SUM(A1)"), "\"'@SUM(A1)\"");
  EXPECT_EQ(Quoted("\t=1"), "\"'\t'=1\"");
  EXPECT_EQ(Quoted("\r=1"), "\"'\r'=1\"");
  EXPECT_EQ(Quoted("  =1"), "\"  '=1\"");
  EXPECT_EQ(Quoted("\"=1"), "\"\"\"'=1\"");
  EXPECT_EQ(Quoted("'=1"), "\"''=1\"");
  EXPECT_EQ(Quoted("box;=1"), "\"box;'=1\"") << "where cells end at semicolons";
  EXPECT_EQ(Quoted("box\n=1"), "\"box\n'=1\"");
  EXPECT_EQ(Quoted("\xEF\xBC\x9D"
                   "1"),
            "\"'\xEF\xBC\x9D"
            "1\"")
      << "full width";
}

// A layout whose every text is a formula.
core::SessionHeader HostileHeader() {
  core::SessionHeader header;
  core::Part part;
  part.name = "=cmd|' /C calc'!A0";
  header.layout.parts = {part};
  core::Spacing spacing;
  spacing.name = "gap;=1+1";
  header.layout.spacings = {spacing};
  return header;
}

std::vector<ContactRow> OneRow() {
  ContactRow row;
  row.spacing_mm = {-5.0};
  row.contact.clearance.emplace();
  row.contact.deepest.emplace();
  row.contact.deepest->position_in_world_mm = {-1.0, -2.0, -3.0};
  return {row};
}

TEST(CsvText, NeitherTableHoldsAFormulaAndNumbersStayNumbers) {
  const core::SessionHeader header = HostileHeader();
  for (const std::string& csv : {ContactsCsv(header.layout, OneRow()), ClearanceCsv(header, OneRow())}) {
    EXPECT_NE(csv.find(",\"'=cmd|' /C calc'!A0\","), std::string::npos) << csv;
    EXPECT_NE(csv.find(",\"spacing gap;'=1+1 mm\"\n"), std::string::npos) << csv;
    EXPECT_TRUE(csv.ends_with(",-5\n")) << csv;
    for (const char* raw : {",=", ",\"=", ";="}) EXPECT_EQ(csv.find(raw), std::string::npos) << csv;
  }
  EXPECT_NE(ContactsCsv(header.layout, OneRow()).find(",-1,-2,-3,"), std::string::npos);
}

}  // namespace
}  // namespace elbowroom::sessions
