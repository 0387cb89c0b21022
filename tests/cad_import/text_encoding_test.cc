#include "cad_import/formats/text_encoding.h"

#include <gtest/gtest.h>

#include <string>

namespace elbowroom::cad_import {
namespace {

using namespace std::string_literals;

TEST(ToUtf8, LeavesTextWithoutAMarkAlone) {
  EXPECT_EQ(ToUtf8(""), "");
  EXPECT_EQ(ToUtf8("v 1 2 3\n"), "v 1 2 3\n");
  EXPECT_EQ(ToUtf8("\xEF\xBB\xBF<a/>"), "\xEF\xBB\xBF<a/>");
  EXPECT_EQ(ToUtf8("\xFF"), "\xFF");
}

// a, e with acute accent, euro, a clef beyond the first plane.
TEST(ToUtf8, ReadsEveryEncodingThatAMarkNames) {
  const std::string text = "a\xC3\xA9\xE2\x82\xAC\xF0\x9D\x84\x9E";
  EXPECT_EQ(ToUtf8("\xFF\xFE\x61\x00\xE9\x00\xAC\x20\x34\xD8\x1E\xDD"s), text);
  EXPECT_EQ(ToUtf8("\xFE\xFF\x00\x61\x00\xE9\x20\xAC\xD8\x34\xDD\x1E"s), text);
  EXPECT_EQ(ToUtf8("\xFF\xFE\0\0\x61\0\0\0\xE9\0\0\0\xAC\x20\0\0\x1E\xD1\x01\0"s), text);
  EXPECT_EQ(ToUtf8("\0\0\xFE\xFF\0\0\0\x61\0\0\0\xE9\0\0\x20\xAC\0\x01\xD1\x1E"s), text);
}

TEST(ToUtf8, WhatIsNoCharacterIsReplaced) {
  const std::string replaced = "\xEF\xBF\xBD";
  EXPECT_EQ(ToUtf8("\xFF\xFE\x34\xD8\x61\x00"s), replaced + "a");  // half a pair, then more
  EXPECT_EQ(ToUtf8("\xFF\xFE\x34\xD8"s), replaced);                // at the end
  EXPECT_EQ(ToUtf8("\xFF\xFE\x1E\xDD"s), replaced);                // the other half
  EXPECT_EQ(ToUtf8("\xFF\xFE\x61\x00\x61"s), "a" + replaced);      // an odd byte
  EXPECT_EQ(ToUtf8("\0\0\xFE\xFF\x7F\xFF\xFF\xFF"s), replaced);
}

}  // namespace
}  // namespace elbowroom::cad_import
