// A list of parts with long names: each can be read, whatever the list's width.
#include <gtest/gtest.h>

#include <QStandardItemModel>

#include "app/console/view/listing.h"
#include "app/console/view/name_delegate.h"
#include "tests/app/console/looks/fit_check.h"

namespace elbowroom::console {
namespace {

constexpr const char* kNames[] = {"a", "rod-assembly_1", "radiator/starboard.frame_of_the_bracket",
                                  "Bracketholderwithoutanyseparator"};

class NamedList : public testing::Test {
 protected:
  NamedList() {
    for (const char* name : kNames) model_.appendRow({new QStandardItem(name), new QStandardItem("10,688")});
    model_.setHorizontalHeaderLabels({"Part", "Points"});
    list_.resize(400, 300);
  }
  void ExpectAllFit() {
    AwaitLayout();
    for (const QString& line : FaultsOfFit(window_)) ADD_FAILURE() << line.toStdString();
  }

  QStandardItemModel model_{0, 2};
  QWidget window_;
  Listing& list_ = *new Listing(&model_, "none", 0, &window_);
};

TEST_F(NamedList, WrapsNamesThatNeedMoreThanTheirColumn) {
  window_.show();
  ExpectAllFit();
  const int wide_px = list_.rowHeight(3);
  EXPECT_EQ(list_.rowHeight(0), wide_px);
  list_.resize(170, 300);
  ExpectAllFit();
  EXPECT_EQ(list_.rowHeight(0), wide_px);
  EXPECT_GT(list_.rowHeight(2), wide_px);
  EXPECT_GT(list_.rowHeight(3), wide_px);
  list_.resize(400, 300);
  ExpectAllFit();
  EXPECT_EQ(list_.rowHeight(3), wide_px);
}

TEST_F(NamedList, FitsANameThatChangesAndOneThatComes) {
  list_.resize(170, 300);
  window_.show();
  ExpectAllFit();
  model_.item(0)->setText(kNames[2]);
  model_.appendRow({new QStandardItem(kNames[3]), new QStandardItem("7")});
  ExpectAllFit();
  EXPECT_EQ(list_.rowHeight(0), list_.rowHeight(2));
  EXPECT_EQ(list_.rowHeight(4), list_.rowHeight(3));
}

TEST_F(NamedList, GivesTheNamesTheRoomThatOtherColumnsNoLongerNeed) {
  for (int row = 0; row < model_.rowCount(); ++row)
    model_.item(row, 1)->setText("10,688,000,000,000,000,000");
  list_.resize(265, 300);
  window_.show();
  ExpectAllFit();
  const int wrapped_px = list_.rowHeight(1);
  EXPECT_GT(wrapped_px, list_.rowHeight(0));
  model_.removeRows(2, 2);
  for (int row = 0; row < model_.rowCount(); ++row) model_.item(row, 1)->setText("7");
  ExpectAllFit();
  EXPECT_EQ(list_.rowHeight(1), list_.rowHeight(0));
}

TEST(WithLineEnds, ChangesNoLetter) {
  const QString signs = QString("🔩").repeated(8);
  for (const QString& name : {QString("rod-assembly_1"), QString("Bracketholderwithout"), signs})
    EXPECT_EQ(WithLineEnds(name).remove(QChar(0x200B)), name);
  EXPECT_EQ(WithLineEnds("payload"), "payload");
  EXPECT_EQ(WithLineEnds("a_b").count(QChar(0x200B)), 1);
  // Between signs of two halves, and not in them.
  EXPECT_TRUE(WithLineEnds(signs).contains(QChar(0x200B)));
  EXPECT_FALSE(WithLineEnds(signs).contains(QString(QChar(0xD83D)) + QChar(0x200B)));
}

}  // namespace
}  // namespace elbowroom::console
