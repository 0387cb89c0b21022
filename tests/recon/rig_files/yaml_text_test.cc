#include "recon/rig_files/yaml_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

#include "recon/decoding/quiet_opencv.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/support/places.h"
#include "tests/support/text_file.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using testing::ErrorOf;
using ::testing::HasSubstr;

YamlNode Parse(const std::string& body) { return ParseYaml("%YAML:1.0\n---\n" + body, "it"); }

// What is wrong with `body`, which begins in line 3.
std::string WrongWith(const std::string& body) {
  return ErrorOf(ErrorKind::kFormat, [&] { (void)Parse(body); });
}

TEST(YamlText, ScalarsAreWhatTheyLookLike) {
  const YamlNode map = Parse(
      "a: 5\nb: -5.25\nc: 1e3\nd: .Inf\ne: -.inf\nf: .Nan\ng: word or two # said\nh: \"5\"\ni: 'it''s'\n"
      "j: \"say \\\"hi\\\" \\\\ \\x41\"\nk: 5000000000\nl: 1.\nm: .5\nn: rtsp://host/a\no:\np: +7\nq: "
      "1e999\nr: !!str 5\n");
  EXPECT_EQ(map.Find("a")->kind, YamlKind::kInteger);
  EXPECT_EQ(map.Find("a")->line, 3);
  EXPECT_EQ(map.Find("b")->number, -5.25);
  EXPECT_EQ(map.Find("c")->kind, YamlKind::kReal);
  EXPECT_EQ(map.Find("d")->number, HUGE_VAL);
  EXPECT_EQ(map.Find("e")->number, -HUGE_VAL);
  EXPECT_TRUE(std::isnan(map.Find("f")->number));
  EXPECT_EQ(map.Find("g")->text, "word or two");
  EXPECT_EQ(map.Find("h")->kind, YamlKind::kText);
  EXPECT_EQ(map.Find("i")->text, "it's");
  EXPECT_EQ(map.Find("j")->text, "say \"hi\" \\ A");
  EXPECT_EQ(map.Find("k")->kind, YamlKind::kReal) << "no int holds it";
  EXPECT_EQ(map.Find("l")->number, 1.0);
  EXPECT_EQ(map.Find("m")->number, 0.5);
  EXPECT_EQ(map.Find("n")->text, "rtsp://host/a");
  EXPECT_EQ(map.Find("o")->kind, YamlKind::kNothing);
  EXPECT_EQ(map.Find("p")->number, 7.0);
  EXPECT_EQ(map.Find("q")->number, HUGE_VAL);
  EXPECT_EQ(map.Find("r")->kind, YamlKind::kText);
  EXPECT_EQ(map.Find("z"), nullptr);
}

TEST(YamlText, ListsAndMapsNestInBlocksAndInFlow) {
  const YamlNode map = Parse(
      "# a comment\r\nrows: [ [ 1, 2 ],\r\n   [ 3, 4 ] ]\r\ncameras:\n   -\n      name: \"one\"\n      n: 1\n"
      "   - name: two\n     n: 2\n   - { name: \"three\", n: 3, list: [] }\n   - 4\nmatrix: !!opencv-matrix\n"
      "   rows: 1\n   data: [ 1.,\n       2. ]\nsame:\n- 1\n- 2\nend: 1\n...\nanything");
  EXPECT_EQ(map.keys, (std::vector<std::string>{"rows", "cameras", "matrix", "same", "end"}));
  EXPECT_EQ(map.Find("rows")->items[1].items[0].number, 3.0);
  const YamlNode& cameras = *map.Find("cameras");
  ASSERT_EQ(cameras.items.size(), 4U);
  for (const std::size_t i : {0U, 1U, 2U})
    EXPECT_EQ(cameras.items[i].Find("n")->number, static_cast<double>(i + 1));
  EXPECT_EQ(cameras.items[1].Find("name")->text, "two");
  EXPECT_EQ(map.Find("matrix")->Find("data")->items.size(), 2U);
  EXPECT_EQ(map.Find("same")->items.size(), 2U);
  const YamlNode tagged = Parse(
      "cameras:\n  - { k: !!opencv-matrix { rows: 1, data: [ 5 ] },\n      name: 'a, b', url: rtsp://h/a "
      "}\n");
  const YamlNode& camera = tagged.Find("cameras")->items.front();
  EXPECT_EQ(camera.Find("k")->Find("data")->items.front().number, 5.0);
  EXPECT_EQ(camera.Find("name")->text, "a, b");
  EXPECT_EQ(camera.Find("url")->text, "rtsp://h/a");
}

