// The layout page, worked as a user does: by mouse and keys, on Qt's offscreen platform.
#include "app/console/layouts/layout_page.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QListWidget>
#include <QMenu>
#include <QMouseEvent>
#include <QRadioButton>
#include <QSignalSpy>
#include <QTableWidget>
#include <QToolButton>
#include <array>
#include <cmath>

#include "app/console/layouts/import_dialog.h"
#include "app/console/layouts/measured_points.h"
#include "app/console/layouts/rule_dialogs.h"
#include "app/console/layouts/trial_dialog.h"
#include "app/control/layout_editing/autosave.h"
#include "cad_import/layout/layout_file.h"
#include "tests/app/console/user_actions.h"
#include "tests/app/layouts/box_file.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::console {
namespace {

using test_support::ReadText;
using test_support::WriteBox;
using test_support::WriteText;

constexpr const char* kLayout = R"(# Measured on Monday.
[[part]]
name = "box"
file = "box.glb"

[[part]]
name = "lid"
file = "lid.glb"
position_mm = [0.0, 0.0, 200.0]
)";

const std::filesystem::path kAssembly =
    test_support::SharedDataFolder() / "cad/step/ap203_ap214/as1-oc-214.stp";

class LayoutPageTest : public testing::Test {
 protected:
  LayoutPageTest() : file_(folder_ / "layout.toml") {
    WriteBox(folder_ / "box.glb", {100.0, 80.0, 60.0});
    WriteBox(folder_ / "lid.glb", {100.0, 80.0, 10.0});
    WriteText(file_, kLayout);
    page_ = std::make_unique<LayoutPage>();
    page_->resize(1200, 650);
    page_->show();
    QObject::connect(page_.get(), &LayoutPage::Failed, page_.get(),
                     [this](const QString& line) { fault_ = line; });
  }
  ~LayoutPageTest() override {
    page_->desk().DiscardRecovery();
    page_->desk().Forget();  // what a test leaves behind isn't for the next
  }

  template <typename Widget>
  Widget* Find(const QString& name) {
    auto* widget = page_->findChild<Widget*>(name);
    EXPECT_NE(widget, nullptr) << name.toStdString();
    return widget;
  }
  [[nodiscard]] const core::Layout& layout() const { return page_->desk().document().layout(); }
  void OpenLayout() {
    page_->Open(file_);
    ASSERT_TRUE(WaitUntil([&] { return layout().parts.size() == 2; })) << fault_.toStdString();
  }
  // As a program that ended before it saved.
  void LeaveOnePart() {
    control::LayoutDocument document = control::LayoutDocument::Open(file_);
    document.Apply("Change", [](cad_import::LayoutText& text) { text.Remove("part", 1); });
    document.Autosave();
  }
  ImportDialog* OpenImport(const std::filesystem::path& file) {
    page_->Import(file);
    auto* dialog = Find<ImportDialog>("import_dialog");
    EXPECT_TRUE(WaitUntil([&] { return !dialog->is_reading(); }));
    return dialog;
  }
  double HeightOf(const std::string& part) {
    return core::PosesAt(layout(), layout().InitialSpacings())[*layout().FindPart(part)].translation_mm.z();
  }
  QPoint InView(const std::string& part) {
    const core::PartIndex i = *layout().FindPart(part);
    const core::RigidTransform pose = core::PosesAt(layout(), layout().InitialSpacings())[i];
    return page_->view().PositionOf(core::BoundsOf(*layout().parts[i].mesh, pose).center()).value().toPoint();
  }

  test_support::TemporaryFolder folder_;
  std::filesystem::path file_;
  std::unique_ptr<LayoutPage> page_;
  QString fault_;
};

TEST_F(LayoutPageTest, PartsOfAnAssemblyAreTakenByTicking) {
  ImportDialog* dialog = OpenImport(kAssembly);
  ASSERT_TRUE(dialog->preview());
  auto* take = Find<QPushButton>("import_take");
  EXPECT_FALSE(take->isEnabled());  // nothing is ticked
  auto* tree = Find<QTreeWidget>("import_tree");
  ASSERT_TRUE(TickItem(tree, "plate_1")) << dialog->preview()->nodes.size();
  ASSERT_TRUE(TickItem(tree, "rod-assembly_1"));
  EXPECT_EQ(dialog->TickedNodes().size(), 2U);
  EXPECT_TRUE(take->isEnabled());
  Click(take);
  ASSERT_EQ(layout().parts.size(), 2U) << fault_.toStdString();
  EXPECT_EQ(Find<QTreeWidget>("parts")->topLevelItemCount(), 2);
  EXPECT_TRUE(page_->desk().document().is_changed());
}

