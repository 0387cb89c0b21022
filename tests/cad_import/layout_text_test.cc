// LAYOUT.toml changed in place: what is meant arrives, what isn't meant stays.
#include "cad_import/layout/layout_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cad_import/layout/layout_change.h"
#include "cad_import/layout/layout_file.h"
#include "core/error.h"
#include "core/layout_fault.h"
#include "tests/cad_import/error_of.h"
#include "tests/cad_import/sample_files.h"
#include "tests/core/solids.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::cad_import {
namespace {

using core::ErrorKind;
using testing::ErrorOf;
using testing::Mentions;

// As people write: comments everywhere, odd spacing, lists over lines, umlauts, whole numbers.
constexpr const char* kHandMade = R"(# The bench, March.
# Ask Jörg before you change it.
unit = "mm"  # of what says nothing

# The tube's box.
[[part]]   # first
name = "pmt ö"  # ö is fine
file = 'box.stl'
position_mm = [10,  # along the bench
   20.5,
   -30 ]  # up
# turned once

# Free-standing remark.

[[part]]
  name = "payload"
  file = "box.stl"
  unit = "cm"
[[part]]
name = "lid"
file = "box.stl"

[[group]]
name = "upper"
parts = ["payload", "lid"]

[[spacing]]
name = "gap"
initial_mm = 140 # a guess
moving = "payload"
reference = "pmt ö"
axis = "z"
min_mm = 100
max_mm = 300.5

# They may touch.
[[pair]]
a = "payload"
b = "lid"
authorised_contact = true
# The last line has no end.)";

std::vector<std::string> CommentLinesOf(const std::string& text) {
  std::vector<std::string> comments;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with('#')) comments.push_back(line);
  return comments;
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  EXPECT_NE(text.find(from), std::string::npos) << from;
  return text.replace(text.find(from), from.size(), to);
}

class LayoutTextTest : public ::testing::Test {
 protected:
  void SetUp() override {
    test_support::WriteText(folder_ / "box.stl", testing::StlText(core::testing::Box({100, 200, 300})));
  }
  [[nodiscard]] LayoutText Text(const std::string& text = kHandMade) const {
    return LayoutText(text, folder_ / "LAYOUT.toml");
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(LayoutTextTest, AValueIsReplacedWhereItStands) {
  LayoutText text = Text();
  text.Set("spacing", 0, {"initial_mm", 240.0});
  EXPECT_EQ(text.text(), Replaced(kHandMade, "initial_mm = 140 # a", "initial_mm = 240 # a"));
  text.Set("spacing", 0, {"initial_mm", 140.0});
  EXPECT_EQ(text.text(), kHandMade);
  text.Set("part", 0, {"position_mm", Eigen::Vector3d(10, 0.1, -30)});
  EXPECT_EQ(text.text(), Replaced(kHandMade, "20.5", "0.1"));
  text = Text();
  text.Set("part", 0, {"name", std::string("a \"b\" \\ \t")});
  EXPECT_EQ(text.text(), Replaced(kHandMade, "\"pmt ö\"  #", "\"a \\\"b\\\" \\\\ \\u0009\"  #"));
  EXPECT_EQ(text.TextsOf("part", 0, "name"), std::vector<std::string>{"a \"b\" \\ \t"});
}

TEST_F(LayoutTextTest, AKeyThatIsNewStandsWhereReadersLookForIt) {
  LayoutText text = Text();
  text.Set("part", 1, {"position_mm", Eigen::Vector3d(1, 2, 3)});
  EXPECT_EQ(text.text(),
            Replaced(kHandMade, "  unit = \"cm\"\n", "  unit = \"cm\"\n  position_mm = [1.0, 2.0, 3.0]\n"));
  text.Unset("part", 1, "position_mm");
  EXPECT_EQ(text.text(), kHandMade);
  text.Set("part", 1, {"node", std::string("a/b")});
  EXPECT_EQ(text.text(), Replaced(kHandMade, "file = \"box.stl\"\n  unit",
                                  "file = \"box.stl\"\n  node = \"a/b\"\n  unit"));
}

TEST_F(LayoutTextTest, AnEntryGoesWithItsOwnCommentsAlone) {
  LayoutText text = Text();
  text.Remove("part", 0);
  const std::string& left = text.text();
  for (const char* gone : {"The tube's box", "turned once", "along the bench"})
    EXPECT_FALSE(Mentions(left, gone)) << gone;
  for (const char* kept : {"# The bench, March.", "Free-standing remark", "They may touch", "no end."})
    EXPECT_TRUE(Mentions(left, kept)) << kept;
  text.Remove("pair", 0);
  EXPECT_TRUE(text.text().ends_with("max_mm = 300.5\n"));
  EXPECT_EQ(text.Count("pair"), 0U);
}

TEST_F(LayoutTextTest, WhatIsAppendedStandsWithItsKind) {
  LayoutText text = Text();
  text.Append("spacing", {{"name", std::string("side")}});
  text.Append("stream", {{"name", std::string("tap")}});
  EXPECT_TRUE(Mentions(text.text(), "max_mm = 300.5\n\n[[spacing]]\nname = \"side\"\n\n# They may touch."));
  EXPECT_TRUE(text.text().ends_with("no end.\n\n[[stream]]\nname = \"tap\"\n"));
  EXPECT_EQ(text.LineOf("part", 1), 16);
}

TEST_F(LayoutTextTest, AUnitIsAddedBelowTheFilesOwnComment) {
  LayoutText text = Text("# mine\n[[part]]\nname = \"a\"\n");
  text.SetUnit(core::LengthUnit::kInch);
  EXPECT_EQ(text.text(), "# mine\nunit = \"in\"\n\n[[part]]\nname = \"a\"\n");
  text.SetUnit(core::LengthUnit::kMetre);
  EXPECT_EQ(text.text(), "# mine\nunit = \"m\"\n\n[[part]]\nname = \"a\"\n");
}

TEST_F(LayoutTextTest, WindowsLinesAndByteOrderMarksStay) {
  LayoutText text = Text("\xEF\xBB\xBFunit = \"mm\"\r\n\r\n[[part]]\r\nname = \"ä\" # n\r\n");
  text.SetUnit(core::LengthUnit::kMetre);
  text.Set("part", 0, {"name", std::string("b")});
  text.Set("part", 0, {"file", std::string("c")});
  EXPECT_EQ(text.text(), "\xEF\xBB\xBFunit = \"m\"\r\n\r\n[[part]]\r\nname = \"b\" # n\r\nfile = \"c\"\r\n");
}

TEST_F(LayoutTextTest, WhatCantBeChangedInPlaceSaysWhichLine) {
  LayoutText text = Text("unit = \"mm\"\npart = [ { name = \"a\" },\n  { name = \"b\" } ]\n");
  const std::string before = text.text();
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kFormat,
                               [&] {
                                 text.Set("part", 1, {"name", std::string("c")});
                               }),
                       "LAYOUT.toml:3: isn't written as [[part]]"));
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kFormat,
                               [&] {
                                 text.Append("part", {{"name", std::string("c")}});
                               }),
                       "LAYOUT.toml:3: isn't written as [[part]]"));
  EXPECT_EQ(text.text(), before);
  text = Text("\n[part]\nname = \"a\"\n");
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kFormat,
                               [&] {
                                 text.Append("part", {{"name", std::string("c")}});
                               }),
                       "LAYOUT.toml:2: 'part' isn't written as [[part]]"));
  EXPECT_THROW(text.Remove("spacing", 0), core::PreconditionError);
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kFormat, [&] { (void)Text("a = 1\na = = 2\n"); }), ":2: not TOML"));
}

