#include "cad_import/layout/toml_nesting.h"

#include <gtest/gtest.h>

#include <string>

#include "cad_import/layout/toml_entry.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

std::string Repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

std::string ErrorOf(const std::string& text) {
  try {
    (void)ParseToml(text, "a.toml");
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

TEST(TomlNesting, WhatIsDeepIsRefusedBeforeItIsParsed) {
  constexpr int kDeep = 40'000;
  for (const std::string& text :
       {"a = " + Repeated("[", kDeep), "a = " + Repeated("{a=", kDeep), Repeated("a.", kDeep) + "a = 1",
        "[" + Repeated("a.", kDeep) + "a]", "a = " + Repeated("[", kDeep) + Repeated("]", kDeep),
        "a = [ [\n] " + Repeated(",{ b = [\n", kDeep)})
    EXPECT_NE(ErrorOf("x = 1\n" + text).find("nested too deep"), std::string::npos) << text.substr(0, 40);
  EXPECT_TRUE(ErrorOf("x = 1\na = " + Repeated("[", kDeep)).starts_with("a.toml:2: "));
}

TEST(TomlNesting, StringsAndCommentsDontCount) {
  const std::string many = Repeated("[{", 1000), dots = Repeated(".", 1000);
  for (const std::string& text :
       {"a = \"" + many + dots + "\"", "a = '" + many + "\\'", "# " + many + dots + "\na = 1",
        "a = \"\"\"\n" + many + "\n\" \\\"\"\" " + many + "\"\"\"", "a = '''\n" + many + "'' " + many + "'''",
        "a = \"\\\"" + many + "\"", "\"" + dots + "\" = 1", "a = [ 1.5, 2.5 ] # " + many})
    EXPECT_EQ(ErrorOf(text), "") << text.substr(0, 40);
  std::string entries;
  for (int i = 0; i < 1000; ++i) entries += "[[part]]\nat = [0.5, 1.5, { x = 1.0 }]\n";
  EXPECT_EQ(ErrorOf(entries), "");
}

TEST(TomlNesting, ATextThatBreaksOffEnds) {
  for (const char* text : {"a = \"", "a = \"\"\"", "a = '''x''", "a = \"\\", "#", "[", "a = \"b\n", ""})
    EXPECT_NO_THROW(RefuseDeepToml(text, "a.toml")) << text;
}

TEST(TomlEntry, NumbersTextsAndListsHaveBounds) {
  const auto error_of = [](const std::string& text) -> std::string {
    const toml::table table = ParseToml(text, "a.toml");
    const TomlEntry entry(table, "a.toml", "", {"gap_mm", "turn_deg", "k", "name", "tools", "at_mm"});
    try {
      (void)entry.NumberOr("gap_mm", 0.0);
      (void)entry.NumberOr("turn_deg", 0.0);
      (void)entry.NumberOr("k", 0.0);
      (void)entry.TextOr("name", "");
      (void)entry.Texts("tools");
      (void)entry.VectorOrZero("at_mm");
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(error_of("gap_mm = -1e9\nturn_deg = 720\nk = 1e9\nname = \"a\"\ntools = [\"b\"]"), "");
  for (const std::string text : {"gap_mm = 1e300", "gap_mm = -1.1e9", "turn_deg = 1e9", "k = 1e300",
                                 "gap_mm = inf", "k = nan", "at_mm = [0, 0, 1e300]"})
    EXPECT_TRUE(error_of(text).starts_with("a.toml:1: key")) << error_of(text);
  EXPECT_NE(error_of("name = \"" + std::string(5000, 'n') + "\"").find("4096 bytes"), std::string::npos);
  EXPECT_NE(error_of("name = \"a\\u0000b\"").find("null character"), std::string::npos);
  EXPECT_NE(error_of("tools = [" + Repeated("\"t\",", 5000) + "]").find("5000 entries"), std::string::npos);
}

}  // namespace
}  // namespace elbowroom::cad_import