// A body must not be in two parts: what is above and below a ticked node loses its tick.
TEST_F(LayoutPageTest, ATickTakesTheTicksAboveAndBelowAway) {
  ImportDialog* dialog = OpenImport(kAssembly);
  auto* tree = Find<QTreeWidget>("import_tree");
  ASSERT_TRUE(TickItem(tree, "plate_1"));
  ASSERT_TRUE(TickItem(tree, "as1-oc-214.stp"));  // all of the file
  EXPECT_EQ(dialog->TickedNodes(), std::vector<std::string>{""});
  ASSERT_TRUE(TickItem(tree, "plate_1"));
  ASSERT_EQ(dialog->TickedNodes().size(), 1U);
  EXPECT_TRUE(dialog->TickedNodes().front().ends_with("plate_1"));
  dialog->reject();
}

TEST_F(LayoutPageTest, AFileWithoutAUnitAsksForIt) {
  WriteBox(folder_ / "eight.stl", {8.0, 4.0, 2.0});
  OpenImport(folder_ / "eight.stl");
  EXPECT_TRUE(Find<QGroupBox>("import_units")->isVisible());
  auto* inch = Find<QRadioButton>("import_unit:in");
  EXPECT_TRUE(inch->isChecked());  // the likely one
  EXPECT_TRUE(inch->text().contains("203.2")) << inch->text().toStdString();
  Click(Find<QRadioButton>("import_unit:cm"));
  Find<QRadioButton>("import_unit:cm")->setChecked(true);
  Click(Find<QPushButton>("import_take"));
  ASSERT_TRUE(WaitUntil([&] { return layout().parts.size() == 1; })) << fault_.toStdString();
  EXPECT_EQ(layout().parts[0].unit, core::LengthUnit::kCentimetre);
  EXPECT_NEAR(core::BoundsOf(*layout().parts[0].mesh).sizes().x(), 80.0, 1e-4);
}

TEST_F(LayoutPageTest, AFileThatCannotBeReadIsOneLineInTheDialog) {
  WriteText(folder_ / "bad.stl", "nonsense");
  OpenImport(folder_ / "bad.stl");
  EXPECT_TRUE(Find<QLabel>("import_headline")->text().contains("bad.stl"));
  EXPECT_FALSE(Find<QPushButton>("import_take")->isEnabled());
  Click(Find<QPushButton>("import_cancel"));
  EXPECT_TRUE(layout().parts.empty());
}

TEST_F(LayoutPageTest, AClickChoosesAPartAndCtrlClickASecond) {
  OpenLayout();
  ASSERT_TRUE(WaitUntil([&] { return page_->view().CanPick(); }));
  QTest::mouseClick(&page_->view(), Qt::LeftButton, {}, InView("box"));
  EXPECT_EQ(page_->chosen(), QStringList{"box"});
  QTest::mouseClick(&page_->view(), Qt::LeftButton, Qt::ControlModifier, InView("lid"));
  EXPECT_EQ(page_->chosen(), (QStringList{"box", "lid"}));
  EXPECT_TRUE(Find<QPushButton>("add_spacing")->isEnabled());
  QTest::mouseClick(&page_->view(), Qt::LeftButton, {}, QPoint(3, 3));  // beside all
  EXPECT_TRUE(page_->chosen().isEmpty());
  EXPECT_FALSE(Find<QPushButton>("add_spacing")->isEnabled());
}

