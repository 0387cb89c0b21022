// The page on which parts are imported, placed and ruled.
#pragma once

#include <QAction>
#include <QDialog>
#include <QLabel>
#include <QMenu>
#include <QMimeData>
#include <QPointer>
#include <QProgressBar>
#include <QString>
#include <QStringList>
#include <QWidget>
#include <filesystem>
#include <functional>
#include <vector>

#include "app/console/layouts/layout_desk.h"
#include "app/console/layouts/measured_points.h"
#include "app/console/layouts/part_look.h"
#include "app/console/layouts/part_panel.h"
#include "app/console/layouts/parts_list.h"
#include "app/console/layouts/parts_view.h"
#include "app/console/layouts/placing_steps.h"
#include "app/console/layouts/rule_panel.h"
#include "app/console/view/question_bar.h"

namespace elbowroom::console {

// Shows the desk's layout and passes on what the user does: every change is one step of undo. Which parts are
// chosen, hidden or coloured is of the page, not of the file. Thread: UI.
class LayoutPage : public QWidget {
  Q_OBJECT

 public:
  explicit LayoutPage(QWidget* parent = nullptr);
  ~LayoutPage() override;

  // Reads a LAYOUT.toml on a worker and shows it; asks first where the present one isn't saved.
  void Open(const std::filesystem::path& layout_file);
  // Shows what is in a CAD file and adds what is taken.
  void Import(const std::filesystem::path& cad_file);
  // Does it once nothing of the present layout can be lost: at once where all is saved, else after the user
  // has saved or discarded the changes, and never where the user stays. The question stands in the page.
  void Leave(std::function<void()> then);

  // The file that was dragged, if it is a CAD file; else "".
  [[nodiscard]] static QString CadFileIn(const QMimeData* data);

  [[nodiscard]] QMenu* menu() { return menu_; }
  [[nodiscard]] LayoutDesk& desk() { return *desk_; }
  [[nodiscard]] PartsView& view() { return *view_; }
  [[nodiscard]] const PlacingSteps& placing() const { return *placing_; }
  [[nodiscard]] const QStringList& chosen() const { return chosen_; }
  void Choose(const QStringList& parts);

 signals:
  void TrialAsked(const QString& trial_file);    // a TRIAL.toml was written that is to be run
  void LayoutSaved(const QString& layout_file);  // or opened
  void Failed(const QString& line);

 protected:
  bool event(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void showEvent(QShowEvent* event) override;

 private:
  struct KeyAction {
    QKeySequence::StandardKey key;
    QAction* action;
  };
  QAction* AddAction(const QString& name, const QString& text, const QString& tool_tip,
                     const std::function<void()>& work,
                     QKeySequence::StandardKey key = QKeySequence::UnknownKey);
  void AddActions();
  [[nodiscard]] QWidget* ButtonRow();
  void OfferRecovery();
  [[nodiscard]] QWidget* SidePanel();
  void FollowDesk();
  void FollowPanels();
  void FollowPlacing();
  void AskForFile();
  void AskForPart();
  void AskToRecover();
  // `then` is done if it was saved.
  void Save(const std::function<void()>& then = {});
  void SaveAs(const std::function<void()>& then = {});
  void AskForTrial();
  void ShowTrialDialog();
  void ShowAside(QDialog* dialog);
  void AskForMeasuredPoints();
  void ShowLayout();
  void ShowParts();
  void ShowState();
  void Change(const QString& name, const control::LayoutDocument::Change& change, const QString& key = {});
  void MovePart(const QString& part, int axis, double position_mm);
  void TurnPart(const QString& part, int axis, double rotation_deg);
  void PlacePart(const QString& part, const core::RigidTransform& world_from_part);
  void RenamePart(const QString& part, const QString& to);
  void RemovePart(const QString& part);
  void Isolate(const QString& part);
  void AskForSpacing(const core::Spacing& spacing, bool is_new);
  void AskForPair(const core::PairRule& rule);
  [[nodiscard]] PartLook LookOf(const QString& part) const;
  [[nodiscard]] const core::Layout& layout() const { return desk_->document().layout(); }

  [[nodiscard]] std::vector<core::RigidTransform> Poses() const;

  LayoutDesk* desk_;  // this and all below are owned by Qt as children
  QMenu* menu_;
  PlacingSteps* placing_;
  PartsView* view_ = nullptr;
  PartsList* list_ = nullptr;
  PartPanel* part_ = nullptr;
  RulePanel* rules_ = nullptr;
  QLabel* title_ = nullptr;
  QProgressBar* reading_ = nullptr;
  QuestionBar* recovery_ = nullptr;
  QuestionBar* unsaved_ = nullptr;
  std::vector<KeyAction> keys_;
  QStringList chosen_;
  PartLooks looks_;
  std::filesystem::path last_cad_folder_;
  QPointer<MeasuredPoints> measured_;  // while it is open
};

}  // namespace elbowroom::console
