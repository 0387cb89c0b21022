#include "app/console/procedure/after_page.h"

#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QScrollArea>
#include <QVBoxLayout>

namespace elbowroom::console {
namespace {

constexpr int kAfterWidthPx = 560;
constexpr int kNotesPx = 110;
constexpr double kHeadingScale = 1.4;

}  // namespace

AfterPage::AfterPage(QWidget* parent) : QWidget(parent) {
  setObjectName("after_page");
  auto* content = new QWidget;
  content->setMaximumWidth(kAfterWidthPx);
  auto* form = new QVBoxLayout(content);
  auto* heading = new QLabel(tr("After the trial"));
  QFont font = heading->font();
  font.setPointSizeF(kHeadingScale * font.pointSizeF());
  font.setBold(true);
  heading->setFont(font);
  questions_ = new QuestionForm(core::AskedWhen::kAfter);
  auto* title = new QLabel(tr("&Notes"));
  notes_ = new QPlainTextEdit;
  notes_->setObjectName("after_notes");
  notes_->setAccessibleName(tr("Notes after the trial"));
  notes_->setToolTip(tr("What the participant says, what you saw: the session keeps it as a note"));
  notes_->setTabChangesFocus(true);
  notes_->setMinimumHeight(kNotesPx);
  notes_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);  // the room that is left
  title->setBuddy(notes_);
  for (QWidget* widget : std::initializer_list<QWidget*>{heading, questions_, title, notes_})
    form->addWidget(widget);
  form->setStretchFactor(notes_, 1);
  auto* area = new QScrollArea;
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  area->setWidget(content);
  save_ = new QPushButton(tr("&Save into the session (Ctrl+Enter)"));
  save_->setObjectName("save_answers");
  save_->setToolTip(tr("Add what is said here to the session's file; write the report after that"));
  skip_ = new QPushButton(tr("S&kip"));
  skip_->setObjectName("skip_answers");
  skip_->setToolTip(tr("Add nothing (Escape, while nothing is said); the session is complete without it"));
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(save_, 1);
  buttons->addWidget(skip_);
  auto* column = new QVBoxLayout(this);
  column->addWidget(area, 1);
  column->addLayout(buttons);
  connect(save_, &QPushButton::clicked, this, &AfterPage::Save);
  connect(skip_, &QPushButton::clicked, this, &AfterPage::Skipped);
}

void AfterPage::Open(const core::TrialInfo& trial) {
  questions_->Open(trial, std::nullopt);
  notes_->clear();
  SetIsSaving(false);
}

void AfterPage::SetIsSaving(bool is_saving) {
  save_->setEnabled(!is_saving);
  skip_->setEnabled(!is_saving);
}

std::vector<core::EventContent> AfterPage::Said() const {
  std::vector<core::EventContent> said = questions_->Said();
  const QString notes = notes_->toPlainText().trimmed();
  if (!notes.isEmpty()) said.emplace_back(core::Note{notes.toStdString()});
  return said;
}

void AfterPage::Save() {
  const std::vector<core::EventContent> said = Said();
  if (said.empty()) return emit Skipped();
  SetIsSaving(true);
  emit SaveAsked(said);
}

void AfterPage::keyPressEvent(QKeyEvent* event) {
  const bool is_enter = event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter;
  const bool has_control = event->modifiers().testFlag(Qt::ControlModifier);
  if (is_enter && has_control && save_->isEnabled()) return Save();
  if (event->key() == Qt::Key_Escape && skip_->isEnabled() && !HasAnswers()) return emit Skipped();
  QWidget::keyPressEvent(event);
}

}  // namespace elbowroom::console
