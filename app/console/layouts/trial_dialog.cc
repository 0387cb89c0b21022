#include "app/console/layouts/trial_dialog.h"

#include <QDialogButtonBox>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>
#include <utility>

#include "app/console/desktop/theme.h"
#include "app/console/view/file_question.h"
#include "core/error.h"

namespace elbowroom::console {
namespace {

constexpr const char* kRigKey = "layout/last_rig";
constexpr double kMostMm = 1e5;

QLineEdit* TextLine(const QString& name, const QString& text, const QString& tool_tip) {
  auto* line = new QLineEdit(text);
  line->setObjectName(name);
  line->setToolTip(tool_tip);
  return line;
}

QDoubleSpinBox* MillimetreBox(const QString& name, const QString& none, const QString& tool_tip) {
  auto* box = new QDoubleSpinBox;
  box->setObjectName(name);
  box->setRange(0.0, kMostMm);
  box->setDecimals(1);
  box->setSuffix(QObject::tr(" mm"));
  box->setSpecialValueText(none);  // at 0
  box->setToolTip(tool_tip);
  return box;
}

// Beside the layout; no file has that name.
QString FreeTrialFile(const std::filesystem::path& layout) {
  const QString name = QString::fromStdString((layout.parent_path() / layout.stem()).string()) + "_trial";
  QString file = name + ".toml";
  for (int i = 2; QFileInfo::exists(file); ++i) file = name + QString::number(i) + ".toml";
  return file;
}

// A row for a line with a button beside it.
void AddRow(QFormLayout* form, const QString& title, QLineEdit* line, QPushButton* button) {
  auto* row = new QHBoxLayout;
  row->addWidget(line, 1);
  row->addWidget(button);
  auto* label = new QLabel(title);
  label->setBuddy(line);
  form->addRow(label, row);
}

}  // namespace

TrialDialog::TrialDialog(const std::filesystem::path& layout, QWidget* parent)
    : QDialog(parent), layout_(layout) {
  setObjectName("trial_dialog");
  setWindowTitle(tr("Trial from %1").arg(QString::fromStdString(layout.filename().string())));
  BuildForm();
  setMinimumWidth(520);
}

void TrialDialog::BuildForm() {
  rig_ = TextLine("trial_rig", QSettings().value(kRigKey).toString(),
                  tr("The RIG.yml of the cameras, or of recorded footage"));
  participant_ =
      TextLine("trial_participant", {}, tr("A short name, as the session and the report call them"));
  task_ = TextLine("trial_task", {}, tr("What they are to do"));
  estimate_mm_ =
      MillimetreBox("trial_estimate", tr("none"), tr("The participant's guess of the space needed, mm"));
  clearance_mm_ = MillimetreBox("trial_clearance", tr("only touches are judged"),
                                tr("How far hands and tools must stay from parts, mm"));
  tools_ =
      TextLine("trial_tools", {}, tr("With commas between: tongs, screwdriver. Marked by the keys 1 to 9"));
  file_ = TextLine("trial_file", FreeTrialFile(layout_), tr("The TRIAL.toml to write"));
  auto* browse_rig = new QPushButton(tr("&Choose …"));
  browse_rig->setObjectName("trial_browse_rig");
  connect(browse_rig, &QPushButton::clicked, this, &TrialDialog::BrowseRig);
  auto* browse_file = new QPushButton(tr("C&hoose …"));
  browse_file->setObjectName("trial_browse_file");
  connect(browse_file, &QPushButton::clicked, this, &TrialDialog::BrowseFile);
  fault_ = new QLabel;
  fault_->setObjectName("trial_fault");
  fault_->setWordWrap(true);
  fault_->setTextFormat(Qt::PlainText);
  QPalette palette = fault_->palette();
  palette.setColor(QPalette::WindowText, ThemeColors().contact);
  fault_->setPalette(palette);
  fault_->hide();
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
  QPushButton* start = buttons->addButton(tr("&Start trial"), QDialogButtonBox::AcceptRole);
  start->setObjectName("trial_start");
  start->setDefault(true);
  connect(buttons, &QDialogButtonBox::accepted, this, &TrialDialog::Write);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* form = new QFormLayout;
  AddRow(form, tr("&Rig"), rig_, browse_rig);
  form->addRow(tr("&Participant"), participant_);
  form->addRow(tr("&Task"), task_);
  form->addRow(tr("&Estimate"), estimate_mm_);
  form->addRow(tr("Required c&learance"), clearance_mm_);
  form->addRow(tr("T&ools"), tools_);
  AddRow(form, tr("&File"), file_, browse_file);
  auto* column = new QVBoxLayout(this);
  column->addLayout(form);
  column->addWidget(fault_);
  column->addWidget(buttons);
}

void TrialDialog::BrowseRig() {
  AskForFileToRead(this,
                   {.title = tr("Choose a rig"),
                    .beside = rig_->text(),
                    .filter = tr("Rigs (*.yml *.yaml);;All files (*)")},
                   [this](const QString& rig) { rig_->setText(rig); });
}

void TrialDialog::BrowseFile() {
  AskForFileToWrite(
      this, {.title = tr("Write the trial"), .beside = file_->text(), .filter = tr("Trials (*.toml)")},
      [this](const QString& file) {
        file_->setText(file);
        may_replace_ = file;  // the file dialog has asked
      });
}

control::TrialDraft TrialDialog::Draft() const {
  control::TrialDraft draft;
  draft.layout = layout_;
  draft.rig = rig_->text().toStdString();
  draft.participant = participant_->text().trimmed().toStdString();
  draft.task = task_->text().trimmed().toStdString();
  draft.estimate_mm = estimate_mm_->value();
  draft.required_clearance_mm = clearance_mm_->value();
  for (const QString& tool : tools_->text().split(',', Qt::SkipEmptyParts))
    if (!tool.trimmed().isEmpty()) draft.tools.push_back(tool.trimmed().toStdString());
  return draft;
}

void TrialDialog::Write() {
  const QString file = file_->text();
  if (QFileInfo::exists(file) && file != std::exchange(may_replace_, file))
    return ShowFault(tr("%1 is there; choose another name, or press again to replace it").arg(file));
  try {
    control::WriteTrial(Draft(), file.toStdString());
  } catch (const core::Error& error) {
    return ShowFault(QString::fromStdString(error.what()));
  }
  QSettings().setValue(kRigKey, rig_->text());
  emit Written(file);
  accept();
}

void TrialDialog::ShowFault(const QString& line) {
  fault_->setText(line);
  fault_->show();
}

}  // namespace elbowroom::console
