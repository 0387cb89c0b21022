// The layout page's buttons and menu, and the questions that they ask.
#include <QHBoxLayout>
#include <QStyle>
#include <QToolButton>
#include <numbers>

#include "app/console/layouts/import_dialog.h"
#include "app/console/layouts/layout_page.h"
#include "app/console/layouts/measured_points.h"
#include "app/console/layouts/rule_dialogs.h"
#include "app/console/layouts/trial_dialog.h"
#include "app/console/view/file_question.h"
#include "app/control/layout_editing/layout_edit.h"
#include "app/control/layout_editing/pair_of_parts.h"

namespace elbowroom::console {
namespace {

const char* const kCadFilter =
    "*.step *.stp *.p21 *.iges *.igs *.brep *.3mf *.stl *.obj *.ply *.off *.gltf *.glb *.dae *.fbx *.3ds";

QString FolderOfDialog(const std::filesystem::path& file) {
  return QString::fromStdString(file.parent_path().string());
}

}  // namespace

QAction* LayoutPage::AddAction(const QString& name, const QString& text, const QString& tool_tip,
                               const std::function<void()>& work, QKeySequence::StandardKey key) {
  auto* action = new QAction(text, this);
  action->setObjectName(name);
  const QString keys = QKeySequence(key).toString(QKeySequence::NativeText);
  action->setToolTip(keys.isEmpty() ? tool_tip : tr("%1 (%2)").arg(tool_tip, keys));
  connect(action, &QAction::triggered, this, work);
  if (key != QKeySequence::UnknownKey) keys_.push_back({key, action});
  menu_->addAction(action);
  return action;
}

void LayoutPage::AddActions() {
  menu_->setToolTipsVisible(true);
  AddAction(
      "layout_new", tr("&New"), tr("An empty layout"), [this] { Leave([this] { desk_->New(); }); },
      QKeySequence::New);
  AddAction(
      "layout_open", tr("&Open …"), tr("Opens a LAYOUT.toml"), [this] { AskForFile(); }, QKeySequence::Open);
  AddAction(
      "layout_save", tr("&Save"), tr("Writes the LAYOUT.toml; its comments stay"), [this] { Save(); },
      QKeySequence::Save);
  AddAction(
      "layout_save_as", tr("Save &as …"), tr("Writes the layout into another file"), [this] { SaveAs(); },
      QKeySequence::SaveAs);
  menu_->addSeparator();
  AddAction("layout_import", tr("&Import part …"), tr("Takes parts from a CAD file"),
            [this] { AskForPart(); });
  menu_->addSeparator();
  AddAction(
      "layout_undo", tr("&Undo"), tr("Takes the last change back"), [this] { desk_->Undo(); },
      QKeySequence::Undo);
  AddAction(
      "layout_redo", tr("&Redo"), tr("Makes it again"), [this] { desk_->Redo(); }, QKeySequence::Redo);
  menu_->addSeparator();
  AddAction("layout_face_to_face", tr("&Face to face"),
            tr("Lays a face of one part on a face of another: click on both, first on what moves"),
            [this] { placing_->Begin(Placing::kFaceToFace); });
  AddAction("layout_hole_to_hole", tr("&Hole to hole"),
            tr("Brings the axes of two holes or pins onto one line: click on both, first on what moves"),
            [this] { placing_->Begin(Placing::kHoleToHole); });
  AddAction("layout_measured", tr("&Measured points …"),
            tr("Places the chosen part by three or more points that were measured on the real one"),
            [this] { AskForMeasuredPoints(); });
  menu_->addSeparator();
  auto* views = menu_->addMenu(tr("&View from"));
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  const auto look = [this](double azimuth, double elevation) {
    return [this, azimuth, elevation] { view_->LookAlong(azimuth, elevation); };
  };
  views->addAction(tr("the &front (against y)"), view_, look(-kQuarter, 0.0));
  views->addAction(tr("the &right (against x)"), view_, look(0.0, 0.0));
  views->addAction(tr("&above (against z)"), view_, look(-kQuarter, kQuarter));
  views->addAction(tr("a &corner"), view_, look(-0.9, 0.5));
  menu_->addSeparator();
  AddAction("layout_trial", tr("&Trial from this layout …"),
            tr("Writes a TRIAL.toml with a rig and this layout, and starts it"), [this] { AskForTrial(); });
}

QWidget* LayoutPage::ButtonRow() {
  auto* row = new QWidget;
  auto* line = new QHBoxLayout(row);
  line->setContentsMargins(0, 0, 0, 0);
  line->setSpacing(2);
  for (const char* name : {"layout_new", "layout_open", "layout_save", "layout_import", "layout_undo",
                           "layout_redo", "layout_face_to_face", "layout_hole_to_hole", "layout_trial"}) {
    auto* button = new QToolButton;
    button->setDefaultAction(findChild<QAction*>(name));
    button->setObjectName(QString(name) + "_button");
    button->setAutoRaise(true);
    button->setToolButtonStyle(Qt::ToolButtonTextOnly);
    line->addWidget(button);
  }
  title_ = new QLabel;
  title_->setObjectName("layout_title");
  title_->setTextFormat(Qt::PlainText);
  title_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  // A long name gives way where the window is narrow; the tool tip has all of it.
  title_->setMinimumWidth(60);
  title_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  line->addWidget(title_, 1);
  return row;
}

void LayoutPage::ShowState() {
  const control::LayoutDocument& document = desk_->document();
  const auto action = [this](const char* name) { return findChild<QAction*>(name); };
  action("layout_undo")->setEnabled(document.CanUndo());
  action("layout_undo")
      ->setText(document.CanUndo() ? tr("&Undo %1").arg(QString::fromStdString(document.UndoName()))
                                   : tr("&Undo"));
  action("layout_redo")->setEnabled(document.CanRedo());
  action("layout_redo")
      ->setText(document.CanRedo() ? tr("&Redo %1").arg(QString::fromStdString(document.RedoName()))
                                   : tr("&Redo"));
  for (const char* name : {"layout_undo", "layout_redo"})
    action(name)->setIconText(name == std::string_view("layout_undo") ? tr("Undo") : tr("Redo"));
  action("layout_save")->setEnabled(document.is_changed());
  action("layout_trial")->setEnabled(!document.layout().parts.empty());
  action("layout_measured")->setEnabled(!chosen_.isEmpty());
  for (const char* name : {"layout_face_to_face", "layout_hole_to_hole"})
    action(name)->setEnabled(document.layout().parts.size() > 1);
  const QString name =
      document.has_file() ? QString::fromStdString(document.file().filename().string()) : tr("not saved yet");
  title_->setText(document.is_changed() ? tr("%1 – changed").arg(name) : name);
  title_->setToolTip(document.has_file() ? QString::fromStdString(document.file().string()) : QString());
  OfferRecovery();
  if (!desk_->is_unsaved()) unsaved_->hide();  // it was saved while it was asked
}

void LayoutPage::OfferRecovery() {
  const control::LayoutDocument& document = desk_->document();
  const QString offer = document.has_file() ? tr("%1 has changes that weren't saved when the program ended.")
                                                  .arg(QString::fromStdString(document.file().string()))
                                            : tr("A layout wasn't saved when the program ended.");
  if (!desk_->can_recover()) return recovery_->hide();
  if (!recovery_->isHidden()) return recovery_->SetQuestion(offer);
  recovery_->Ask(offer,
                 {{"recovery_take", tr("&Take them"),
                   tr("Shows the layout with these changes; nothing is written until you save"),
                   [this] { AskToRecover(); }},
                  {"recovery_forget", tr("&Discard them"), tr("Deletes these changes"),
                   [this] { desk_->DiscardRecovery(); }}},
                 false);
}

void LayoutPage::Open(const std::filesystem::path& layout_file) {
  Leave([this, layout_file] { desk_->Open(layout_file); });
}

void LayoutPage::AskForFile() {
  AskForFileToRead(this,
                   {.title = tr("Open a layout"),
                    .beside = FolderOfDialog(desk_->document().file()),
                    .filter = tr("Layouts (*.toml);;All files (*)")},
                   [this](const QString& file) { Open(file.toStdString()); });
}

void LayoutPage::AskForPart() {
  AskForFileToRead(this,
                   {.title = tr("Import a part"),
                    .beside = QString::fromStdString(last_cad_folder_.string()),
                    .filter = tr("CAD files (%1);;All files (*)").arg(kCadFilter)},
                   [this](const QString& file) { Import(file.toStdString()); });
}

void LayoutPage::Import(const std::filesystem::path& cad_file) {
  last_cad_folder_ = cad_file.parent_path();
  auto* dialog = new ImportDialog(cad_file, this);
  connect(dialog, &ImportDialog::Taken, this,
          [this](const control::PartPreview& preview, const std::vector<std::string>& nodes) {
            const std::vector<std::string> names = desk_->AddParts(preview, nodes);
            if (names.empty()) return;
            Choose({QString::fromStdString(names.front())});
            view_->Fit();
          });
  ShowAside(dialog);
}

void LayoutPage::Save(const std::function<void()>& then) {
  if (!desk_->document().has_file()) return SaveAs(then);
  if (!desk_->Save()) return;
  emit LayoutSaved(QString::fromStdString(desk_->document().file().string()));
  if (then) then();
}

void LayoutPage::SaveAs(const std::function<void()>& then) {
  const control::LayoutDocument& document = desk_->document();
  const std::filesystem::path proposed =
      document.has_file() ? document.file() : last_cad_folder_ / "layout.toml";
  AskForFileToWrite(this,
                    {.title = tr("Save the layout"),
                     .beside = QString::fromStdString(proposed.string()),
                     .filter = tr("Layouts (*.toml);;All files (*)"),
                     .suffix = "toml"},
                    [this, then](const QString& file) {
                      if (!desk_->SaveAs(file.toStdString())) return;
                      emit LayoutSaved(file);
                      if (then) then();
                    });
}

void LayoutPage::Leave(std::function<void()> then) {
  if (!desk_->is_unsaved()) return then();
  unsaved_->Ask(tr("The layout has changes that aren't saved."),
                {{"unsaved_save", tr("&Save"), tr("Writes the LAYOUT.toml, then goes on"),
                  [this, then] { Save(then); }},
                 {"unsaved_discard", tr("&Discard"), tr("Goes on without these changes"),
                  [this, then] {
                    desk_->Forget();
                    then();
                  }},
                 {"unsaved_stay", tr("S&tay"), tr("Goes on with this layout"), {}}});
}

// Not Leave(): what is offered replaces what is there, saved or not.
void LayoutPage::AskToRecover() {
  if (!desk_->is_unsaved()) return desk_->Recover();
  unsaved_->Ask(
      tr("The layout has changes that aren't saved; taking the others discards them."),
      {{"recovery_replace", tr("&Discard"), tr("Takes the changes that weren't saved before"),
        [this] { desk_->Recover(); }},
       {"recovery_stay", tr("S&tay"), tr("Goes on with this layout"), [this] { OfferRecovery(); }}});
}

void LayoutPage::AskForTrial() {
  if (desk_->document().is_changed() || !desk_->document().has_file())
    return Save([this] { ShowTrialDialog(); });
  ShowTrialDialog();
}

void LayoutPage::ShowTrialDialog() {
  auto* dialog = new TrialDialog(desk_->document().file(), this);
  connect(dialog, &TrialDialog::Written, this, &LayoutPage::TrialAsked);
  ShowAside(dialog);
}

// No modal box: a trial may be running.
void LayoutPage::ShowAside(QDialog* dialog) {
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(desk_, &LayoutDesk::Opened, dialog, &QDialog::reject);  // it is for this layout
  dialog->show();
}

// Beside the view, which takes the clicks.
void LayoutPage::AskForMeasuredPoints() {
  if (measured_ && measured_->part() == chosen_.front()) {
    if (placing_->placing() != Placing::kMeasuredPoints) placing_->Begin(Placing::kMeasuredPoints);
    return measured_->Raise();
  }
  if (measured_) measured_->close();  // of another part: clicks are for one of them
  auto* dialog = new MeasuredPoints(chosen_.front(), this);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  measured_ = dialog;
  connect(placing_, &PlacingSteps::PointTaken, dialog, [this, dialog](const control::Pick& pick) {
    const auto part = layout().FindPart(dialog->part().toStdString());
    if (part != pick.part) return emit Failed(tr("That isn't %1: click on that part").arg(dialog->part()));
    dialog->Add(Poses()[*part].Inverse() * pick.point_in_world, pick.point_in_world);
  });
  connect(dialog, &MeasuredPoints::PlaceAsked, this, &LayoutPage::PlacePart);
  connect(dialog, &QDialog::finished, placing_, &PlacingSteps::End);
  placing_->Begin(Placing::kMeasuredPoints);
  dialog->show();
}

void LayoutPage::AskForSpacing(const core::Spacing& spacing, bool is_new) {
  const auto put = [this, is_new](const core::Spacing& entered) -> QString {
    if (entered.name.empty()) return tr("Give the spacing a name: trials and reports call it by that");
    if (is_new && layout().FindSpacing(entered.name))
      return tr("A spacing has that name; choose another one");
    control::SpacingEdit edit;
    edit.name = entered.name;
    edit.moving = entered.moving;
    edit.reference = entered.reference;
    edit.axis = std::string(core::ToString(entered.axis));
    edit.min_mm = entered.min_mm;
    edit.max_mm = entered.max_mm;
    edit.initial_mm = entered.initial_mm;
    const QString name = QString::fromStdString(entered.name);
    return desk_->Apply(is_new ? tr("Add %1").arg(name) : tr("Change %1").arg(name),
                        [edit](cad_import::LayoutText& text) { control::PutSpacing(text, edit); });
  };
  auto* dialog = new SpacingDialog(layout(), spacing, is_new, put, this);
  ShowAside(dialog);
}

void LayoutPage::AskForPair(const core::PairRule& rule) {
  const auto put = [this](const core::PairRule& entered) {
    control::PairEdit edit;
    edit.a = entered.a;
    edit.b = entered.b;
    edit.required_clearance_mm = entered.required_clearance_mm;
    // What a rule doesn't say is false: it isn't written unless the rule has said it before.
    const core::PairRule before = control::ProposePairRule(layout(), entered.a, entered.b);
    if (entered.authorised_contact || before.authorised_contact)
      edit.authorised_contact = entered.authorised_contact;
    if (entered.ignore || before.ignore) edit.ignore = entered.ignore;
    return desk_->Apply(tr("Pair rule"),
                        [edit](cad_import::LayoutText& text) { control::PutPair(text, edit); });
  };
  auto* dialog = new PairDialog(rule, put, this);
  ShowAside(dialog);
}

}  // namespace elbowroom::console