TEST_F(LayoutPageTest, NumbersMoveThePartAndKeysTakeThatBack) {
  OpenLayout();
  page_->Choose({"lid"});
  auto* z = Find<QDoubleSpinBox>("part_position:z");
  EXPECT_DOUBLE_EQ(z->value(), 200.0);
  TypeInto(z, "250");
  EXPECT_DOUBLE_EQ(HeightOf("lid"), 250.0);
  QTest::keyClick(z, Qt::Key_Up);  // by the step, 10 mm: the same step back
  EXPECT_DOUBLE_EQ(HeightOf("lid"), 260.0);
  TypeInto(Find<QDoubleSpinBox>("part_rotation:yaw"), "90");
  EXPECT_NEAR(layout().parts[1].world_from_part.rotation(0, 1), -1.0, 1e-12);
  QTest::keyClick(z, Qt::Key_Z, Qt::ControlModifier);  // also while a number has the focus
  EXPECT_EQ(layout().parts[1].world_from_part.rotation, Eigen::Matrix3d::Identity());
  QTest::keyClick(&page_->view(), Qt::Key_Z, Qt::ControlModifier);
  EXPECT_DOUBLE_EQ(HeightOf("lid"), 200.0);
  QTest::keyClick(&page_->view(), Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_DOUBLE_EQ(HeightOf("lid"), 260.0);
}

TEST_F(LayoutPageTest, SpacingAndPairRuleOfTwoChosenPartsAreMadeChangedAndRemoved) {
  OpenLayout();
  page_->Choose({"box", "lid"});
  Click(Find<QPushButton>("add_spacing"));
  auto* spacing = Find<SpacingDialog>("spacing_dialog");
  EXPECT_DOUBLE_EQ(spacing->findChild<QDoubleSpinBox*>("spacing_initial")->value(), 140.0);
  TypeInto(spacing->findChild<QDoubleSpinBox*>("spacing_max"), "100");  // below where it starts
  Click(spacing->findChild<QPushButton*>("rule_ok"));
  EXPECT_TRUE(spacing->findChild<QLabel*>("rule_fault")->isVisible());
  EXPECT_TRUE(layout().spacings.empty());
  TypeInto(spacing->findChild<QDoubleSpinBox*>("spacing_max"), "300");
  Click(spacing->findChild<QPushButton*>("rule_ok"));
  ASSERT_EQ(layout().spacings.size(), 1U);
  EXPECT_NEAR(HeightOf("lid"), 200.0, 1e-3);  // a gap is proposed to a micrometre
  EXPECT_FALSE(Find<QDoubleSpinBox>("part_position:z")->isEnabled() && page_->chosen()[0] == "lid");

  Click(Find<QPushButton>("add_pair"));
  auto* pair = Find<PairDialog>("pair_dialog");
  TypeInto(pair->findChild<QDoubleSpinBox*>("pair_clearance"), "12.5");
  Click(pair->findChild<QPushButton*>("rule_ok"));
  ASSERT_EQ(layout().pair_rules.size(), 1U);
  EXPECT_DOUBLE_EQ(layout().pair_rules[0].required_clearance_mm, 12.5);

  auto* rules = Find<QListWidget>("rules");
  ASSERT_EQ(rules->count(), 2);
  rules->setCurrentRow(0);
  Click(Find<QToolButton>("remove_rule"));
  EXPECT_TRUE(layout().spacings.empty());
  EXPECT_EQ(layout().pair_rules.size(), 1U);
  page_->desk().Undo();
  EXPECT_EQ(layout().spacings.size(), 1U);
}

TEST_F(LayoutPageTest, SavesByKeysWithCommentsKept) {
  OpenLayout();
  page_->Choose({"lid"});
  TypeInto(Find<QDoubleSpinBox>("part_position:x"), "7.5");
  QTest::keyClick(&page_->view(), Qt::Key_S, Qt::ControlModifier);
  EXPECT_FALSE(page_->desk().document().is_changed()) << fault_.toStdString();
  std::string expected = kLayout;
  expected.replace(expected.find("[0.0, 0.0"), 4, "[7.5");
  EXPECT_EQ(ReadText(file_), expected);
}

TEST_F(LayoutPageTest, ANewLayoutIsSavedUnderTheNameThatIsTyped) {
  OpenImport(folder_ / "box.glb");
  Click(Find<QPushButton>("import_take"));
  ASSERT_EQ(layout().parts.size(), 1U);
  const std::filesystem::path made = folder_ / "sub/made.toml";
  std::filesystem::create_directories(made.parent_path());
  TypeIntoNextFileDialog(QString::fromStdString((folder_ / "sub/made").string()));
  QTest::keyClick(&page_->view(), Qt::Key_S, Qt::ControlModifier);
  EXPECT_TRUE(WaitUntil([&] { return !page_->desk().document().is_changed(); })) << fault_.toStdString();
  const cad_import::ImportedLayout read = cad_import::ImportLayoutFile(made);
  EXPECT_EQ(read.layout.parts[0].file, "../box.glb");
}

// The question stands in the page: nothing waits for its answer.
TEST_F(LayoutPageTest, ChangesAreNotLostWithoutAQuestion) {
  OpenLayout();
  int left = 0;
  const auto leave = [&] { page_->Leave([&left] { ++left; }); };
  auto* question = Find<QWidget>("unsaved");
  leave();
  EXPECT_EQ(left, 1);  // nothing to lose
  page_->Choose({"lid"});
  TypeInto(Find<QDoubleSpinBox>("part_position:x"), "7.5");
  leave();
  EXPECT_EQ(QApplication::activeModalWidget(), nullptr);
  EXPECT_TRUE(question->isVisible());
  Click(Find<QPushButton>("unsaved_stay"));
  EXPECT_FALSE(question->isVisible());
  EXPECT_EQ(left, 1);
  leave();
  Click(Find<QPushButton>("unsaved_save"));
  EXPECT_EQ(left, 2);
  EXPECT_NE(ReadText(file_).find("7.5"), std::string::npos);
  TypeInto(Find<QDoubleSpinBox>("part_position:x"), "9");
  leave();
  Click(Find<QPushButton>("unsaved_discard"));
  EXPECT_EQ(left, 3);
  leave();
  EXPECT_EQ(left, 4);  // not asked twice
  EXPECT_EQ(ReadText(file_).find("[9"), std::string::npos);
}

TEST_F(LayoutPageTest, ALayoutThatIsSavedMeanwhileIsNotAskedForAnyMore) {
  OpenLayout();
  page_->Choose({"lid"});
  TypeInto(Find<QDoubleSpinBox>("part_position:x"), "7.5");
  page_->Leave([] { FAIL() << "nobody answered"; });
  QTest::keyClick(&page_->view(), Qt::Key_S, Qt::ControlModifier);
  EXPECT_FALSE(Find<QWidget>("unsaved")->isVisible());
}

// A file that is asked for again is the same question.
TEST_F(LayoutPageTest, TheSameFileIsAskedForOnce) {
  Click(Find<QToolButton>("layout_open_button"));
  Click(Find<QToolButton>("layout_open_button"));
  EXPECT_EQ(page_->findChildren<QFileDialog*>().size(), 1);
  EXPECT_EQ(QApplication::activeModalWidget(), nullptr);
  TypeIntoNextFileDialog(QString::fromStdString(file_.string()));
  EXPECT_TRUE(WaitUntil([&] { return page_->desk().document().has_file(); })) << fault_.toStdString();
}

TEST_F(LayoutPageTest, OfTwoFilesThatAreOpenedTheSecondIsShown) {
  const std::filesystem::path second = folder_ / "second.toml";
  WriteText(second, kLayout);
  page_->Open(file_);
  page_->Open(second);
  ASSERT_TRUE(WaitUntil([&] { return page_->desk().document().has_file() || !fault_.isEmpty(); }));
  EXPECT_EQ(page_->desk().document().file(), second) << fault_.toStdString();
}

TEST_F(LayoutPageTest, ANewLayoutEndsTheReadingOfAnother) {
  page_->Open(file_);
  page_->desk().New();
  EXPECT_FALSE(page_->desk().is_reading());
  QApplication::processEvents();  // what the reading has told until then
  EXPECT_FALSE(page_->desk().document().has_file());
  EXPECT_FALSE(Find<QWidget>("layout_reading")->isVisible());
  EXPECT_TRUE(fault_.isEmpty()) << fault_.toStdString();
}

TEST_F(LayoutPageTest, AFileThatIsReadDoesNotTakeThePlaceOfChangesMadeMeanwhile) {
  OpenLayout();
  const std::filesystem::path second = folder_ / "second.toml";
  WriteText(second, kLayout);
  page_->Open(second);
  page_->desk().Apply("Change", [](cad_import::LayoutText& text) { text.Remove("part", 1); });
  ASSERT_TRUE(WaitUntil([&] { return !page_->desk().is_reading(); }));
  EXPECT_TRUE(fault_.contains("second.toml")) << fault_.toStdString();
  EXPECT_EQ(page_->desk().document().file(), file_);
  EXPECT_EQ(layout().parts.size(), 1U);
}

TEST_F(LayoutPageTest, WhatIsOfferedIsKeptWhileTheLayoutIsChanged) {
  LeaveOnePart();
  OpenLayout();
  page_->Choose({"lid"});
  TypeInto(Find<QDoubleSpinBox>("part_position:x"), "7.5");
  QTest::qWait(2500);  // past the time of an autosave
  Click(Find<QPushButton>("recovery_take"));
  Click(Find<QPushButton>("recovery_stay"));
  EXPECT_FALSE(page_->desk().is_reading());
  Click(Find<QPushButton>("recovery_take"));
  Click(Find<QPushButton>("recovery_replace"));
  EXPECT_TRUE(WaitUntil([&] { return layout().parts.size() == 1; })) << fault_.toStdString();
}

TEST_F(LayoutPageTest, WhatIsOfferedIsDiscardedWithoutTheChangesSince) {
  LeaveOnePart();
  OpenLayout();
  page_->Choose({"lid"});
  TypeInto(Find<QDoubleSpinBox>("part_position:x"), "7.5");
  Click(Find<QPushButton>("recovery_forget"));
  EXPECT_FALSE(Find<QWidget>("recovery")->isVisible());
  EXPECT_FALSE(control::FindAutosave(file_));
  EXPECT_TRUE(page_->desk().is_unsaved());
  EXPECT_TRUE(WaitUntil([&] { return control::FindAutosave(file_).has_value(); }));  // kept from now on
}

TEST_F(LayoutPageTest, WhatTheProgramsEndLeftIsOfferedAndTaken) {
  LeaveOnePart();
  OpenLayout();
  EXPECT_TRUE(Find<QWidget>("recovery")->isVisible());
  Click(Find<QPushButton>("recovery_take"));
  ASSERT_TRUE(WaitUntil([&] { return layout().parts.size() == 1; }));
  EXPECT_FALSE(Find<QWidget>("recovery")->isVisible());
  EXPECT_TRUE(page_->desk().document().is_changed());
}

TEST_F(LayoutPageTest, ChangesAreKeptBesideTheFileAfterAWhile) {
  OpenLayout();
  page_->Choose({"lid"});
  TypeInto(Find<QDoubleSpinBox>("part_position:x"), "7.5");
  EXPECT_TRUE(WaitUntil([&] { return control::FindAutosave(file_).has_value(); }));
  EXPECT_EQ(ReadText(file_), kLayout);
}

TEST_F(LayoutPageTest, APartIsRenamedInTheList) {
  OpenLayout();
  page_->Choose({"lid"});
  auto* list = Find<QTreeWidget>("parts");
  list->topLevelItem(1)->setText(0, "cover");  // what the line edit does when it is closed
  ASSERT_TRUE(WaitUntil([&] { return layout().FindPart("cover").has_value(); })) << fault_.toStdString();
  EXPECT_EQ(page_->chosen(), QStringList{"cover"});
  list->topLevelItem(1)->setText(0, "box");
  ASSERT_TRUE(WaitUntil([&] { return !fault_.isEmpty(); }));
  EXPECT_EQ(list->topLevelItem(1)->text(0), "cover");
}

TEST_F(LayoutPageTest, AnImportThatIsCancelledTakesNothing) {
  page_->Import(kAssembly);
  Click(Find<QPushButton>("import_cancel"));
  EXPECT_TRUE(WaitUntil([&] { return page_->findChild<ImportDialog*>("import_dialog") == nullptr; }));
  EXPECT_TRUE(layout().parts.empty());
  EXPECT_TRUE(fault_.isEmpty()) << fault_.toStdString();
}

TEST_F(LayoutPageTest, IsolateHidesTheOthersAndShowsThemAgain) {
  OpenLayout();
  page_->Choose({"lid"});
  auto* list = Find<QTreeWidget>("parts");
  Click(Find<QToolButton>("part_isolate"));
  EXPECT_EQ(list->topLevelItem(0)->checkState(0), Qt::Unchecked);
  EXPECT_EQ(list->topLevelItem(1)->checkState(0), Qt::Checked);
  Click(Find<QToolButton>("part_isolate"));
  EXPECT_EQ(list->topLevelItem(0)->checkState(0), Qt::Checked);
}

TEST_F(LayoutPageTest, AHandleMovesThePartInWholeMillimetresAndAsOneStep) {
  OpenLayout();
  page_->Choose({"lid"});
  const auto gizmo = page_->view().Gizmo();
  ASSERT_TRUE(gizmo);
  const QPoint from = gizmo->MiddleOf({false, 0}).value().toPoint();
  ASSERT_EQ(gizmo->HandleAt(from), (GizmoHandle{false, 0}));
  PartsView* view = &page_->view();
  QTest::mousePress(view, Qt::LeftButton, {}, from);
  for (const int by : {10, 25, 40}) {
    QMouseEvent move(QEvent::MouseMove, from + QPoint(by, 0), view->mapToGlobal(from + QPoint(by, 0)),
                     Qt::NoButton, Qt::LeftButton, Qt::ShiftModifier);
    QApplication::sendEvent(view, &move);
  }
  QTest::mouseRelease(view, Qt::LeftButton, Qt::ShiftModifier, from + QPoint(40, 0));
  const Eigen::Vector3d place = layout().parts[1].world_from_part.translation_mm;
  EXPECT_GT(std::abs(place.x()), 5.0);
  EXPECT_DOUBLE_EQ(place.x(), std::round(place.x()));
  EXPECT_DOUBLE_EQ(place.y(), 0.0);
  EXPECT_DOUBLE_EQ(place.z(), 200.0);
  page_->desk().Undo();
  EXPECT_EQ(page_->desk().document().text().text(), kLayout);
}

TEST_F(LayoutPageTest, ARingTurnsThePartAndEscapeEndsTheDragWhereItBegan) {
  OpenLayout();
  page_->Choose({"lid"});
  const QPoint from = page_->view().Gizmo().value().MiddleOf({true, 2}).value().toPoint();
  PartsView* view = &page_->view();
  const auto drag = [&] {
    QTest::mousePress(view, Qt::LeftButton, {}, from);
    QMouseEvent move(QEvent::MouseMove, from + QPoint(30, 12), view->mapToGlobal(from + QPoint(30, 12)),
                     Qt::NoButton, Qt::LeftButton, Qt::ShiftModifier);
    QApplication::sendEvent(view, &move);
  };
  drag();
  QTest::keyClick(view, Qt::Key_Escape);
  QTest::mouseRelease(view, Qt::LeftButton, {}, from);
  EXPECT_EQ(page_->desk().document().text().text(), kLayout);
  page_->Choose({"lid"});
  drag();
  QTest::mouseRelease(view, Qt::LeftButton, Qt::ShiftModifier, from + QPoint(30, 12));
  const double yaw_deg = RollPitchYawDegOf(layout().parts[1]).z();
  EXPECT_GT(std::abs(yaw_deg), 1.0);
  EXPECT_NEAR(yaw_deg, 5.0 * std::round(yaw_deg / 5.0), 1e-6);
}

TEST_F(LayoutPageTest, AFaceIsLaidOnAFaceByTwoClicks) {
  OpenLayout();
  ASSERT_TRUE(WaitUntil([&] { return page_->view().CanPick(); }));
  page_->findChild<QAction*>("layout_face_to_face")->trigger();
  const auto click = [&](std::size_t part, const Eigen::Vector3d& x_in_part) {
    const QPointF at = page_->view().PositionOf(layout().parts[part].world_from_part * x_in_part).value();
    QTest::mouseClick(&page_->view(), Qt::LeftButton, {}, at.toPoint());
  };
  // A change begins it again: what was clicked on first is another part now.
  click(1, {50.0, 0.0, 5.0});
  page_->desk().Apply("Change", [](cad_import::LayoutText& text) { text.Remove("part", 0); });
  ASSERT_TRUE(WaitUntil([&] { return page_->view().CanPick(); }));
  click(0, {50.0, 0.0, 5.0});
  EXPECT_EQ(page_->desk().document().UndoName(), "Change");
  EXPECT_TRUE(fault_.isEmpty()) << fault_.toStdString();
  page_->desk().Undo();
  ASSERT_TRUE(WaitUntil([&] { return page_->view().CanPick(); }));
  click(1, {50.0, 0.0, 5.0});  // the lid's face towards -y
  click(1, {50.0, 0.0, 5.0});  // itself: said, and asked again
  EXPECT_TRUE(fault_.contains("lid")) << fault_.toStdString();
  click(0, {100.0, 40.0, 30.0});  // the box's face towards +x
  const core::RigidTransform& pose = layout().parts[1].world_from_part;
  EXPECT_LT((pose.rotation * -Eigen::Vector3d::UnitY() + Eigen::Vector3d::UnitX()).norm(), 1e-7);
  EXPECT_NEAR((pose * Eigen::Vector3d(50.0, 0.0, 5.0)).x(), 100.0, 1e-4);
  EXPECT_EQ(page_->desk().document().UndoName(), "Place lid");
}

TEST_F(LayoutPageTest, AHoleIsBroughtToAnotherByTwoClicks) {
  constexpr double kAround = 6.283185307179586;
  cad_import::WriteMeshFile(test_support::Wall(30.0, 60.0, kAround, 32, false), folder_ / "box.glb");
  core::RigidTransform lying = core::FromPositionAndRollPitchYaw({0.0, 0.0, 0.0}, {0.0, 90.0, 20.0});
  cad_import::WriteMeshFile(core::Transformed(test_support::Wall(20.0, 90.0, kAround, 32, false), lying),
                            folder_ / "lid.glb");
  OpenLayout();
  ASSERT_TRUE(WaitUntil([&] { return page_->view().CanPick(); }));
  page_->findChild<QAction*>("layout_hole_to_hole")->trigger();
  QTest::mouseClick(&page_->view(), Qt::LeftButton, {}, InView("lid"));
  ASSERT_TRUE(WaitUntil([&] { return page_->placing().Advice().contains("lid"); }));
  QTest::mouseClick(&page_->view(), Qt::LeftButton, {}, InView("box"));
  ASSERT_TRUE(WaitUntil([&] { return page_->placing().placing() == Placing::kNone; }));
  EXPECT_EQ(page_->desk().document().UndoName(), "Place lid") << fault_.toStdString();
  const core::RigidTransform& pose = layout().parts[1].world_from_part;
  EXPECT_LT((pose.rotation * lying.rotation.col(2)).cross(Eigen::Vector3d::UnitZ()).norm(), 1e-5);
  const Eigen::Vector3d on_axis = pose * (lying * Eigen::Vector3d(0.0, 0.0, 45.0));
  EXPECT_LT(on_axis.head<2>().norm(), 1e-3);  // of files in single precision
}

TEST_F(LayoutPageTest, MeasuredPointsPlaceThePartAndSayHowFarTheyAreOff) {
  OpenLayout();
  ASSERT_TRUE(WaitUntil([&] { return page_->view().CanPick(); }));
  page_->Choose({"lid"});
  page_->findChild<QAction*>("layout_measured")->trigger();
  auto* dialog = Find<MeasuredPoints>("measured_points");
  auto* table = dialog->findChild<QTableWidget*>("measured_table");
  const std::array<Eigen::Vector3d, 4> clicked = {
      {{20.0, 10.0, 10.0}, {80.0, 10.0, 10.0}, {50.0, 70.0, 10.0}, {20.0, 60.0, 10.0}}};
  const core::RigidTransform real = core::FromPositionAndRollPitchYaw({300.0, -40.0, 25.0}, {0.0, 0.0, 30.0});
  for (const Eigen::Vector3d& x : clicked) {
    const Eigen::Vector3d x_in_world = layout().parts[1].world_from_part * x;
    QTest::mouseClick(&page_->view(), Qt::LeftButton, {},
                      page_->view().PositionOf(x_in_world).value().toPoint());
  }
  ASSERT_EQ(table->rowCount(), 4);
  // A click is in the middle of a pixel: what it hit is what was measured.
  const core::RigidTransform before = layout().parts[1].world_from_part;
  for (int row = 0; row < 4; ++row) {
    Eigen::Vector3d x;
    for (int i = 0; i < 3; ++i) x[i] = table->item(row, 1 + i)->text().toDouble();
    const Eigen::Vector3d measured = real * (before.Inverse() * x);
    for (int i = 0; i < 3; ++i) table->item(row, 1 + i)->setText(QString::number(measured[i], 'f', 6));
  }
  ASSERT_TRUE(dialog->fit());
  EXPECT_LT(dialog->fit()->largest_mm, 0.02);  // the numbers are shown to a hundredth
  Click(dialog->findChild<QPushButton*>("measured_place"));
  EXPECT_LT((layout().parts[1].world_from_part.translation_mm - real.translation_mm).norm(), 0.1);
  EXPECT_NEAR(RollPitchYawDegOf(layout().parts[1]).z(), 30.0, 0.05);
  // Asked for again it is the same one; of another part, one in its place.
  page_->findChild<QAction*>("layout_measured")->trigger();
  EXPECT_EQ(Find<MeasuredPoints>("measured_points"), dialog);
  page_->Choose({"box"});
  page_->findChild<QAction*>("layout_measured")->trigger();
  ASSERT_TRUE(WaitUntil([&] { return page_->findChildren<MeasuredPoints*>().size() == 1; }));
  dialog = Find<MeasuredPoints>("measured_points");
  EXPECT_EQ(dialog->part(), "box");
  EXPECT_EQ(page_->placing().placing(), Placing::kMeasuredPoints);
  dialog->close();
}

TEST_F(LayoutPageTest, MeasuredNumbersMayHaveAPointOrTheCommaOfTheLanguage) {
  const QLocale before;
  QLocale::setDefault(QLocale(QLocale::German, QLocale::Germany));
  MeasuredPoints dialog("lid");
  for (const Eigen::Vector3d& x : {Eigen::Vector3d(20.5, 10.0, 10.0), Eigen::Vector3d(80.0, 10.0, 10.0),
                                   Eigen::Vector3d(50.0, 70.0, 10.0)})
    dialog.Add(x, x);
  EXPECT_TRUE(dialog.fit());
  dialog.findChild<QTableWidget*>("measured_table")->item(0, 1)->setText("20,5");
  ASSERT_TRUE(dialog.fit());
  EXPECT_LT(dialog.fit()->largest_mm, 1e-6);
  QLocale::setDefault(before);
}

TEST_F(LayoutPageTest, ATrialThatIsThereIsReplacedByASecondPressOnly) {
  const std::filesystem::path trial = folder_ / "layout_trial.toml";
  WriteText(trial, "layout = \"layout.toml\"\n");
  TrialDialog dialog(file_);
  dialog.show();
  auto* name = dialog.findChild<QLineEdit*>("trial_file");
  EXPECT_TRUE(name->text().endsWith("layout_trial2.toml")) << name->text().toStdString();
  name->setText(QString::fromStdString(trial.string()));
  dialog.findChild<QLineEdit*>("trial_rig")->setText(QString::fromStdString((folder_ / "box.glb").string()));
  const QSignalSpy written(&dialog, &TrialDialog::Written);
  auto* start = dialog.findChild<QPushButton*>("trial_start");
  Click(start);
  EXPECT_TRUE(dialog.findChild<QLabel*>("trial_fault")->isVisible());
  EXPECT_EQ(written.count(), 0);
  Click(start);
  EXPECT_EQ(written.count(), 1) << dialog.findChild<QLabel*>("trial_fault")->text().toStdString();
  EXPECT_NE(ReadText(trial).find("rig"), std::string::npos);
}

TEST_F(LayoutPageTest, DrawsThePartsAndTheGap) {
  OpenLayout();
  page_->Choose({"box", "lid"});
  Click(Find<QPushButton>("add_spacing"));
  Click(Find<SpacingDialog>("spacing_dialog")->findChild<QPushButton*>("rule_ok"));
  ASSERT_TRUE(WaitUntil([&] { return !page_->view().picture().isNull(); })) << fault_.toStdString();
  // The middle of the gap's line is painted in its ink.
  const auto [from, to] = std::pair(InView("box"), InView("lid"));
  EXPECT_LT(to.y(), from.y());  // the lid is above
}

TEST_F(LayoutPageTest, FitsAWindowOf800Pixels) {
  constexpr int kMarginsPx = 12;  // of the window around its page
  EXPECT_LE(page_->minimumSizeHint().width(), 800 - kMarginsPx);
}

TEST_F(LayoutPageTest, EveryControlHasANameAToolTipAndASpokenName) {
  OpenLayout();
  for (const QWidget* widget : page_->findChildren<QWidget*>()) {
    const bool is_worked = qobject_cast<const QAbstractButton*>(widget) != nullptr ||
                           qobject_cast<const QDoubleSpinBox*>(widget) != nullptr ||
                           qobject_cast<const QSlider*>(widget) != nullptr;
    if (!is_worked || !widget->isVisible() || widget->objectName().startsWith("qt_")) continue;
    EXPECT_FALSE(widget->objectName().isEmpty()) << widget->metaObject()->className();
    EXPECT_FALSE(widget->toolTip().isEmpty()) << widget->objectName().toStdString();
  }
}

}  // namespace
}  // namespace elbowroom::console
