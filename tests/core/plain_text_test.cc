#include "core/plain_text.h"

#include <gtest/gtest.h>

#include <string>

namespace elbowroom::core {
namespace {

TEST(PlainText, ControlCharactersAndBytesThatAreNoUtf8AreMadeVisible) {
  EXPECT_EQ(MadeVisible("a\nb\x1b[2J\x7f"), R"(a\x0ab\x1b[2J\x7f)");
  EXPECT_EQ(MadeVisible("M\xFCller"), R"(M\xfcller)");
  EXPECT_EQ(MadeVisible("Müller — 面 😀"), "Müller — 面 😀");
  EXPECT_EQ(MadeVisible("\xC2\x85|\xE2\x80\xA8|\xE2\x80\xAE"), R"(\xc2\x85|\xe2\x80\xa8|\xe2\x80\xae)");
  // Overlong, a surrogate, beyond the last character, cut off.
  for (const std::string bad : {"\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\xF5", "\x80"})
    EXPECT_FALSE(IsPlain(bad)) << MadeVisible(bad);
  EXPECT_TRUE(IsPlain("Größe 14 cm"));
  EXPECT_TRUE(IsPlain(""));
  EXPECT_FALSE(IsPlain(std::string("a\0b", 3)));
}

TEST(PlainText, NamesGetASpaceInstead) {
  EXPECT_EQ(Blanked("two\nlines"), "two lines");
  EXPECT_EQ(Blanked("a\xC2\x85z\xFF"), "a z ");
}

TEST(PlainText, AShortLineStaysWhole) {
  const std::string line(kLongestMessageBytes, 'x');
  EXPECT_EQ(OneLine(line), line);
  EXPECT_EQ(OneLine("a\tb"), "a\\x09b");
}

TEST(PlainText, ALongPathLosesItsMiddleAndTheAdviceStays) {
  const std::string message = "/" + std::string(4000, 'd') + "/rig.yml: no such rig file; check the path";
  const std::string line = OneLine(message);
  EXPECT_LE(line.size(), kLongestMessageBytes);
  EXPECT_TRUE(line.starts_with("/ddd")) << line;
  EXPECT_TRUE(line.ends_with("/rig.yml: no such rig file; check the path")) << line;
  EXPECT_NE(line.find("…"), std::string::npos) << line;
}

TEST(PlainText, ALineOfManyWordsLosesItsMiddle) {
  std::string message = "begin";
  for (int i = 0; i < 500; ++i) message += " word";
  const std::string line = OneLine(message + " the end");
  EXPECT_LE(line.size(), kLongestMessageBytes);
  EXPECT_TRUE(line.starts_with("begin word"));
  EXPECT_TRUE(line.ends_with("word the end"));
}

TEST(PlainText, ACutNeverSplitsACharacter) {
  for (std::size_t length = 80; length < 130; ++length) {
    std::string text(length % 7, 'a');
    while (text.size() < length) text += "é😀";
    EXPECT_TRUE(IsPlain(OneLine(text, 77))) << length;
    EXPECT_LE(OneLine(text, 77).size(), 77U);
  }
  std::string longest;
  longest.resize(20'000'000, '\n');
  EXPECT_LE(OneLine(longest).size(), kLongestMessageBytes);
}

}  // namespace
}  // namespace elbowroom::core
