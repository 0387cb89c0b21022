// The layout page with its panels and dialogs, looked at.
#include <gtest/gtest.h>

#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QPushButton>

#include "app/console/layouts/import_dialog.h"
#include "app/console/layouts/measured_points.h"
#include "app/console/layouts/rule_dialogs.h"
#include "app/console/layouts/trial_dialog.h"
#include "app/control/layout_editing/layout_document.h"
#include "tests/app/console/looks/tour.h"
#include "tests/app/mask_rig.h"
#include "tests/support/text_file.h"

namespace elbowroom::console {
namespace {

class LayoutTour : public Tour {
 protected:
  LayoutTour() {
    test_support::WriteBoxStl(folder_ / "payload.stl", 120.0);
    test_support::WriteBoxStl(folder_ / "base_plate.stl", 240.0);
    Know({"payload", "base_plate", "payload_gap"});
    window_.pages().Show(Page::kLayout);
  }
  ~LayoutTour() override {
    page().desk().DiscardRecovery();
    page().desk().Forget();
  }

  LayoutPage& page() { return window_.layout_page(); }
  [[nodiscard]] const core::Layout& layout() { return page().desk().document().layout(); }
  void Import(const char* file, const char* look) {
    page().Import(folder_ / file);
    auto* dialog = Find<ImportDialog>("import_dialog");
    ASSERT_TRUE(WaitUntil([&] { return !dialog->is_reading(); }));
    Look(look, *dialog);
    const std::size_t before = layout().parts.size();
    Click(dialog->findChild<QPushButton*>("import_take"));
    ASSERT_TRUE(WaitUntil([&] { return layout().parts.size() == before + 1; })) << Message();
    CloseDialogs();
  }
  // The next one of a kind is found by its name.
  void CloseDialogs() {
    for (auto* dialog : window_.findChildren<QDialog*>()) {
      dialog->close();
      delete dialog;
    }
  }
  void LookAtRules();
  void LookAtPlacing();
  void LookAtTrial();
};

void LayoutTour::LookAtRules() {
  page().Choose({"payload", "base_plate"});
  Look("layout_two_chosen");
  Click(Find<QPushButton>("add_spacing"));
  auto* spacing = Find<SpacingDialog>("spacing_dialog");
  spacing->findChild<QLineEdit*>("spacing_name")->clear();
  Click(spacing->findChild<QPushButton*>("rule_ok"));
  QCoreApplication::processEvents();
  Look("layout_spacing", *spacing);
  spacing->findChild<QLineEdit*>("spacing_name")->setText("payload_gap");
  Click(spacing->findChild<QPushButton*>("rule_ok"));
  ASSERT_EQ(layout().spacings.size(), 1U);
  CloseDialogs();
  Click(Find<QPushButton>("add_pair"));
  auto* pair = Find<PairDialog>("pair_dialog");
  pair->findChild<QDoubleSpinBox*>("pair_clearance")->setValue(30.0);
  Look("layout_pair_rule", *pair);
  Click(pair->findChild<QPushButton*>("rule_ok"));
  ASSERT_EQ(layout().pair_rules.size(), 1U);
  CloseDialogs();
  Look("layout_rules");
}

void LayoutTour::LookAtPlacing() {
  Action("layout_face_to_face").trigger();
  Look("layout_face_to_face");
  Action("layout_hole_to_hole").trigger();
  Look("layout_hole_to_hole");
  Action("layout_measured").trigger();
  auto* points = Find<MeasuredPoints>("measured_points");
  Look("layout_measured_none", *points);
  points->Add({0, 0, 0}, {1200.0, -345.25, 0.5});
  points->Add({120, 0, 0}, {1320.0, -345.0, 0.0});
  points->Add({0, 120, 0}, {1200.0, -225.0, -0.5});
  points->Add({0, 0, 120}, {1199.5, -345.0, 120.0});
  Look("layout_measured_points", *points);
  CloseDialogs();
}

void LayoutTour::LookAtTrial() {
  ASSERT_TRUE(page().desk().SaveAs(folder_ / "layout.toml"));
  Action("layout_trial").trigger();
  auto* trial = Find<TrialDialog>("trial_dialog");
  Look("layout_trial", *trial);
  trial->findChild<QLineEdit*>("trial_rig")->setText("nowhere.yml");
  Click(trial->findChild<QPushButton*>("trial_start"));
  if (GetParam() == Inspection::kFit) Look("layout_trial_fault", *trial);  // its line is of a room below
  CloseDialogs();
}

TEST_P(LayoutTour, IsAllThere) {
  Look("layout_empty");
  ASSERT_NO_FATAL_FAILURE(Import("base_plate.stl", "layout_import"));
  ASSERT_NO_FATAL_FAILURE(Import("payload.stl", "layout_import_again"));
  Look("layout_chosen");
  ASSERT_NO_FATAL_FAILURE(LookAtRules());
  ASSERT_NO_FATAL_FAILURE(LookAtPlacing());
  ASSERT_NO_FATAL_FAILURE(LookAtTrial());
}

TEST_P(LayoutTour, OffersWhatWasNotSaved) {
  test_support::WriteText(folder_ / "layout.toml",
                          "[[part]]\nname = \"payload\"\nfile = \"payload.stl\"\nunit = \"mm\"\n");
  control::LayoutDocument document = control::LayoutDocument::Open(folder_ / "layout.toml");
  document.Apply("Change", [](cad_import::LayoutText& text) { text.Remove("part", 0); });
  document.Autosave();
  page().Open(folder_ / "layout.toml");
  ASSERT_TRUE(WaitUntil([&] { return page().desk().can_recover(); })) << Message();
  Look("layout_recovery");
  window_.ShowError(QString::fromStdString((folder_ / "layout.toml").string()));
  Look("layout_error");
}

INSTANTIATE_TEST_SUITE_P(Looks, LayoutTour, testing::Values(Inspection::kFit, Inspection::kWords),
                         InspectionName);

}  // namespace
}  // namespace elbowroom::console