TEST(YamlText, WhatIsWrongIsToldWithItsLine) {
  EXPECT_THAT(WrongWith("a: 1\nb: [ 1, 2\nc: 3\n"), HasSubstr("it, line 5"));
  EXPECT_THAT(WrongWith("a: 1\na: 2\n"), HasSubstr("line 4: key 'a' occurs twice"));
  EXPECT_THAT(WrongWith("a: 1\n\tb: 2\n"), HasSubstr("line 4: a tab"));
  EXPECT_THAT(WrongWith("a: \"open\nb: 1\n"), HasSubstr("line 3: a quote"));
  EXPECT_THAT(WrongWith("a: 1\n  b: 2\n"), HasSubstr("line 4"));
  EXPECT_THAT(WrongWith("a: { b 1 }\n"), HasSubstr("a key and a colon"));
  EXPECT_THAT(WrongWith("a: &anchor 1\n"), HasSubstr("'&'"));
  EXPECT_THAT(WrongWith("a: !!binary |\n"), HasSubstr("binary"));
  EXPECT_THAT(WrongWith("a: \xFF\n"), HasSubstr("line 3: characters that are no text"));
  EXPECT_THAT(WrongWith(std::string("a: \0\n", 5)), HasSubstr("characters"));
  for (const std::string none : {"", "# nothing\n", "- 1\n- 2\n", "5\n", "words\n"})
    EXPECT_THAT(WrongWith(none), HasSubstr("is not an OpenCV YAML file"));
  for (const std::string other : {"", "a: 1\n", "{\"a\": 1}", "<?xml version=\"1.0\"?>", "RIFF\1\2\3\4AVI "})
    EXPECT_THAT(ErrorOf(ErrorKind::kFormat, [&] { (void)ParseYaml(other, "it"); }), HasSubstr("%YAML:1.0"));
}

TEST(YamlText, DepthAndNumberAreBounded) {
  constexpr int kDeep = 40'000;
  for (const std::string nested : {"[", "{ a: ", "- ", "a: "}) {
    std::string body = "a: ";
    for (int i = 0; i < kDeep; ++i) body += nested;
    EXPECT_THAT(WrongWith(body), HasSubstr("nested more than 64 deep"));
    std::string lines = "a:\n";
    for (int i = 1; i < 2000; ++i)
      lines += std::string(static_cast<std::size_t>(i), ' ') + (nested == "- " ? "-\n" : "a:\n");
    EXPECT_THAT(WrongWith(lines), HasSubstr("nested more than 64 deep"));
  }
  std::string many = "a: [ 0";
  for (int i = 0; i < 300'000; ++i) many += ",0";
  EXPECT_THAT(WrongWith(many + " ]\n"), HasSubstr("more than 200000 values"));
}

void ExpectSameValue(const YamlNode& ours, const cv::FileNode& theirs) {
  if (theirs.isInt()) {
    EXPECT_EQ(ours.kind, YamlKind::kInteger);
    EXPECT_EQ(ours.number, static_cast<int>(theirs));
  } else if (theirs.isReal()) {
    EXPECT_EQ(ours.number, static_cast<double>(theirs));
  } else if (theirs.isString()) {
    EXPECT_EQ(ours.text, static_cast<std::string>(theirs));
  }
}

// Bit by bit what OpenCV reads, as far as both have names for it.
void ExpectSame(const YamlNode& ours, const cv::FileNode& theirs, const std::string& where) {
  SCOPED_TRACE(where);
  if (theirs.isMap()) {
    ASSERT_EQ(ours.kind, YamlKind::kMap);
    for (const std::string& key : theirs.keys()) {
      ASSERT_NE(ours.Find(key), nullptr) << key;
      ExpectSame(*ours.Find(key), theirs[key], where + "/" + key);
    }
  } else if (theirs.isSeq()) {
    ASSERT_EQ(ours.items.size(), theirs.size());
    for (int i = 0; i < static_cast<int>(theirs.size()); ++i)
      ExpectSame(ours.items[static_cast<std::size_t>(i)], theirs[i], where + "/" + std::to_string(i));
  } else {
    ExpectSameValue(ours, theirs);
  }
}

TEST(YamlText, ReadsFilesOfOthersAsOpenCvDoes) {
  const std::filesystem::path folder = test_support::SharedDataFolder();
  if (!std::filesystem::is_directory(folder))
    GTEST_SKIP() << "NOT TESTED: " << folder << " is not on this machine";
  SilenceOpenCv();
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    if (extension != ".yml" && extension != ".yaml") continue;
    const std::string text = test_support::ReadText(entry.path());
    if (!text.starts_with("%YAML")) continue;
    const cv::FileStorage storage(entry.path().string(), cv::FileStorage::READ);
    ExpectSame(ParseYaml(text, entry.path().string()), storage.root(), entry.path().string());
    ++files;
  }
  EXPECT_GT(files, 5);
}

}  // namespace
}  // namespace elbowroom::recon