// Random edits of a layout: any part, group, spacing or pair changed, added, removed or put elsewhere.
class RandomEditor {
 public:
  explicit RandomEditor(unsigned seed) : random_(seed) {}

  void Change(core::Layout& layout) {
    switch (Below(9)) {
      case 0:
        return AddPart(layout);
      case 1:
        return RemovePart(layout);
      case 2:
        return MovePart(layout);
      case 3:
        return std::ranges::shuffle(layout.parts, random_), void();
      case 4:
        return ChangeSpacing(layout);
      case 5:
        return ChangePairs(layout);
      case 6:
        return ChangeGroups(layout);
      case 7:
        return ChangeWays(layout);
      default:
        layout.unit = static_cast<core::LengthUnit>(Below(4));
    }
  }
  std::size_t Below(std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_);
  }

 private:
  double Length() { return std::uniform_real_distribution<double>(-1000, 1000)(random_); }
  core::Part& AnyPart(core::Layout& layout) { return layout.parts[Below(layout.parts.size())]; }

  void AddPart(core::Layout& layout) {
    core::Part part = AnyPart(layout);
    part.name = "new " + std::to_string(++added_);
    layout.parts.insert(layout.parts.begin() + static_cast<std::ptrdiff_t>(Below(layout.parts.size() + 1)),
                        part);
  }
  void RemovePart(core::Layout& layout) {
    const std::string name = AnyPart(layout).name;
    const auto is_named = [&](const core::Layout& in) {
      return in.parts.size() < 2 ||
             std::ranges::any_of(in.spacings,
                                 [&](const auto& s) { return s.moving == name || s.reference == name; }) ||
             std::ranges::any_of(in.pair_rules, [&](const auto& p) { return p.a == name || p.b == name; }) ||
             std::ranges::any_of(in.groups,
                                 [&](const auto& g) { return std::ranges::count(g.parts, name) > 0; });
    };
    if (!is_named(layout)) std::erase_if(layout.parts, [&](const auto& part) { return part.name == name; });
  }
  void MovePart(core::Layout& layout) {
    AnyPart(layout).world_from_part = core::FromPositionAndRollPitchYaw(
        {Length(), std::round(Length()), 0.0}, {0.0, 0.0, 90.0 * static_cast<double>(Below(4))});
  }
  void ChangeSpacing(core::Layout& layout) {
    if (layout.spacings.empty() || Below(4) == 0) {
      layout.spacings.clear();
      layout.spacings.push_back({"gap " + std::to_string(++added_), layout.parts.front().name,
                                 layout.parts.back().name, core::Axis::kX, -5, 500, 7.5});
      if (layout.parts.size() < 2) layout.spacings.clear();
      return;
    }
    layout.spacings[0].max_mm = 300.0 + std::abs(Length());
    layout.spacings[0].initial_mm = 100.0 + static_cast<double>(Below(200));
  }
  void ChangePairs(core::Layout& layout) {
    if (!layout.pair_rules.empty() && Below(2) == 0)
      layout.pair_rules.erase(layout.pair_rules.begin());
    else
      layout.pair_rules.push_back(
          {AnyPart(layout).name, AnyPart(layout).name, std::abs(Length()), Below(2) == 0, Below(3) == 0});
  }
  void ChangeGroups(core::Layout& layout) {
    if (!layout.groups.empty() && Below(2) == 0) {
      layout.groups.pop_back();
      return;
    }
    layout.groups.push_back({"group " + std::to_string(++added_), {AnyPart(layout).name}});
  }
  void ChangeWays(core::Layout& layout) {
    core::Part& part = AnyPart(layout);
    part.recovery = {};
    part.gives_way = {};
    if (Below(2) == 0) part.recovery.kind = core::RecoveryKind::kSlider;
    if (Below(2) == 0) part.gives_way = core::PushRule{.max_speed_mm_per_s = 80.0};
    if (part.recovery.kind == core::RecoveryKind::kSlider)
      part.recovery.axis_in_part = Eigen::Vector3d(0, 1, 0);
  }

  std::mt19937 random_;
  int added_ = 0;
};

