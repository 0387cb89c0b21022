#include "app/console/procedure/start_page.h"

#include <QFormLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QScrollArea>
#include <QVBoxLayout>

namespace elbowroom::console {
namespace {

constexpr int kStartWidthPx = 560;
constexpr int kLongestParticipant = 200;
constexpr double kTitleScale = 1.4;

QLabel* PlainLabel(const QString& name) {
  auto* label = new QLabel;
  label->setObjectName(name);
  label->setTextFormat(Qt::PlainText);
  label->setWordWrap(true);
  return label;
}

QString FactsOf(const core::TrialInfo& trial) {
  QStringList facts;
  if (!trial.condition.empty())
    facts << StartPage::tr("Condition: %1").arg(QString::fromStdString(trial.condition));
  if (trial.order > 0) facts << StartPage::tr("The participant's trial no. %1").arg(trial.order);
  if (!trial.block.empty()) facts << StartPage::tr("Block: %1").arg(QString::fromStdString(trial.block));
  return facts.join('\n');
}

QString StepsOf(const core::TrialInfo& trial) {
  QStringList lines;
  for (std::size_t i = 0; i < trial.steps.size(); ++i)
    lines << QString("%1. %2").arg(i + 1).arg(QString::fromStdString(trial.steps[i]));
  return lines.join('\n');
}

}  // namespace

StartPage::StartPage(QWidget* parent) : QWidget(parent) {
  setObjectName("start_page");
  auto* column = new QVBoxLayout(this);
  auto* area = new QScrollArea;
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  area->setWidget(MakeForm());
  column->addWidget(area, 1);
  begin_ = new QPushButton(tr("&Begin the trial (Enter)"));
  begin_->setObjectName("begin_trial");
  begin_->setToolTip(tr("Run the trial and record it; the first step begins with the first frame"));
  auto* leave = new QPushButton(tr("&Leave"));
  leave->setObjectName("leave_trial");
  leave->setToolTip(tr("Back, without a trial (Escape)"));
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(begin_, 1);
  buttons->addWidget(leave);
  column->addLayout(buttons);
  connect(begin_, &QPushButton::clicked, this, &StartPage::Begin);
  connect(leave, &QPushButton::clicked, this, &StartPage::Left);
}

QWidget* StartPage::MakeForm() {
  auto* content = new QWidget;
  content->setMaximumWidth(kStartWidthPx);
  auto* column = new QVBoxLayout(content);
  task_ = PlainLabel("start_task");
  QFont font = task_->font();
  font.setPointSizeF(kTitleScale * font.pointSizeF());
  font.setBold(true);
  task_->setFont(font);
  facts_ = PlainLabel("start_facts");
  participant_ = new QLineEdit;
  participant_->setObjectName("participant");
  participant_->setAccessibleName(tr("Participant"));
  participant_->setToolTip(tr("Whom the session and its report name"));
  participant_->setMaxLength(kLongestParticipant);
  auto* who = new QFormLayout;
  who->setRowWrapPolicy(QFormLayout::WrapAllRows);
  who->addRow(tr("Participant"), participant_);
  questions_ = new QuestionForm(core::AskedWhen::kBefore);
  steps_ = PlainLabel("start_steps");
  column->addWidget(task_);
  column->addWidget(facts_);
  column->addLayout(who);
  column->addWidget(questions_);
  column->addWidget(steps_);
  column->addStretch(1);
  return content;
}

void StartPage::Open(const core::TrialInfo& trial) {
  task_->setText(trial.task.empty() ? tr("Trial") : QString::fromStdString(trial.task));
  facts_->setText(FactsOf(trial));
  facts_->setVisible(!facts_->text().isEmpty());
  participant_->setText(QString::fromStdString(trial.participant));
  questions_->Open(trial, trial.estimate_mm > 0.0 ? std::optional(trial.estimate_mm) : std::nullopt);
  steps_->setText(tr("The procedure:") + '\n' + StepsOf(trial));
  steps_->setVisible(!trial.steps.empty());
}

void StartPage::Begin() {
  emit BeginAsked({participant_->text().trimmed().toStdString(), questions_->estimate_mm().value_or(0.0),
                   questions_->Said()});
}

void StartPage::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) return Begin();
  if (event->key() == Qt::Key_Escape) emit Left();
  QWidget::keyPressEvent(event);
}

}  // namespace elbowroom::console
