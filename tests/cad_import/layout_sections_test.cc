// [[section]] entries of a LAYOUT.toml: read, refused, and changed with their comments kept.
#include "cad_import/layout/layout_sections.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/cad_import/error_of.h"

namespace elbowroom::cad_import {
namespace {

using core::ErrorKind;
using testing::ErrorOf;
using testing::Mentions;

constexpr const char* kHandMade = R"(# The bench.
[[part]]
name = "pmt"  # the tube
file = "box.stl"

# Through the thread.
[[section]]  # Jörg's
name = "thread"
normal = [0, -2, 0]  # what is behind stays
offset_mm = -12  # a guess

[[section]]
name = "lid"
normal = [0.6, 0.0, 0.8]
offset_mm = 150.5
on = false  # for now
)";

LayoutText Text(const std::string& text = kHandMade) { return LayoutText(text, "bench/layout.toml"); }

TEST(LayoutSections, AreReadInTheFilesOrder) {
  const std::vector<LayoutSection> sections = SectionsOf(Text());
  ASSERT_EQ(sections.size(), 2U);
  EXPECT_EQ(sections[0], (LayoutSection{"thread", {0, -2, 0}, -12.0, true}));
  EXPECT_EQ(sections[1], (LayoutSection{"lid", {0.6, 0.0, 0.8}, 150.5, false}));
  EXPECT_TRUE(SectionsOf(Text("unit = \"mm\"\n")).empty());
}

TEST(LayoutSections, AChangedNumberAndAChangedNameKeepAllComments) {
  LayoutText text = Text();
  std::vector<LayoutSection> sections = SectionsOf(text);
  sections[0].offset_mm = 20.0;
  sections[0].normal = {0, 2, 0};
  sections[1].name = "cover";
  sections[1].is_on = true;
  ChangeSections(text, sections);
  EXPECT_EQ(SectionsOf(text), sections);
  std::string meant = kHandMade;
  const auto replace = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(meant.find(from), std::string::npos);
    meant.replace(meant.find(from), from.size(), to);
  };
  replace("[0, -2, 0]", "[0, 2, 0]");
  replace("= -12 ", "= 20 ");
  replace("\"lid\"", "\"cover\"");
  replace("on = false", "on = true");
  EXPECT_EQ(text.text(), meant);
}

TEST(LayoutSections, AnyListBecomesAnyOther) {
  LayoutText text = Text();
  const LayoutSection lid = SectionsOf(text)[1];
  const std::vector<LayoutSection> others = {lid, {"new \"one\"", {0.1, 0.2, 0.3}, 1e-3, true}};
  for (const std::vector<LayoutSection>& sections :
       {others, std::vector<LayoutSection>{}, std::vector{others[1], others[0]}, std::vector{lid}}) {
    ChangeSections(text, sections);
    EXPECT_EQ(SectionsOf(text), sections);
    EXPECT_TRUE(text.text().starts_with("# The bench.\n[[part]]\nname = \"pmt\"  # the tube\n"));
  }
  LayoutText empty;
  ChangeSections(empty, others);
  EXPECT_EQ(SectionsOf(empty), others);
}

TEST(LayoutSections, WhatCantBeMetIsToldWithItsLine) {
  struct Case {
    std::string entry, says;
    ErrorKind kind = ErrorKind::kFormat;
  };
  const std::string good = "[[section]]\nname = \"a\"\nnormal = [1, 0, 0]\noffset_mm = 0\n";
  std::string many;
  for (std::size_t i = 0; i <= kMostSections; ++i)
    many += "[[section]]\nname = \"" + std::to_string(i) + "\"\nnormal = [1, 0, 0]\noffset_mm = 0\n";
  for (const Case& one : std::vector<Case>{
           {"[[section]]\nname = \"a\"\noffset_mm = 0\n", ":1: [[section]]: key 'normal' is missing"},
           {"[[section]]\nname = \"a\"\nnormal = [0, 0, 0]\noffset_mm = 0\n",
            ":3: [[section]]: key 'normal' has no", ErrorKind::kRange},
           {"[[section]]\nname = \"a\"\nnormal = [1, nan, 0]\noffset_mm = 0\n", "must be a finite number"},
           {"[[section]]\nname = \"a\"\nnormal = [1, 0]\noffset_mm = 0\n", "must be three numbers"},
           {"[[section]]\nname = \"a\"\nnormal = [1, 0, 0]\n", "key 'offset_mm' is missing"},
           {"[[section]]\nname = \"a\"\nnormal = [1, 0, 0]\noffset_mm = 1e10\n", "must lie between"},
           {good + "ofset_mm = 3\n", "unknown key 'ofset_mm'; did you mean 'offset_mm'?"},
           {good + good, ":6: [[section]]: key 'name' is there twice: 'a'", ErrorKind::kRange},
           {"section = 3\n", "must be written as [[section]]"},
           {many, "at most 32 can be used", ErrorKind::kRange}}) {
    const std::string error = ErrorOf(one.kind, [&] { (void)SectionsOf(Text(one.entry)); });
    EXPECT_TRUE(Mentions(error, one.says)) << error;
    EXPECT_TRUE(error.starts_with("bench/layout.toml:")) << error;
  }
}

// A change that can't be made leaves the text as it was.
TEST(LayoutSections, ARefusedChangeChangesNothing) {
  LayoutText text = Text();
  const std::vector<LayoutSection> twins = {{"a", {1, 0, 0}, 0.0, true}, {"a", {0, 1, 0}, 0.0, true}};
  EXPECT_THROW(ChangeSections(text, twins), core::Error);
  EXPECT_EQ(text.text(), kHandMade);
}

}  // namespace
}  // namespace elbowroom::cad_import