// Equal but for the rounding of angles to degrees and back, and meshes of other reads.
void ExpectSame(const core::Layout& is, const core::Layout& meant) {
  for (const std::string_view kind : kEntryKinds) {
    std::vector<Fields> a = FieldsOf(is, kind), b = FieldsOf(meant, kind);
    ASSERT_EQ(a.size(), b.size()) << kind;
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(a[i] == b[i]) << kind << " " << i;
  }
  EXPECT_EQ(is.unit, meant.unit);
  for (std::size_t i = 0; i < is.parts.size(); ++i) EXPECT_EQ(*is.parts[i].mesh, *meant.parts[i].mesh) << i;
}

TEST_F(LayoutTextTest, AnySequenceOfEditsGivesTheLayoutThatWasMeantAndKeepsItsComments) {
  const int sequences = 8 * test_support::SoakScale();
  constexpr int kEdits = 25;
  const core::Layout hand_made = ImportLayoutText(Text()).layout;
  for (int seed = 0; seed < sequences; ++seed) {
    RandomEditor editor(static_cast<unsigned>(seed));
    LayoutText text = Text();
    core::Layout layout = hand_made;
    std::set<std::string> removed;
    for (int edit = 0; edit < kEdits; ++edit) {
      core::Layout next = layout;
      editor.Change(next);
      if (core::FindLayoutFault(next)) continue;
      if (!next.FindPart("pmt ö")) removed.insert({"# The tube's box.", "# turned once"});
      const auto has_pair = [](const core::PairRule& rule) { return rule.a == "payload" && rule.b == "lid"; };
      if (std::ranges::none_of(next.pair_rules, has_pair))
        removed.insert({"# They may touch.", "# The last line has no end."});
      ASSERT_NO_THROW(ChangeInto(text, layout, next)) << "seed " << seed << "\n" << text.text();
      layout = std::move(next);
    }
    ExpectSame(ImportLayoutText(text).layout, layout);
    for (const std::string& comment : CommentLinesOf(kHandMade)) {
      EXPECT_TRUE(removed.contains(comment) || Mentions(text.text(), comment)) << comment;
    }
    ASSERT_FALSE(HasFailure()) << "seed " << seed << "\n" << text.text();
  }
}

TEST_F(LayoutTextTest, SavingOntoAFileKeepsWhatItsAuthorWrote) {
  const auto path = folder_ / "LAYOUT.toml";
  test_support::WriteText(path, kHandMade);
  core::Layout layout = ImportLayoutFile(path).layout;
  WriteLayoutFile(layout, path);
  EXPECT_EQ(test_support::ReadText(path), kHandMade);
  layout.spacings[0].initial_mm = 240.0;
  WriteLayoutFile(layout, path);
  EXPECT_EQ(test_support::ReadText(path), Replaced(kHandMade, "= 140 #", "= 240 #"));
  test_support::WriteText(path, "this is a diary\n");
  (void)ErrorOf(ErrorKind::kFormat, [&] { WriteLayoutFile(layout, path); });
  EXPECT_EQ(test_support::ReadText(path), "this is a diary\n");
}

}  // namespace
}  // namespace elbowroom::cad_import
