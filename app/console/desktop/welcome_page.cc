#include "app/console/desktop/welcome_page.h"

#include <QDir>
#include <QFileInfo>
#include <QLabel>
#include <QPushButton>

#include "app/console/desktop/recent_trials.h"

namespace elbowroom::console {
namespace {

constexpr int kColumnWidthPx = 420;
constexpr int kMostListed = 4;

QLabel* QuietLabel(const QString& text) {
  auto* label = new QLabel(text);
  label->setForegroundRole(QPalette::PlaceholderText);
  label->setWordWrap(true);
  return label;
}

}  // namespace

WelcomePage::WelcomePage(QAction* demo, QAction* open, QWidget* parent) : QWidget(parent) {
  auto* column = new QWidget;
  column->setMaximumWidth(kColumnWidthPx);
  column_ = new QVBoxLayout(column);
  auto* title = new QLabel(tr("Will a human fit?"));
  QFont font = title->font();
  font.setPointSizeF(1.8 * font.pointSizeF());
  title->setFont(font);
  column_->addWidget(title);
  AddButton(demo, tr("A simulated hand screws a pipe in below a payload. No cameras are needed."));
  AddButton(open, tr("Your cameras and your parts, as a TRIAL.toml says. It can be dropped here, too."));
  AddRecentTrials();
  auto* centred = new QHBoxLayout;
  centred->addStretch(1);
  centred->addWidget(column, 4);
  centred->addStretch(1);
  auto* page = new QVBoxLayout(this);
  page->addStretch(1);
  page->addLayout(centred);
  page->addStretch(2);
}

void WelcomePage::AddButton(QAction* action, const QString& explanation) {
  auto* button = new QPushButton(action->icon(), action->text());
  button->setObjectName("welcome:" + action->objectName());
  button->setAccessibleDescription(explanation);
  button->setMinimumHeight(2 * fontMetrics().height());
  connect(button, &QPushButton::clicked, action, &QAction::trigger);
  connect(action, &QAction::changed, button, [button, action] { button->setEnabled(action->isEnabled()); });
  column_->addSpacing(10);
  column_->addWidget(button);
  column_->addWidget(QuietLabel(explanation));
}

void WelcomePage::AddSamples(const QList<QAction*>& samples) {
  constexpr int kBelowDemo = 4;  // title, space, the demo's button and what it says
  auto* row = new QHBoxLayout;
  row->addWidget(QuietLabel(tr("Samples:")));
  for (QAction* sample : samples) {
    auto* button = new QPushButton(sample->text());
    button->setObjectName("welcome:" + sample->objectName());
    button->setAccessibleDescription(sample->toolTip());
    button->setToolTip(sample->toolTip());
    connect(button, &QPushButton::clicked, sample, &QAction::trigger);
    connect(sample, &QAction::changed, button, [button, sample] { button->setEnabled(sample->isEnabled()); });
    row->addWidget(button, 1);
  }
  column_->insertLayout(kBelowDemo, row);
}

void WelcomePage::AddRecentTrials() {
  const QStringList trials = RecentTrials().mid(0, kMostListed);
  if (trials.isEmpty()) return;
  column_->addSpacing(14);
  column_->addWidget(new QLabel(tr("Opened last")));
  for (const QString& file : trials) {
    const QFileInfo info(file);
    auto* link = new QPushButton(info.dir().dirName() + "/" + info.fileName());
    link->setFlat(true);
    link->setStyleSheet("text-align: left;");
    link->setToolTip(QDir::toNativeSeparators(file));
    connect(link, &QPushButton::clicked, this, [this, file] { emit TrialChosen(file); });
    column_->addWidget(link);
  }
}

}  // namespace elbowroom::console
